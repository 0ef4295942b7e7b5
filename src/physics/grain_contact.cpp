#include "poreshock/physics/grain_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

namespace {

/// Share of the shape function of a node one cell inside a plane that reaches beyond it.
double share_beyond(const Transfer& transfer) {
  switch (transfer.shape) {
    case ShapeFunction::linear:
      return 0.0;
    case ShapeFunction::gimp:
      return transfer.half_length * transfer.half_length / 12.0;
    case ShapeFunction::quadratic:
      return 1.0 / 48.0;
    case ShapeFunction::cubic:
      break;
  }
  return 1.0 / 24.0;
}

/// Share of a node's space along one axis that lies inside the domain.
double share_inside(int index, int count, bool periodic, double beyond) {
  if (periodic) return 1.0;
  const int from_side = std::min(index, count - 1 - index);
  if (from_side == 0) return beyond;
  if (from_side == 1) return 0.5;
  return from_side == 2 ? 1.0 - beyond : 1.0;
}

/// A field at a node and where its results go.
template <int Dim>
struct Entry {
  NodeGrain<Dim> grain;
  Lanes* motion = nullptr;
  Lanes* surface = nullptr;
};

/// Order that does not know the numbers of the fields.
template <int Dim>
bool comes_before(const Entry<Dim>& a, const Entry<Dim>& b) {
  if (a.grain.mass != b.grain.mass) return a.grain.mass > b.grain.mass;
  for (int k = 0; k < Dim; ++k) {
    if (a.grain.end[k] != b.grain.end[k]) return a.grain.end[k] < b.grain.end[k];
  }
  for (int k = 0; k < Dim; ++k) {
    if (a.grain.place[k] != b.grain.place[k]) return a.grain.place[k] < b.grain.place[k];
  }
  return false;
}

template <int Dim>
NodeGrain<Dim> read_grain(const Lanes& motion, const Lanes& surface) {
  using Motion = MotionLane<Dim>;
  using Surface = SurfaceLane<Dim>;
  NodeGrain<Dim> grain;
  grain.mass = motion[Motion::mass];
  grain.volume = surface[Surface::volume];
  grain.strain = grain.volume > 0.0 ? surface[Surface::strain] / grain.volume : 0.0;
  for (int a = 0; a < Dim; ++a) {
    grain.start[a] = motion[Motion::start_velocity + a];
    grain.end[a] = motion[Motion::end_velocity + a];
    grain.gradient[a] = surface[Surface::gradient + a];
    grain.place[a] = grain.volume > 0.0 ? surface[Surface::place + a] / grain.volume : 0.0;
  }
  return grain;
}

/// Largest component of the sum of all impulses at a node, over that of their sizes.
template <int Dim>
double momentum_residual(const std::array<Entry<Dim>, most_grains_at_node>& entries, int count) {
  using Motion = MotionLane<Dim>;
  double worst = 0.0;
  for (int a = 0; a < Dim; ++a) {
    double sum = 0.0, size = 0.0;
    for (int k = 0; k < count; ++k) {
      const NodeGrain<Dim>& grain = entries[k].grain;
      const double before = (*entries[k].motion)[Motion::end_velocity + a];
      sum += grain.mass * (grain.end[a] - before);
      size += grain.mass * (std::abs(grain.end[a]) + std::abs(before));
    }
    if (size > 0.0) worst = std::max(worst, std::abs(sum) / size);
  }
  return worst;
}

template <int Dim>
void write_grain(const NodeGrain<Dim>& grain, Lanes& motion, Lanes& surface) {
  using Motion = MotionLane<Dim>;
  using Collision = CollisionLane<Dim>;
  for (int a = 0; a < Dim; ++a) {
    surface[Collision::change + a] = grain.end[a] - motion[Motion::end_velocity + a];
    surface[Collision::end + a] = grain.end[a];
    motion[Motion::end_velocity + a] = grain.end[a];
  }
  motion[Motion::heat] += grain.heat / grain.mass;
}

template <int Dim>
void collide_node(const std::vector<ContactField>& fields, int row, int node, bool owned,
                  const ContactSettings& settings, const FaceTable& faces, NodeLedger& ledger,
                  ContactSummary& summary) {
  std::array<Entry<Dim>, most_grains_at_node> entries;
  int count = 0;
  for (const ContactField& field : fields) {
    Lanes& motion = field.motion->row(row)[node];
    if (!(motion[MotionLane<Dim>::mass] > 0.0) || count == most_grains_at_node) continue;
    Lanes& surface = field.surface->row(row)[node];
    const Entry<Dim> entry{read_grain<Dim>(motion, surface), &motion, &surface};
    int place = count++;
    for (; place > 0 && comes_before<Dim>(entry, entries[place - 1]); --place) {
      entries[place] = entries[place - 1];
    }
    entries[place] = entry;
  }
  std::array<NodeGrain<Dim>, most_grains_at_node> grains;
  for (int k = 0; k < count; ++k) grains[k] = entries[k].grain;
  const ContactReport report = resolve_contact<Dim>(
      std::span<NodeGrain<Dim>>(grains.data(), static_cast<std::size_t>(count)), settings, faces);
  for (int k = 0; k < count; ++k) entries[k].grain = grains[k];
  if (owned) {
    ledger.contact_heat += quantise(report.impact_heat, ledger.inverse_energy_quantum);
    ledger.friction_heat += quantise(report.friction_heat, ledger.inverse_energy_quantum);
    if (report.pairs > 0) ++summary.nodes;
    if (count > 2) ++summary.crowded_nodes;
    summary.least_gap = std::min(summary.least_gap, report.least_gap);
    summary.penetration = std::max(summary.penetration, report.penetration);
    summary.residual = std::max(summary.residual, momentum_residual<Dim>(entries, count));
  }
  for (int k = 0; k < count; ++k) {
    write_grain<Dim>(entries[k].grain, *entries[k].motion, *entries[k].surface);
  }
}

}  // namespace

double node_capacity(const GridShape& shape, const Transfer& transfer, int row, int lateral) {
  const double beyond = share_beyond(transfer);
  double space = 1.0;
  for (int a = 0; a < shape.dimension; ++a) space *= shape.cell;
  space = space * share_inside(row, shape.rows, false, beyond);
  space *= share_inside(lateral % shape.nodes[0], shape.nodes[0], shape.periodic[0], beyond);
  if (shape.dimension == 2) return space;
  return space * share_inside(lateral / shape.nodes[0], shape.nodes[1], shape.periodic[1], beyond);
}

std::vector<bool> shared_nodes(const std::vector<ContactField>& fields, int mass_lane) {
  const SlabGrid& grid = *fields.front().motion;
  const int width = grid.shape().row_size;
  std::vector<bool> shared(static_cast<std::size_t>(grid.node_end() - grid.first_row()) * width);
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    const std::size_t at = static_cast<std::size_t>(row - grid.first_row()) * width;
    for (int i = 0; i < width; ++i) {
      int count = 0;
      for (const ContactField& field : fields) {
        if (field.motion->row(row)[i][mass_lane] > 0.0) ++count;
      }
      shared[at + i] = count > 1;
    }
  }
  return shared;
}

template <int Dim>
ContactSummary collide_grains(const std::vector<ContactField>& fields,
                              const std::vector<bool>& shared, const Scene& scene,
                              ContactSettings settings, const FaceTable& faces,
                              NodeLedger& ledger) {
  const SlabGrid& grid = *fields.front().motion;
  const GridShape& shape = grid.shape();
  ContactSummary summary;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    const std::size_t at = static_cast<std::size_t>(row - grid.first_row()) * shape.row_size;
    for (int i = 0; i < shape.row_size; ++i) {
      if (!shared[at + i]) continue;
      settings.capacity = node_capacity(shape, scene.transfer, row, i);
      collide_node<Dim>(fields, row, i, row < grid.last_row(), settings, faces, ledger, summary);
    }
  }
  return summary;
}

template <int Dim>
void settle_contact_heat(const std::vector<ContactField>& fields, const std::vector<bool>& shared,
                         NodeLedger& ledger) {
  using Motion = MotionLane<Dim>;
  using Collision = CollisionLane<Dim>;
  const SlabGrid& grid = *fields.front().motion;
  const int width = grid.shape().row_size;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    const std::size_t at = static_cast<std::size_t>(row - grid.first_row()) * width;
    for (int i = 0; i < width; ++i) {
      if (!shared[at + i]) continue;
      for (const ContactField& field : fields) {
        Lanes& motion = field.motion->row(row)[i];
        const Lanes& collision = field.surface->row(row)[i];
        if (!(motion[Motion::mass] > 0.0)) continue;
        double heat = 0.0;
        for (int a = 0; a < Dim; ++a) {
          const double moved = motion[Motion::end_velocity + a] - collision[Collision::end + a];
          heat -= collision[Collision::change + a] * (0.5 * moved);
        }
        if (heat == 0.0) continue;
        motion[Motion::heat] += heat;
        if (row >= grid.last_row()) continue;
        ledger.contact_heat += quantise(motion[Motion::mass] * heat, ledger.inverse_energy_quantum);
      }
    }
  }
}

template void settle_contact_heat<2>(const std::vector<ContactField>&, const std::vector<bool>&,
                                     NodeLedger&);
template void settle_contact_heat<3>(const std::vector<ContactField>&, const std::vector<bool>&,
                                     NodeLedger&);
template ContactSummary collide_grains<2>(const std::vector<ContactField>&,
                                          const std::vector<bool>&, const Scene&, ContactSettings,
                                          const FaceTable&, NodeLedger&);
template ContactSummary collide_grains<3>(const std::vector<ContactField>&,
                                          const std::vector<bool>&, const Scene&, ContactSettings,
                                          const FaceTable&, NodeLedger&);

}  // namespace poreshock
