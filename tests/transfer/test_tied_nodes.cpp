// Ties between velocity fields: a projection at nodes, and what the filter of FMPM makes of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "poreshock/transfer/velocity_filter.hpp"
#include "transfer/cycle.hpp"

namespace poreshock {
namespace {

using reference::Random;

template <int Dim>
Vector<Dim> random_vector(double size, Random& random) {
  Vector<Dim> v;
  for (int k = 0; k < Dim; ++k) v[k] = size * (2.0 * random.uniform() - 1.0);
  return v;
}

template <int Dim>
std::vector<Tie<Dim>> random_ties(int fields, Random& random) {
  std::vector<Tie<Dim>> ties;
  for (int a = 0; a < fields; ++a) {
    for (int b = a + 1; b < fields; ++b) {
      if (fields > 2 && random.uniform() < 0.3) continue;
      const Vector<Dim> n = random_vector<Dim>(1.0, random);
      ties.push_back({a, b, n / n.norm(), random.uniform() < 0.3});
    }
  }
  return ties;
}

/// One node of `fields` fields with masses over eight decades.
template <int Dim>
struct Case {
  TiedNodes<Dim> tied;
  std::vector<double> masses;
  std::vector<Tie<Dim>> ties;
};

template <int Dim>
Case<Dim> random_case(int fields, Random& random) {
  Case<Dim> result;
  TiedNode<Dim> node;
  node.count = fields;
  for (int f = 0; f < fields; ++f) {
    node.field[f] = static_cast<std::int8_t>(f);
    result.masses.push_back(std::pow(10.0, -8.0 * random.uniform()));
  }
  result.ties = random_ties<Dim>(fields, random);
  tie_node<Dim>(node, result.masses, result.ties, result.tied);
  return result;
}

template <int Dim>
double product(const std::vector<double>& masses, const FieldNumbers<Dim>& a,
               const FieldNumbers<Dim>& b) {
  double sum = 0.0;
  for (std::size_t f = 0; f < masses.size(); ++f) sum += masses[f] * a[f].dot(b[f]);
  return sum;
}

template <int Dim>
FieldNumbers<Dim> random_velocities(Random& random) {
  FieldNumbers<Dim> v;
  for (auto& x : v) x = random_vector<Dim>(100.0, random);
  return v;
}

// Momentum stays, no kinetic energy comes in, ties hold, doing it twice changes nothing, and the
// product of two velocities does not care which of them is tied.
template <int Dim>
void expect_projection() {
  Random random{5};
  for (int n = 0; n < 300; ++n) {
    const int fields = 2 + n % 4;
    const Case<Dim> c = random_case<Dim>(fields, random);
    if (c.tied.nodes.empty()) continue;
    const auto u = random_velocities<Dim>(random), v = random_velocities<Dim>(random);
    const auto pu = tie_velocities<Dim>(c.tied, c.tied.nodes[0], u);
    const auto pv = tie_velocities<Dim>(c.tied, c.tied.nodes[0], v);
    const auto ppv = tie_velocities<Dim>(c.tied, c.tied.nodes[0], pv);
    const double size = product<Dim>(c.masses, u, u) + product<Dim>(c.masses, v, v);
    EXPECT_LE(product<Dim>(c.masses, pv, pv), product<Dim>(c.masses, v, v) + 1e-14 * size);
    EXPECT_NEAR(product<Dim>(c.masses, pu, v), product<Dim>(c.masses, u, pv), 1e-13 * size);
    Vector<Dim> change = Vector<Dim>::Zero();
    double mass = 0.0;
    for (int f = 0; f < fields; ++f) {
      change += c.masses[f] * (pv[f] - v[f]);
      mass += c.masses[f];
      // Light fields follow the rounding of heavy ones.
      EXPECT_LE(std::sqrt(c.masses[f]) * (ppv[f] - pv[f]).norm(), 1e-11 * std::sqrt(size));
    }
    EXPECT_LE(change.norm(), 1e-14 * mass * 100.0);
    if (fields > 2) continue;
    const Vector<Dim> slip = pv[1] - pv[0];
    const Tie<Dim>& tie = c.ties[0];
    EXPECT_LE(tie.stuck ? slip.norm() : std::abs(slip.dot(tie.normal)), 1e-10);
    const Vector<Dim> across = (v[1] - v[0]) - tie.normal * tie.normal.dot(v[1] - v[0]);
    if (!tie.stuck) {
      EXPECT_LE((slip - across).norm(), 1e-10);
    }
  }
}

TEST(TiedNodes, AreAProjection) {
  expect_projection<2>();
  expect_projection<3>();
}

/// The particles of a slab in two fields, by their ids.
CellOrder half_of(const CellOrder& cells, const Particles<2>& particles, int half) {
  CellOrder result;
  result.awake = cells.awake;
  result.start.push_back(0);
  for (std::size_t c = 0; c + 1 < cells.start.size(); ++c) {
    for (std::uint32_t k = cells.start[c]; k < cells.start[c + 1]; ++k) {
      const std::uint32_t p = cells.order[k];
      if (static_cast<int>(particles.id[p] % 2) == half) result.order.push_back(p);
    }
    result.start.push_back(static_cast<std::uint32_t>(result.order.size()));
  }
  return result;
}

// Two fields on top of each other, tied at two thirds of the nodes: what the filter takes is heat,
// nowhere negative.
TEST(TiedNodes, TheFilterClosesTheEnergy) {
  for (const int order : {2, 3, 4, 5}) {
    SCOPED_TRACE(order);
    test::Cloud<2> cloud =
        test::make_cloud<2>({ShapeFunction::cubic, VelocityTransfer::fmpm, false});
    cloud.transfer.order = order;
    test::Slab<2> slab = test::make_slab(cloud, MPI_COMM_SELF);
    const CellOrder cells[2] = {half_of(slab.cells, slab.particles, 0),
                                half_of(slab.cells, slab.particles, 1)};
    const FilterField fields[2] = {{&cells[0], slab.grid.get()}, {&cells[1], slab.averages.get()}};
    for (const FilterField& f : fields) {
      particles_to_grid<2>(slab.particles, *f.cells, cloud.transfer, nullptr, *f.grid);
      f.grid->exchange();
    }
    TiedNodes<2> tied;
    Random random{9};
    for (int row = slab.grid->first_row(); row < slab.grid->node_end(); ++row) {
      for (int i = 0; i < slab.grid->shape().row_size; ++i) {
        const double masses[2] = {fields[0].grid->row(row)[i][0], fields[1].grid->row(row)[i][0]};
        if (!(masses[0] > 0.0 && masses[1] > 0.0) || random.uniform() < 1.0 / 3.0) continue;
        TiedNode<2> node;
        node.row = row, node.lateral = i, node.count = 2;
        node.field = {0, 1};
        tie_node<2>(node, masses, random_ties<2>(2, random), tied);
      }
    }
    ASSERT_GT(tied.nodes.size(), 20U);
    const double before = test::kinetic_energy(cloud.shape, slab.particles);
    const Vector<2> momentum = test::momentum(slab.particles);
    const std::vector<double> internal = slab.particles.internal_energy;
    const double quantum = power_of_two_below(std::ldexp(before, -60));
    Int128 booked = 0;
    filter_velocity<2>(fields, tied, cloud.transfer, 1.0 / quantum, slab.particles, slab.step,
                       booked);
    const double after = test::kinetic_energy(cloud.shape, slab.particles);
    double heat = 0.0, least = 0.0;
    for (std::size_t p = 0; p < slab.particles.size(); ++p) {
      const double gain = slab.particles.internal_energy[p] - internal[p];
      heat += slab.particles.mass[p] * gain;
      least = std::min(least, gain);
    }
    EXPECT_GE(least, 0.0);
    EXPECT_LT(after, before);
    EXPECT_NEAR(after + heat, before, 1e-13 * before);
    EXPECT_NEAR(static_cast<double>(booked) * quantum, heat, 1e-13 * before);
    EXPECT_LE((test::momentum(slab.particles) - momentum).norm(), 1e-13 * before / 500.0);
  }
}

}  // namespace
}  // namespace poreshock
