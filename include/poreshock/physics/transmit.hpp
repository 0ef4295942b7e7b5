#pragma once
// Material behind a free side: what the end surface of the sample feels of it, as long as no wave
// comes back from there.

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/material/material.hpp"
#include "poreshock/physics/node_ledger.hpp"

namespace poreshock {

/// Half space of a material at rest, behind the end surface.
struct Backing {
  double density = 0.0;          ///< kg/m^3
  double c0 = 0.0;               ///< m/s
  double lambda = 0.0;           ///< of Us = c0 + lambda Up
  double shear_impedance = 0.0;  ///< kg/(m^2 s), what the longitudinal sound speed adds
  double strength = 0.0;         ///< Pa, largest deviator of uniaxial strain, 2/3 Y
};

/// The half space of a material with parameters `p`; 2/3 of its yield stress at the start.
Backing make_backing(const MaterialParameters& p);

/// Longitudinal stress (Pa, compression positive) of the half space when its surface moves into it
/// at w (m/s): rho w (c_l + lambda w) up to the elastic limit w_e, where the deviator is that of
/// the strength, and rho (w - w_e) (c0 + lambda (w + w_e)) more beyond. Acoustic where w < 0. Pure
/// function.
double backing_stress(const Backing& backing, double w);

/// What a front that is as wide as its artificial viscosity (Pa) makes it adds to that, Pa. It goes
/// on with a speed c0 + lambda W, so its stress is rho w (c0 + lambda W) before the velocity is W:
/// rho lambda w (W - w) more, which is half of its viscosity where lambda W is small beside c0, and
/// no more than rho lambda w^2 in its upper half. Pure function.
double front_stress(const Backing& backing, double w, double viscous_pressure);

/// Lane of the grid of end surfaces: N (N/m in plane strain), force along the shock axis.
inline constexpr int end_force = 0;

/// Lets the forces of `ends` act on the nodes for a time dt (s). Impulse and work go to those of
/// the walls. Before: velocities as after integrate_momentum. Not collective.
template <int Dim>
void push_ends(const SlabGrid& ends, double dt, SlabGrid& grid, NodeLedger& ledger);

}  // namespace poreshock
