#pragma once
// Private to physics: the least impulses that keep the pairs of grains of a node from closing, for
// several nodes at once.

#include "poreshock/core/lanes.hpp"
#include "tied_space.hpp"

namespace poreshock {

/// Two grains of a node.
template <int Dim>
struct Pair {
  int a, b;
  Vector<Dim> normal;  ///< from a to b
  double reduced;      ///< kg, m_a m_b / (m_a + m_b)
  bool rubs;           ///< false where the normal is only a guess
  double push;         ///< kg m/s along the normal, on b
  Vector<Dim> rub;     ///< kg m/s across it, on b
};

/// Pairs of a node that may push each other, and velocities that these change.
template <int Dim, std::size_t Count>
struct PushedNode {
  std::span<const NodeGrain<Dim>> grains;
  std::span<Pair<Dim>> pairs;
  NodeVelocities<Dim, Count>* velocity = nullptr;
};

namespace pushes {

inline constexpr int most_sweeps = 64;
inline constexpr double converged = 1e-3;  // change of the impulses in a sweep, over their sum

/// The pair of a grain a and one behind it at several nodes, a node a lane.
template <int Dim>
struct PairLanes {
  Lanes normal[Dim];
  Lanes reduced, push;
};

/// Several nodes, a node a lane. Pairs that are not there never push.
template <int Dim, std::size_t Count>
struct NodeLanes {
  Lanes velocity[Count][Dim], inverse_mass[Count];
  PairLanes<Dim> pair[Count][Count];  ///< by their grains, the first is the smaller
  Lanes live;                         ///< 0 for nodes whose impulses stand
  Lanes change, sum;                  ///< sizes of impulses in a sweep
};

/// Gives the pair of two grains the impulse with which it does not close.
template <std::size_t A, std::size_t B, int Dim, std::size_t Count>
inline void push_pair(NodeLanes<Dim, Count>& nodes) {
  PairLanes<Dim>& pair = nodes.pair[A][B];
  Lanes opening = (nodes.velocity[B][0] - nodes.velocity[A][0]) * pair.normal[0];
  for (int k = 1; k < Dim; ++k) {
    opening += (nodes.velocity[B][k] - nodes.velocity[A][k]) * pair.normal[k];
  }
  const Lanes least = larger(pair.push - pair.reduced * opening, Lanes{});
  const Lanes push = where_differ(nodes.live, Lanes{}, least, pair.push);
  const Lanes more = push - pair.push;
  for (int k = 0; k < Dim; ++k) {
    const Lanes impulse = pair.normal[k] * more;
    Lanes &a = nodes.velocity[A][k], &b = nodes.velocity[B][k];
    a = where_differ(push, pair.push, a - impulse * nodes.inverse_mass[A], a);
    b = where_differ(push, pair.push, b + impulse * nodes.inverse_mass[B], b);
  }
  nodes.change += larger(more, Lanes{} - more);
  nodes.sum += push;
  pair.push = push;
}

/// The pairs of grain A with those behind it, in their order or back.
template <std::size_t A, bool Back, int Dim, std::size_t Count>
inline void sweep_pairs_of(NodeLanes<Dim, Count>& nodes) {
  [&]<std::size_t... K>(std::index_sequence<K...>) {
    (push_pair < A, Back ? Count - 1 - K : A + 1 + K > (nodes), ...);
  }
  (std::make_index_sequence<Count - 1 - A>{});
}

template <bool Back, int Dim, std::size_t Count>
inline void sweep_pairs(NodeLanes<Dim, Count>& nodes) {
  nodes.change = nodes.sum = Lanes{};
  [&]<std::size_t... K>(std::index_sequence<K...>) {
    (sweep_pairs_of < Back ? Count - 2 - K : K, Back > (nodes), ...);
  }
  (std::make_index_sequence<Count - 1>{});
}

/// Puts a node into a lane.
template <int Dim, std::size_t Count, std::size_t Most>
void take_node(const PushedNode<Dim, Count>& node, int lane, NodeLanes<Dim, Most>& nodes) {
  for (std::size_t g = 0; g < node.grains.size(); ++g) {
    nodes.inverse_mass[g][lane] = 1.0 / node.grains[g].mass;
    for (int k = 0; k < Dim; ++k) nodes.velocity[g][k][lane] = (*node.velocity)[g][k];
    for (std::size_t h = g + 1; h < node.grains.size(); ++h) {
      PairLanes<Dim>& lanes = nodes.pair[g][h];
      for (int k = 0; k < Dim; ++k) lanes.normal[k][lane] = 0.0;
      lanes.reduced[lane] = lanes.push[lane] = 0.0;
    }
  }
  for (const Pair<Dim>& pair : node.pairs) {
    PairLanes<Dim>& lanes = nodes.pair[pair.a][pair.b];
    for (int k = 0; k < Dim; ++k) lanes.normal[k][lane] = pair.normal[k];
    lanes.reduced[lane] = pair.reduced;
  }
  nodes.live[lane] = 1.0;
}

template <int Dim, std::size_t Count, std::size_t Most>
void give_back(const NodeLanes<Dim, Most>& nodes, int lane, const PushedNode<Dim, Count>& node) {
  for (std::size_t g = 0; g < node.grains.size(); ++g) {
    for (int k = 0; k < Dim; ++k) (*node.velocity)[g][k] = nodes.velocity[g][k][lane];
  }
  for (Pair<Dim>& pair : node.pairs) pair.push = nodes.pair[pair.a][pair.b].push[lane];
}

/// The impulse of a pair alone.
template <int Dim, std::size_t Count>
void push_alone(const PushedNode<Dim, Count>& node) {
  Pair<Dim>& pair = node.pairs.front();
  Vector<Dim>&a = (*node.velocity)[pair.a], &b = (*node.velocity)[pair.b];
  pair.push = std::max(0.0 - pair.reduced * dot<Dim>(b - a, pair.normal), 0.0);
  if (!(pair.push > 0.0)) return;
  const Vector<Dim> impulse = pair.normal * pair.push;
  a -= impulse * (1.0 / node.grains[pair.a].mass);
  b += impulse * (1.0 / node.grains[pair.b].mass);
}

}  // namespace pushes

/// Adds to velocities the least impulses that keep the pairs of each node from closing:
/// Gauss-Seidel over all pairs, forth and back, until they stand. A single pair is solved by its
/// first step. Nodes do not feel each other: one that is done gives its lane to the next before a
/// sweep forth.
template <int Dim, std::size_t Count>
void find_pushes(std::span<const PushedNode<Dim, Count>> several) {
  std::size_t next = 0;
  const auto next_crowded = [&] {
    for (; next < several.size(); ++next) {
      if (several[next].pairs.size() > 1) return true;
      if (several[next].pairs.size() == 1) pushes::push_alone(several[next]);
    }
    return false;
  };
  if (!next_crowded()) return;
  pushes::NodeLanes<Dim, most_of<Count>> nodes{};
  std::array<const PushedNode<Dim, Count>*, lane_count> taken{};
  std::array<int, lane_count> sweeps{};
  for (bool goes_on = true, back = false; goes_on; back = !back) {
    for (int n = 0; n < lane_count && !back; ++n) {
      if (taken[n] != nullptr || !next_crowded()) continue;
      taken[n] = &several[next++];
      sweeps[n] = 0;
      pushes::take_node(*taken[n], n, nodes);
    }
    back ? pushes::sweep_pairs<true>(nodes) : pushes::sweep_pairs<false>(nodes);
    goes_on = false;
    for (int n = 0; n < lane_count; ++n) {
      if (taken[n] == nullptr) continue;
      const bool moves = nodes.change[n] > pushes::converged * nodes.sum[n];
      if (!moves || ++sweeps[n] == pushes::most_sweeps) {
        pushes::give_back(nodes, n, *taken[n]);
        taken[n] = nullptr;
        nodes.live[n] = 0.0;
      }
      goes_on = goes_on || taken[n] != nullptr;
    }
    goes_on = goes_on || next_crowded();
  }
}

}  // namespace poreshock
