// Nodes that collide together have the bits of nodes that collide alone.
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "poreshock/physics/contact.hpp"
#include "support/random_numbers.hpp"

namespace {

using namespace poreshock;

constexpr double cell = 1e-5;

/// Grains that fill a node at random and close in on its middle.
template <int Dim>
std::vector<NodeGrain<Dim>> crowd(int count, reference::Random& random) {
  double space = 1.0;
  for (int k = 0; k < Dim; ++k) space *= cell;
  std::vector<NodeGrain<Dim>> grains(static_cast<std::size_t>(count));
  for (NodeGrain<Dim>& g : grains) {
    g.mass = 1e-7 * (0.2 + random.uniform());
    g.volume = space / count;
    g.strain = random.uniform();
    for (int k = 0; k < Dim; ++k) {
      g.place[k] = cell * (random.uniform() - 0.5);
      g.gradient[k] = -g.place[k] / cell * space / cell;
      g.start[k] = -100.0 * g.place[k] / cell + 20.0 * (random.uniform() - 0.5);
      g.end[k] = g.start[k] + 10.0 * (random.uniform() - 0.5);
    }
  }
  return grains;
}

/// Bits that differ between nodes resolved together and one by one, and how many pairs pushed.
template <int Dim>
void expect_bits_of_single_nodes(int count, double friction) {
  Transfer transfer;
  const FaceTable faces(transfer);
  reference::Random random{static_cast<std::uint64_t>(count)};
  std::vector<std::vector<NodeGrain<Dim>>> together, alone;
  for (int n = 0; n < most_contact_nodes; ++n) together.push_back(crowd<Dim>(count, random));
  alone = together;
  std::vector<ContactNode<Dim>> nodes;
  for (auto& grains : together) {
    ContactSettings settings{.friction = friction, .gap_test = false, .cell = cell, .kept = 0.9};
    settings.mirrored = nodes.size() % 5 == 4;
    nodes.push_back({grains, settings, nullptr, {}});
  }
  resolve_contacts<Dim>(nodes, faces);
  int pairs = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const ContactReport report = resolve_contact<Dim>(alone[n], nodes[n].settings, faces);
    EXPECT_EQ(nodes[n].report.pairs, report.pairs);
    EXPECT_EQ(nodes[n].report.friction_heat, report.friction_heat);
    EXPECT_EQ(std::memcmp(together[n].data(), alone[n].data(),
                          sizeof(NodeGrain<Dim>) * together[n].size()),
              0)
        << count << " grains, node " << n;
    pairs += report.pairs;
  }
  EXPECT_GT(pairs, most_contact_nodes / 2);
}

TEST(ContactBatch, NodesDoNotFeelEachOther) {
  for (int count = 2; count <= most_grains_at_node; ++count) {
    for (const double friction : {0.0, 0.4}) {
      expect_bits_of_single_nodes<2>(count, friction);
      expect_bits_of_single_nodes<3>(count, friction);
    }
  }
}

}  // namespace
