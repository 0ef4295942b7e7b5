#pragma once
// Eight doubles that move together: one node of the background grid, one cache line. The width is
// fixed, so every instruction set does the same arithmetic lane by lane.

namespace poreshock {

/// Eight doubles with element-wise + - * /; may lie at any address of a double.
typedef double Lanes __attribute__((vector_size(64), aligned(8)));

inline constexpr int lane_count = 8;

}  // namespace poreshock
