#pragma once
// The plane that parts the particles of two grains around a node, by logistic regression (Nairn,
// Hammerquist & Smith, CMAME 362 (2020) 112859).

#include <span>

#include "poreshock/core/tensor.hpp"
#include "poreshock/transfer/node_points.hpp"

namespace poreshock {

/// Unit normal of that plane, from the points of field a to those of field b; zero when one has
/// none, or when they lie around the same place. b . (x, 1) is fitted so that the sum over the
/// points of volume times log(1 + exp(-m b . (x, 1))), m = -1 in a and 1 in b, plus half of
/// `normal_penalty` times the square of the part of b that multiplies x, is least. That is convex
/// and has one minimum; Newton's method finds it. Where a plane parts the points, the penalty makes
/// the fit finite. Pure function.
template <int Dim>
Vector<Dim> parting_normal(std::span<const NodePoint<Dim>> points, int a, int b);

/// In square cells and volumes of a cell. Two touching discs of 8, 16 and 64 cells across, normals
/// at all nodes they share: with a hundredth of it errors grow to twice (the few particles that
/// face each other decide then), with ten times as much by a fifth for flat faces.
inline constexpr double normal_penalty = 0.025;

}  // namespace poreshock
