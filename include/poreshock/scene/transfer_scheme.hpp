#pragma once
// Velocity transfers between particles and nodes. Each is a set of modes of the velocity that a
// particle carries, and which of them keep a share of what the grid does not see. All are
// projections in one space of pairs of a particle and a node (transfer/velocity_modes.hpp), and
// all that is known about one stands in a row of the table below.

#include <array>
#include <string_view>
#include <utility>

#include "poreshock/core/shape.hpp"
#include "poreshock/core/tensor.hpp"

namespace poreshock {

enum class VelocityTransfer { pic, flip, apic, aflip, iapic, polypic, polyflip, ipolypic };

/// What a scene asks for.
struct Transfer {
  ShapeFunction shape = ShapeFunction::cubic;
  VelocityTransfer velocity = VelocityTransfer::aflip;
  double damping = 0.05;  ///< decay of the residual while sound crosses a cell
  Gradient gradient = Gradient::slopes;
  double half_length = 0.0;  ///< derived: half the edge of a particle at the start, in cells
  bool operator==(const Transfer&) const = default;
};

/// Modes of the velocity around a particle: v; + A r; + all products r_a r_b (cubic splines only),
/// r = (x_i - x_p)/cell.
enum class Modes { constant, affine, quadratic };

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

/// True for the shapes a scheme is made for: modes beyond the velocity need constant moments, those
/// of second order the third ones; shapes without are stable with FLIP only.
constexpr bool suits(const TransferScheme& scheme, ShapeFunction shape) {
  const int moments = of_shape(shape, [](const auto& s) { return s.constant_moments; });
  if (scheme.modes == Modes::quadratic) return moments >= 3;
  return moments >= 2 || (scheme.modes == Modes::constant && scheme.keeps == Keeps::all);
}

/// Calls run(shape function) with the one the scene asks for.
template <class Run>
inline decltype(auto) with_shape(const Transfer& transfer, Run&& run) {
  return with_shape(transfer.shape, transfer.half_length, run);
}

/// Calls run<modes, keeps>(shape function) for the transfer, the shape and the gradient that the
/// scene asks for.
template <class Run>
inline void with_scheme(const Transfer& transfer, Run&& run) {
  with_shape(transfer, [&]<class Spline>(Spline spline) {
    if constexpr (has_inertia<Spline>) spline.gradient = transfer.gradient;
    const auto try_one = [&]<std::size_t I>() {
      constexpr const TransferScheme& scheme = transfer_schemes[I];
      if constexpr (suits(scheme, Spline::kind)) {
        if (scheme.velocity == transfer.velocity) {
          run.template operator()<scheme.modes, scheme.keeps>(spline);
        }
      }
    };
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (try_one.template operator()<I>(), ...);
    }
    (std::make_index_sequence<transfer_schemes.size()>{});
  });
}

/// Square of the radius of gyration of the shape function, m^2: kinetic energy per mass of an
/// affine particle is (|v|^2 + inertia |C|^2) / 2. Zero for transfers without affine modes.
inline double affine_inertia(const Transfer& transfer, double cell) {
  if (scheme_of(transfer.velocity).modes == Modes::constant) return 0.0;
  return of_shape(transfer.shape, [cell]<class Shape>(const Shape&) {
    if constexpr (has_inertia<Shape>) return cell * cell / Shape::inverse_inertia;
    return 0.0;
  });
}

}  // namespace poreshock
