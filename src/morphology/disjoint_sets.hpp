#pragma once
// Disjoint sets of nodes on a map with periodic sides. Private to the layer.

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace poreshock {

/// How often a path crosses the periodic sides, upwards counted positive: x, y.
struct Crossings {
  std::int32_t x = 0;
  std::int32_t y = 0;
  bool operator==(const Crossings&) const = default;
};

inline Crossings operator+(Crossings a, Crossings b) {
  return {a.x + b.x, a.y + b.y};
}
inline Crossings operator-(Crossings a, Crossings b) {
  return {a.x - b.x, a.y - b.y};
}

/// Union-find, by size and with path halving, in which every node knows its crossings from the root
/// of its set (Tarjan, J. ACM 22 (1975) 215). A node that can be reached with two different numbers
/// of crossings lies on a path that winds.
class DisjointSets {
 public:
  struct Place {
    std::uint32_t root;
    Crossings from_root;
  };
  /// What joining two nodes did.
  struct Joined {
    std::uint32_t root;      ///< of the joint set
    std::uint32_t absorbed;  ///< former root of the other set; `root` when it was one set before
    Crossings winding;       ///< not zero: this path winds, in one set
    Crossings shift;         ///< of the absorbed root from `root`
  };

  explicit DisjointSets(std::size_t nodes) : nodes_(nodes) {
    for (std::size_t i = 0; i < nodes; ++i) nodes_[i].parent = static_cast<std::uint32_t>(i);
  }

  std::size_t size() const { return nodes_.size(); }

  /// Adds a node, a set of its own, and returns its number.
  std::uint32_t add() {
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({node, 1, {}});
    return node;
  }

  Place find(std::uint32_t node) {
    Crossings total;
    while (nodes_[node].parent != node) {
      Node& here = nodes_[node];
      const Node& above = nodes_[here.parent];
      here.shift = here.shift + above.shift;  // zero for a root
      here.parent = above.parent;
      total = total + here.shift;
      node = here.parent;
    }
    return {node, total};
  }

  /// A node of the same set, nearer to its root; a root's is itself.
  std::uint32_t parent(std::uint32_t node) const { return nodes_[node].parent; }

  /// Joins the sets of a and b, which is reached from a with `step` crossings.
  Joined join(std::uint32_t a, std::uint32_t b, Crossings step) {
    const Place at_a = find(a);
    const Place at_b = find(b);
    const Crossings apart = at_a.from_root + step - at_b.from_root;
    if (at_a.root == at_b.root) return {at_a.root, at_a.root, apart, {}};
    std::uint32_t root = at_a.root;
    std::uint32_t absorbed = at_b.root;
    Crossings shift = apart;
    if (nodes_[root].size < nodes_[absorbed].size) {
      std::swap(root, absorbed);
      shift = Crossings{} - shift;
    }
    nodes_[absorbed].parent = root;
    nodes_[absorbed].shift = shift;
    nodes_[root].size += nodes_[absorbed].size;
    return {root, absorbed, {}, shift};
  }

  /// Hangs every node directly below its root.
  void flatten() {
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
      const Place at = find(i);
      nodes_[i].parent = at.root;
      nodes_[i].shift = at.from_root;
    }
  }

  /// The root of a node and its crossings from there, after flatten().
  Place place(std::uint32_t node) const { return {nodes_[node].parent, nodes_[node].shift}; }

 private:
  struct Node {
    std::uint32_t parent = 0;
    std::uint32_t size = 1;
    Crossings shift{};
  };
  std::vector<Node> nodes_;
};

}  // namespace poreshock
