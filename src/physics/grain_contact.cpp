#include "poreshock/physics/grain_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "node_entries.hpp"
#include "poreshock/physics/boundary.hpp"

namespace poreshock {

namespace {

/// Particles in one piece that is compressed fill a node up to this much too little or too much.
constexpr double noise_of_filling = 0.01;

/// Share of a node's space along one axis that lies inside the domain.
double share_inside(int index, int count, bool periodic, double beyond) {
  if (periodic) return 1.0;
  const int from_side = std::min(index, count - 1 - index);
  if (from_side == 0) return beyond;
  if (from_side == 1) return 0.5;
  return from_side == 2 ? 1.0 - beyond : 1.0;
}

/// Largest component of the sum of all impulses at a node, over that of their sizes.
template <int Dim>
double momentum_residual(std::span<NodeGrain<Dim>> grains, const Entry* entries) {
  using Motion = MotionLane<Dim>;
  double worst = 0.0;
  for (int a = 0; a < Dim; ++a) {
    double sum = 0.0, size = 0.0;
    for (std::size_t k = 0; k < grains.size(); ++k) {
      const NodeGrain<Dim>& grain = grains[k];
      const double before = (*entries[k].motion)[Motion::end_velocity + a];
      sum += grain.mass * (grain.end[a] - before);
      size += grain.mass * (std::abs(grain.end[a]) + std::abs(before));
    }
    if (size > 0.0) worst = std::max(worst, std::abs(sum) / size);
  }
  return worst;
}

/// Counts what happened at a node; the penetration is the volume over that of a cell here.
template <int Dim>
void book(const ContactNode<Dim>& node, const Entry* entries, NodeLedger& ledger,
          ContactSummary& summary) {
  const ContactReport& report = node.report;
  ledger.contact_heat += quantise(report.impact_heat, ledger.inverse_energy_quantum);
  ledger.friction_heat += quantise(report.friction_heat, ledger.inverse_energy_quantum);
  if (report.pairs > 0) ++summary.nodes;
  if (node.grains.size() > 2) ++summary.crowded_nodes;
  summary.least_gap = std::min(summary.least_gap, report.least_gap);
  summary.penetration = std::max(summary.penetration, report.excess);
  summary.residual = std::max(summary.residual, momentum_residual<Dim>(node.grains, entries));
}

template <int Dim>
void write_grain(const NodeGrain<Dim>& grain, double overfill, Lanes& motion, Lanes& surface) {
  using Motion = MotionLane<Dim>;
  using Collision = CollisionLane<Dim>;
  for (int a = 0; a < Dim; ++a) {
    surface[Collision::change + a] = grain.end[a] - motion[Motion::end_velocity + a];
    surface[Collision::end + a] = grain.end[a];
    motion[Motion::start_velocity + a] = grain.start[a];
    motion[Motion::end_velocity + a] = grain.end[a];
  }
  motion[Motion::heat] += grain.heat / grain.mass;
  if constexpr (shows_overfill<Dim>) motion[Motion::overfill] = overfill;
}

/// True where no side of the domain takes space from a node or moves it.
bool is_inner(const GridShape& shape, const NodePlace& place) {
  if (!is_inner_index(place.row, shape.first, shape.rows)) return false;
  if (shape.dimension == 2) return is_inner_index(place.lateral, 0, shape.nodes[0]);
  return is_inner_index(place.lateral % shape.nodes[0], 0, shape.nodes[0]) &&
         is_inner_index(place.lateral / shape.nodes[0], 0, shape.nodes[1]);
}

/// Shared nodes with one number of fields, which collide together.
template <int Dim>
struct NodeBatch {
  std::vector<ContactNode<Dim>> nodes;
  std::vector<Entry> entries;          ///< of the first node, then of the next
  std::vector<NodeGrain<Dim>> grains;  ///< in the same order
  std::vector<Vector<Dim>> normals;    ///< of the nodes
  std::vector<std::int32_t> rows;      ///< of the nodes
};

/// Adds a node; the caller sets its settings.
template <int Dim>
ContactNode<Dim>& add_node(int row, std::span<const Entry> entries,
                           std::span<const NodePoint<Dim>> points, NodeBatch<Dim>& batch) {
  if (batch.nodes.capacity() == 0) {
    batch.nodes.reserve(most_contact_nodes);
    batch.grains.reserve(most_contact_nodes * entries.size());
    batch.normals.reserve(most_contact_nodes);
  }
  NodeGrain<Dim>* const first = batch.grains.data() + batch.grains.size();
  for (const Entry& entry : entries) {
    batch.entries.push_back(entry);
    read_grain<Dim>(*entry.motion, *entry.surface, batch.grains.emplace_back());
  }
  batch.rows.push_back(row);
  ContactNode<Dim>& node = batch.nodes.emplace_back();
  node.grains = {first, entries.size()};
  node.normal = parting<Dim>(points, entries, batch.normals.emplace_back());
  return node;
}

/// Lets the nodes of a batch collide and takes them out.
template <int Dim>
void collide_batch(const ContactGrids& grids, const FaceTable& faces, NodeBatch<Dim>& batch,
                   NodeLedger& ledger, ContactSummary& summary) {
  if (batch.nodes.empty()) return;
  resolve_contacts<Dim>(batch.nodes, faces);
  const Entry* entry = batch.entries.data();
  for (std::size_t n = 0; n < batch.nodes.size(); ++n) {
    const ContactNode<Dim>& node = batch.nodes[n];
    if (batch.rows[n] < grids.motion.last_row()) book<Dim>(node, entry, ledger, summary);
    const bool pushed = node.report.pairs > 0;
    const double overfill = pushed ? std::max(0.0, node.report.excess - noise_of_filling) : 0.0;
    for (const NodeGrain<Dim>& grain : node.grains) {
      write_grain<Dim>(grain, overfill, *entry->motion, *entry->surface);
      ++entry;
    }
  }
  batch.nodes.clear(), batch.entries.clear(), batch.grains.clear();
  batch.normals.clear(), batch.rows.clear();
}

}  // namespace

double node_capacity(const GridShape& shape, const Transfer& transfer, int row, int lateral) {
  const double beyond = with_shape(transfer, [](const auto& s) { return s.share_beyond(); });
  double space = 1.0;
  for (int a = 0; a < shape.dimension; ++a) space *= shape.cell;
  space = space * share_inside(row - shape.first, shape.rows - shape.first, false, beyond);
  space *= share_inside(lateral % shape.nodes[0], shape.nodes[0], shape.periodic[0], beyond);
  if (shape.dimension == 2) return space;
  return space * share_inside(lateral / shape.nodes[0], shape.nodes[1], shape.periodic[1], beyond);
}

std::vector<NodePlace> shared_nodes(const SlabGrid& motion, int mass_lane) {
  std::vector<NodePlace> shared;
  if (motion.fields() == 1) return shared;
  std::vector<std::uint32_t> fields(static_cast<std::size_t>(motion.shape().row_size));
  for (int row = motion.first_row(); row < motion.node_end(); ++row) {
    std::ranges::fill(fields, 0U);
    for (int field = 0; field < motion.fields(); ++field) {
      for (const NodeRun& run : runs_of(motion.layout(), field, row)) {
        const Lanes* const nodes = motion.line(field, row, run.first) - run.first;
        for (int i = run.first; i < run.last; ++i) {
          const std::uint32_t there = nodes[i][mass_lane] > 0.0 ? 1U : 0U;
          fields[static_cast<std::size_t>(i)] |= there << field;
        }
      }
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const bool several = (fields[i] & (fields[i] - 1)) != 0;
      if (several) shared.push_back({row, static_cast<std::int32_t>(i), fields[i]});
    }
  }
  return shared;
}

template <int Dim>
ContactSummary collide_grains(const ContactGrids& grids, const std::vector<NodePlace>& shared,
                              const Scene& scene, const ContactSettings& settings,
                              const FaceTable& faces, const NodePoints<Dim>& points,
                              NodeLedger& ledger) {
  const GridShape& shape = grids.motion.shape();
  double space = 1.0;
  for (int a = 0; a < Dim; ++a) space *= shape.cell;
  ContactSummary summary;
  std::vector<NodeBatch<Dim>> batches(most_grains_at_node + 1);  // by the number of fields
  for (std::size_t n = 0; n < shared.size(); ++n) {
    const NodePlace& place = shared[n];
    Entries storage;
    const std::span<const Entry> entries = read_entries<Dim>(grids, place, storage);
    NodeBatch<Dim>& batch = batches[entries.size()];
    ContactSettings& here = add_node<Dim>(place.row, entries, points_of(points, n), batch).settings;
    here = settings;
    here.capacity = space;
    if (!is_inner(shape, place)) {
      here.capacity = node_capacity(shape, scene.transfer, place.row, place.lateral);
      here.mirrored = is_mirrored(scene.boundary, shape, place.row, place.lateral);
      if (here.mirrored) here.kept = 0.0;
    }
    if (batch.nodes.size() < most_contact_nodes) continue;
    collide_batch<Dim>(grids, faces, batch, ledger, summary);
  }
  for (NodeBatch<Dim>& batch : batches) {
    collide_batch<Dim>(grids, faces, batch, ledger, summary);
  }
  // As wide as a gap that lacks this volume.
  summary.penetration = summary.penetration * shape.cell / faces.density(0.5);
  return summary;
}

template <int Dim>
void settle_contact_heat(const ContactGrids& grids, const std::vector<NodePlace>& shared,
                         const Boundary& boundary, NodeLedger& ledger) {
  using Motion = MotionLane<Dim>;
  using Collision = CollisionLane<Dim>;
  for (const NodePlace& node : shared) {
    if (!is_mirrored(boundary, grids.motion.shape(), node.row, node.lateral)) continue;
    for (int field = 0; field < grids.motion.fields(); ++field) {
      Lanes* const motion = grids.motion.find(field, node.row, node.lateral);
      if (motion == nullptr || !((*motion)[Motion::mass] > 0.0)) continue;
      const Lanes& collision = *grids.surfaces.line(field, node.row, node.lateral);
      double heat = 0.0;
      for (int a = 0; a < Dim; ++a) {
        const double moved = (*motion)[Motion::end_velocity + a] - collision[Collision::end + a];
        heat -= collision[Collision::change + a] * (0.5 * moved);
      }
      (*motion)[Motion::heat] += heat;
      if (node.row >= grids.motion.last_row()) continue;
      ledger.contact_heat +=
          quantise((*motion)[Motion::mass] * heat, ledger.inverse_energy_quantum);
    }
  }
}

template void settle_contact_heat<2>(const ContactGrids&, const std::vector<NodePlace>&,
                                     const Boundary&, NodeLedger&);
template void settle_contact_heat<3>(const ContactGrids&, const std::vector<NodePlace>&,
                                     const Boundary&, NodeLedger&);
template ContactSummary collide_grains<2>(const ContactGrids&, const std::vector<NodePlace>&,
                                          const Scene&, const ContactSettings&, const FaceTable&,
                                          const NodePoints<2>&, NodeLedger&);
template ContactSummary collide_grains<3>(const ContactGrids&, const std::vector<NodePlace>&,
                                          const Scene&, const ContactSettings&, const FaceTable&,
                                          const NodePoints<3>&, NodeLedger&);

}  // namespace poreshock
