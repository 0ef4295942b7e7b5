#pragma once
// End surfaces of the sample that have material behind them.

#include <memory>
#include <optional>

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/physics/transmit.hpp"

namespace poreshock {

/// Both ends of the sample.
struct EndSurfaces {
  std::optional<Backing> low, high;  ///< none where no material lies behind
  std::int64_t layer = 1;            ///< particles of a layer of the sample
  std::int64_t top = 0;              ///< its highest layer
  double area = 1.0;                 ///< m^(Dim-1), of the end, for each particle of a layer
  double density = 0.0;              ///< kg/m^3, of the sample at rest
  double rest = 0.0;                 ///< m/s along the shock axis, of the material behind
  std::unique_ptr<SlabGrid> forces;  ///< scratch; only with material behind an end
};

/// The ends of a scene, without the grid. Pure function.
EndSurfaces find_ends(const Scene& scene);

/// Forces of the materials behind on the nodes, from the particles that started in the lowest and
/// in the highest layer of the sample: each stands for its share of the end surface and moves into
/// the material behind with its own velocity. Collective (one exchange).
template <int Dim>
void sum_ends(const Transfer& transfer, const Particles<Dim>& particles, const CellOrder& cells,
              EndSurfaces& ends);

}  // namespace poreshock
