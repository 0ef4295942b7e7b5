#include "poreshock/physics/grain_ties.hpp"

#include "node_entries.hpp"

namespace poreshock {

template <int Dim>
TiedNodes<Dim> tie_grains(const std::vector<ContactField>& fields, const std::vector<bool>& shared,
                          const Scene& scene, ContactSettings settings, const FaceTable& faces,
                          const NodePoints<Dim>& points) {
  TiedNodes<Dim> tied;
  for_each_shared(*fields.front().motion, shared, scene, settings,
                  [&](int row, int i, std::size_t number, const ContactSettings& here) {
                    Entries<Dim> entries;
                    TiedNode<Dim> node;
                    node.row = row, node.lateral = i;
                    node.count = read_entries<Dim>(fields, row, i, entries);
                    std::array<NodeGrain<Dim>, most_grains_at_node> grains;
                    std::array<double, most_grains_at_node> masses{};
                    for (int k = 0; k < node.count; ++k) {
                      grains[k] = entries[k].grain;
                      masses[k] = entries[k].grain.mass;
                      node.field[k] = entries[k].field;
                    }
                    const std::size_t count = static_cast<std::size_t>(node.count);
                    Vector<Dim> normal;
                    NodeTies<Dim> ties;
                    const int found = find_ties<Dim>(
                        std::span<const NodeGrain<Dim>>(grains.data(), count), here, faces,
                        parting<Dim>(points_of(points, number), entries, node.count, normal), ties);
                    tie_node<Dim>(
                        node, std::span<const double>(masses.data(), count),
                        std::span<const Tie<Dim>>(ties.data(), static_cast<std::size_t>(found)),
                        tied);
                  });
  return tied;
}

template <int Dim>
void tie_momenta(const std::vector<ContactField>& fields, TiedNodes<Dim>& tied) {
  using Sum = SumLane<Dim>;
  for (TiedNode<Dim>& node : tied.nodes) {
    FieldNumbers<Dim> start;
    const auto lanes = [&](int f) -> Lanes& {
      return fields[static_cast<std::size_t>(node.field[f])].motion->row(node.row)[node.lateral];
    };
    for (int f = 0; f < node.count; ++f) {
      for (int a = 0; a < Dim; ++a) start[f][a] = lanes(f)[Sum::momentum + a] / lanes(f)[Sum::mass];
    }
    const FieldNumbers<Dim> held = tie_velocities<Dim>(tied, node, start);
    for (int f = 0; f < node.count; ++f) {
      node.taken[f] = start[f] - held[f];
      for (int a = 0; a < Dim; ++a) lanes(f)[Sum::momentum + a] = lanes(f)[Sum::mass] * held[f][a];
    }
  }
}

template <int Dim>
void settle_tie_heat(const std::vector<ContactField>& fields, const TiedNodes<Dim>& tied,
                     NodeLedger& ledger) {
  using Motion = MotionLane<Dim>;
  for (const TiedNode<Dim>& node : tied.nodes) {
    const SlabGrid& grid = *fields.front().motion;
    for (int f = 0; f < node.count; ++f) {
      Lanes& motion =
          fields[static_cast<std::size_t>(node.field[f])].motion->row(node.row)[node.lateral];
      double heat = 0.0;
      for (int a = 0; a < Dim; ++a) {
        heat -= node.taken[f][a] *
                (motion[Motion::end_velocity + a] - motion[Motion::start_velocity + a]);
      }
      motion[Motion::heat] += heat;
      if (node.row >= grid.last_row()) continue;
      ledger.contact_heat += quantise(motion[Motion::mass] * heat, ledger.inverse_energy_quantum);
    }
  }
}

template TiedNodes<2> tie_grains<2>(const std::vector<ContactField>&, const std::vector<bool>&,
                                    const Scene&, ContactSettings, const FaceTable&,
                                    const NodePoints<2>&);
template TiedNodes<3> tie_grains<3>(const std::vector<ContactField>&, const std::vector<bool>&,
                                    const Scene&, ContactSettings, const FaceTable&,
                                    const NodePoints<3>&);
template void tie_momenta<2>(const std::vector<ContactField>&, TiedNodes<2>&);
template void tie_momenta<3>(const std::vector<ContactField>&, TiedNodes<3>&);
template void settle_tie_heat<2>(const std::vector<ContactField>&, const TiedNodes<2>&,
                                 NodeLedger&);
template void settle_tie_heat<3>(const std::vector<ContactField>&, const TiedNodes<3>&,
                                 NodeLedger&);

}  // namespace poreshock
