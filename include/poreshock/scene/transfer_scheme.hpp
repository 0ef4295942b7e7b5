#pragma once
// Velocity transfers between particles and nodes. Each is a set of modes of the velocity that a
// particle carries, and which of them keep a share of what the grid does not see. All are
// projections in one space of pairs of a particle and a node (transfer/velocity_modes.hpp), and
// all that is known about one stands in a row of the table below.

#include <array>
#include <string_view>

#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Modes of the velocity around a particle: v; + A r; + all products r_a r_b (cubic splines only),
/// r = (x_i - x_p)/cell.
enum class Modes { constant, affine, quadratic };

/// Modes of second order: xx, yy(, zz), then xy(, yz, zx), in the order of a rate.
template <int Dim>
inline constexpr int second_modes = Dim*(Dim + 1) / 2;

/// Modes after the velocity itself.
template <int Dim, Modes M>
inline constexpr int higher_modes = M == Modes::constant
                                        ? 0
                                        : (M == Modes::affine ? Dim : Dim + second_modes<Dim>);

/// Modes whose residual, what the grid does not see of them, lives on: none, v alone, or all.
enum class Keeps { nothing, velocity, all };

/// One transfer.
struct TransferScheme {
  VelocityTransfer velocity;
  std::string_view name;
  Modes modes;
  Keeps keeps;
  double damping;      ///< default decay of the residual while sound crosses a cell
  double cfl;          ///< default; FLIP swings up a particle alone beyond it
  double largest_cfl;  ///< beyond it noise grows
};

/// PIC: Harlow (1964). FLIP: Brackbill & Ruppel, JCP 65 (1986) 314. APIC: Jiang et al., TOG 34
/// (2015) 51. PolyPIC: Fu et al., TOG 36 (2017) 222. AFLIP: Fei et al., TOG 40 (2021) 109, here
/// with modes that are shortened where heat would be negative; PolyFLIP: the same with six. iAPIC,
/// iPolyPIC: the projections again, of which all modes keep the residual.
inline constexpr std::array<TransferScheme, 8> transfer_schemes = {{
    {VelocityTransfer::pic, "pic", Modes::constant, Keeps::nothing, 0.0, 0.5, 0.9},
    {VelocityTransfer::flip, "flip", Modes::constant, Keeps::all, 0.0, 0.4, 0.9},
    {VelocityTransfer::apic, "apic", Modes::affine, Keeps::nothing, 0.0, 1.0, 1.5},
    {VelocityTransfer::aflip, "aflip", Modes::affine, Keeps::velocity, 0.05, 1.0, 1.5},
    {VelocityTransfer::iapic, "iapic", Modes::affine, Keeps::all, 0.2, 1.0, 1.5},
    {VelocityTransfer::polypic, "polypic", Modes::quadratic, Keeps::nothing, 0.0, 1.0, 1.5},
    {VelocityTransfer::polyflip, "polyflip", Modes::quadratic, Keeps::velocity, 0.01, 1.0, 1.5},
    {VelocityTransfer::ipolypic, "ipolypic", Modes::quadratic, Keeps::all, 1.0, 1.0, 1.5},
}};

constexpr const TransferScheme& scheme_of(VelocityTransfer velocity) {
  for (const TransferScheme& scheme : transfer_schemes) {
    if (scheme.velocity == velocity) return scheme;
  }
  return transfer_schemes.front();
}

/// True for the shapes a scheme is made for: modes beyond the velocity need the constant moments of
/// B-splines, those of second order the third moments of cubic ones; hats are stable with FLIP
/// only.
constexpr bool suits(const TransferScheme& scheme, ShapeFunction shape) {
  const bool cubic = shape == ShapeFunction::cubic;
  const bool spline = cubic || shape == ShapeFunction::quadratic;
  if (scheme.modes == Modes::quadratic) return cubic;
  return spline || (scheme.modes == Modes::constant && scheme.keeps == Keeps::all);
}

}  // namespace poreshock
