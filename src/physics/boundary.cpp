#include "poreshock/physics/boundary.hpp"

#include <array>
#include <cmath>

#include "poreshock/transfer/node_views.hpp"

namespace poreshock {

namespace {

enum class Place { inside, on_plane, mirrored };

/// Node indices first ... last - 1.
struct IndexRange {
  int first = 0, last = 0;
};

/// Where a node index lies with respect to the mirror planes of one axis, and its image.
struct AxisPlace {
  Place place = Place::inside;
  int image = 0;   ///< index of the mirror image
  int inward = 0;  ///< +1 at the low plane, -1 at the high one
  bool holds = false;
};

/// The planes lie one node inside the first and the last; one row of nodes beyond each is in use.
AxisPlace axis_place(int index, IndexRange nodes, const SideLaw& low, const SideLaw& high) {
  const int low_plane = nodes.first + 1, high_plane = nodes.last - 2;
  if (low.mirrors && index <= low_plane + 1) {
    return {index == low_plane ? Place::on_plane : Place::mirrored, 2 * low_plane - index, 1,
            low.holds};
  }
  if (high.mirrors && index >= high_plane - 1) {
    return {index == high_plane ? Place::on_plane : Place::mirrored, 2 * high_plane - index, -1,
            high.holds};
  }
  return {};
}

/// The nodes of one velocity field.
struct FieldNodes {
  SlabGrid* grid;
  int field;
};

/// Node indices along an axis.
IndexRange axis_nodes(const GridShape& shape, int axis) {
  return {axis + 1 == shape.dimension ? shape.first : 0, shape.nodes[axis]};
}

/// One set of mirror nodes: up to 2^Dim members with the signs that map their velocities onto the
/// first one's.
template <int Dim>
struct MirrorSet {
  struct Member {
    Lanes* node;
    std::array<double, Dim> sign;
    bool owned;
  };
  std::array<Member, 1 << Dim> member;
  int size = 0;
  std::array<bool, Dim> on_plane{};
  std::array<AxisPlace, Dim> place;
};

template <int Dim>
MirrorSet<Dim> mirror_set(const std::array<AxisPlace, Dim>& place,
                          const std::array<bool, Dim>& active, const std::array<int, Dim>& index,
                          FieldNodes nodes) {
  SlabGrid& grid = *nodes.grid;
  MirrorSet<Dim> set;
  set.place = place;
  for (int flips = 0; flips < (1 << Dim); ++flips) {
    std::array<int, Dim> at = index;
    std::array<double, Dim> sign;
    sign.fill(1.0);
    bool valid = true;
    for (int a = 0; a < Dim; ++a) {
      set.on_plane[a] = active[a] && place[a].place == Place::on_plane;
      if ((flips >> a & 1) == 0) continue;
      valid = valid && active[a] && place[a].place == Place::mirrored;
      at[a] = place[a].image;
      sign[a] = -1.0;
    }
    if (!valid) continue;
    std::ptrdiff_t lateral = at[0];
    if constexpr (Dim == 3) lateral += static_cast<std::ptrdiff_t>(at[1]) * grid.shape().nodes[0];
    Lanes* const node = grid.find(nodes.field, at[Dim - 1], static_cast<int>(lateral));
    // What the field does not have has no mass, and no particle sees it.
    if (node != nullptr) set.member[set.size++] = {node, sign, at[Dim - 1] < grid.last_row()};
  }
  return set;
}

/// Mass-weighted mean of the members' velocities relative to the planes, mapped onto the first one.
template <int Dim>
std::array<double, Dim> symmetric_velocity(const MirrorSet<Dim>& set, const Vector<Dim>& plane,
                                           double& mass) {
  std::array<double, Dim> momentum{};
  mass = 0.0;
  for (int k = 0; k < set.size; ++k) {
    const MotionNode<Dim> node{*set.member[k].node};
    mass += node.mass();
    for (int a = 0; a < Dim; ++a) {
      momentum[a] += set.member[k].sign[a] * node.mass() * (node.end(a) - plane[a]);
    }
  }
  std::array<double, Dim> velocity{};
  for (int a = 0; a < Dim; ++a) {
    velocity[a] = !(mass <= 0.0) && !set.on_plane[a] ? momentum[a] / mass : 0.0;
  }
  return velocity;
}

/// Impulse on the members along axis a, positive into the domain.
template <int Dim>
double inward_impulse(const MirrorSet<Dim>& set, const std::array<double, Dim>& velocity,
                      const Vector<Dim>& plane, int a) {
  double impulse = 0.0;
  for (int k = 0; k < set.size; ++k) {
    const MotionNode<Dim> node{*set.member[k].node};
    impulse += node.mass() * (set.member[k].sign[a] * velocity[a] + plane[a] - node.end(a));
  }
  return impulse * set.place[a].inward;
}

/// Takes Coulomb friction of the wall across the shock axis from the tangential velocity of a set,
/// at most as much as stops it; returns the change.
template <int Dim>
std::array<double, Dim> rub(double friction, double push, double mass,
                            std::array<double, Dim>& velocity) {
  std::array<double, Dim> change{};
  double square = 0.0;
  for (int a = 0; a + 1 < Dim; ++a) square += velocity[a] * velocity[a];
  const double speed = std::sqrt(square), most = friction * push / mass;
  if (!(most > 0.0) || !(speed > 0.0)) return change;
  const double share = most < speed ? most / speed : 1.0;
  for (int a = 0; a + 1 < Dim; ++a) {
    change[a] = -share * velocity[a];
    velocity[a] += change[a];
  }
  return change;
}

template <int Dim>
void impose(const MirrorSet<Dim>& set, const std::array<double, Dim>& velocity,
            const std::array<double, Dim>& rubbed, double mass, const Vector<Dim>& plane,
            NodeLedger& ledger) {
  double heat = 0.0, friction_heat = 0.0;
  for (int k = 0; k < set.size; ++k) {
    const MotionNode<Dim> node{*set.member[k].node};
    double work = 0.0;
    for (int a = 0; a < Dim; ++a) {
      const double end = set.member[k].sign[a] * velocity[a] + plane[a];
      const double impulse = node.mass() * (end - node.end(a));
      node.set_end(a, end);
      heat -= impulse * (node.middle(a) - plane[a]);
      const double rubbing = node.mass() * (set.member[k].sign[a] * rubbed[a]);
      friction_heat -= rubbing * (node.middle(a) - plane[a]);
      work += impulse * plane[a];
      if (set.member[k].owned) {
        ledger.wall_impulse[a] += quantise(impulse, ledger.inverse_momentum_quantum);
      }
    }
    if (set.member[k].owned) ledger.wall_work += quantise(work, ledger.inverse_energy_quantum);
  }
  const double per_mass = heat / mass, rubbed_per_mass = friction_heat / mass;
  for (int k = 0; k < set.size; ++k) {
    const MotionNode<Dim> node{*set.member[k].node};
    node.add_heat(per_mass);
    if (set.member[k].owned) {
      const double all = node.mass() * per_mass;
      const double rubbing = node.mass() * rubbed_per_mass;
      ledger.wall_heat += quantise(all - rubbing, ledger.inverse_energy_quantum);
      ledger.friction_heat += quantise(rubbing, ledger.inverse_energy_quantum);
    }
  }
}

/// Projects one set; where a wall would pull, its axis is given up and both halves are tried
/// without.
template <int Dim>
void project(const std::array<AxisPlace, Dim>& place, const std::array<bool, Dim>& active,
             const std::array<int, Dim>& index, const Vector<Dim>& plane, double friction,
             FieldNodes nodes, NodeLedger& ledger) {
  const MirrorSet<Dim> set = mirror_set<Dim>(place, active, index, nodes);
  double mass = 0.0;
  std::array<double, Dim> velocity = symmetric_velocity<Dim>(set, plane, mass);
  if (mass <= 0.0) return;
  for (int a = Dim - 1; a >= 0; --a) {
    if (!active[a] || place[a].holds) continue;
    if (inward_impulse<Dim>(set, velocity, plane, a) >= 0.0) continue;
    std::array<bool, Dim> rest = active;
    rest[a] = false;
    bool any = false;
    for (int b = 0; b < Dim; ++b) any = any || rest[b];
    if (!any) return;
    project<Dim>(place, rest, index, plane, friction, nodes, ledger);
    if (place[a].place == Place::mirrored) {
      std::array<int, Dim> other = index;
      other[a] = place[a].image;
      project<Dim>(place, rest, other, plane, friction, nodes, ledger);
    }
    return;
  }
  constexpr int shock = Dim - 1;
  std::array<double, Dim> rubbed{};
  if (friction > 0.0 && active[shock]) {
    const double push = inward_impulse<Dim>(set, velocity, plane, shock);
    rubbed = rub<Dim>(friction, push, mass, velocity);
  }
  impose<Dim>(set, velocity, rubbed, mass, plane, ledger);
}

/// Calls visit(field, lateral) for all nodes of a row that a field has.
template <class Visit>
void for_each_place(const SlabGrid& grid, int row, Visit&& visit) {
  for (int field = 0; field < grid.fields(); ++field) {
    for (const NodeRun& run : runs_of(grid.layout(), field, row)) {
      for (int lateral = run.first; lateral < run.last; ++lateral) visit(field, lateral);
    }
  }
}

}  // namespace

bool is_mirrored(const Boundary& boundary, const GridShape& shape, int row, int lateral) {
  const auto on_axis = [&](int axis, int index) {
    const SideLaw& low = side_law(side_kind(boundary, axis, false, shape.dimension));
    const SideLaw& high = side_law(side_kind(boundary, axis, true, shape.dimension));
    return axis_place(index, axis_nodes(shape, axis), low, high).place != Place::inside;
  };
  const int x = lateral % shape.nodes[0], y = lateral / shape.nodes[0];
  return on_axis(shape.dimension - 1, row) || on_axis(0, x) ||
         (shape.dimension == 3 && on_axis(1, y));
}

template <int Dim>
void apply_boundaries(const Boundary& boundary, const Vector<Dim>& grid_velocity, SlabGrid& grid,
                      NodeLedger& ledger) {
  const GridShape& shape = grid.shape();
  bool sides = false;
  std::array<std::array<SideLaw, 2>, Dim> law;
  for (int a = 0; a < Dim; ++a) {
    for (const bool high : {false, true}) {
      law[a][high] = side_law(side_kind(boundary, a, high, Dim));
      sides = sides || (a + 1 < Dim && law[a][high].mirrors);
    }
  }
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    if (!sides && is_inner_index(row, shape.first, shape.rows)) continue;
    for_each_place(grid, row, [&](int field, int lateral) {
      std::array<int, Dim> index;
      index[0] = lateral % shape.nodes[0];
      if constexpr (Dim == 3) index[1] = lateral / shape.nodes[0];
      index[Dim - 1] = row;
      std::array<AxisPlace, Dim> place;
      std::array<bool, Dim> active{};
      bool any = false, original = true;
      for (int a = 0; a < Dim; ++a) {
        const IndexRange nodes = axis_nodes(shape, a);
        place[a] = axis_place(index[a], nodes, law[a][0], law[a][1]);
        active[a] = place[a].place != Place::inside;
        any = any || active[a];
        // Each set is handled once, from its member inside the domain.
        const bool beyond = index[a] == nodes.first || index[a] == nodes.last - 1;
        original = original && !(active[a] && beyond);
      }
      if (!any || !original) return;
      const Side& side = place[Dim - 1].inward > 0 ? boundary.low : boundary.high;
      project<Dim>(place, active, index, grid_velocity, side.friction, {&grid, field}, ledger);
    });
  }
}

template void apply_boundaries<2>(const Boundary&, const Vector<2>&, SlabGrid&, NodeLedger&);
template void apply_boundaries<3>(const Boundary&, const Vector<3>&, SlabGrid&, NodeLedger&);

}  // namespace poreshock
