#include "poreshock/sample/fill.hpp"

#include <algorithm>
#include <limits>

#include "block.hpp"
#include "grains.hpp"
#include "islands.hpp"
#include "lattice.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/sample/bodies.hpp"

namespace poreshock {
namespace {

/// Owner of the first generated grain.
std::int32_t first_grain_owner(const Scene& scene) {
  return owner_first_body + static_cast<std::int32_t>(scene.bodies.size());
}

/// Takes the floating pieces of an overlapping sample out, or makes them grains, and counts them.
void settle_islands(const Scene& scene, const Lattice& lattice, LatticeRange range,
                    MPI_Comm communicator, std::vector<std::int32_t>& owners,
                    SampleReport& report) {
  const IslandPieces islands = find_islands(scene, report.voids, range, communicator);
  const bool become_grains = scene.sample.islands == Islands::grains;
  if (become_grains) report.grains = grains_of_islands(scene, lattice, islands);
  const std::int64_t first_site = range.first * lattice.layer_size();
  for (std::size_t p = 0; p < islands.pieces.size(); ++p) {
    // An island counts where its first site lies, so that counts of ranges add up.
    const std::int64_t first = islands.pieces[p].first - first_site;
    const bool here = first >= 0 && first < static_cast<std::int64_t>(owners.size());
    if (here && static_cast<std::int32_t>(p) != islands.largest) ++report.islands;
  }
  for (std::int64_t row = 0; row < islands.runs.rows(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    for (std::size_t n = islands.runs.row_start[r]; n < islands.runs.row_start[r + 1]; ++n) {
      const Run& run = islands.runs.runs[n];
      if (run.region == islands.largest) continue;
      const std::int32_t grain = run.region - (run.region > islands.largest ? 1 : 0);
      for (std::int64_t i = run.begin; i < run.end; ++i) {
        std::int32_t& owner = owners[static_cast<std::size_t>(row * lattice.sites[0] + i)];
        // Sites that a body took over stay.
        if (owner != owner_sample) continue;
        owner = become_grains ? first_grain_owner(scene) + grain : owner_none;
        ++report.island_particles;
      }
    }
  }
}

/// By owner: the sample and the bodies before this one that are one piece with it where they meet,
/// of the same material, grain and motion.
std::vector<bool> one_piece_with(const Scene& scene, std::size_t body) {
  const Body& own = scene.bodies[body];
  Body sample;
  sample.material = scene.sample.material;
  const auto same = [&](const Body& other) {
    return other.material == own.material && other.grain == own.grain &&
           move_alike(other, own, scene.dimension);
  };
  std::vector<bool> result{same(sample)};
  for (std::size_t b = 0; b < body; ++b) result.push_back(same(scene.bodies[b]));
  return result;
}

std::vector<std::int32_t> find_owners(const Scene& scene, const GrainLayout& layout,
                                      const Lattice& lattice, LatticeRange range,
                                      MPI_Comm communicator, SampleReport& report) {
  std::vector<std::int32_t> owners = sample_owners(scene, report.voids, range);
  give_grains(scene, layout, range, first_grain_owner(scene), owners);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    report.bodies.push_back(give_region(lattice, range, scene.bodies[b].region,
                                        owner_first_body + static_cast<std::int32_t>(b),
                                        one_piece_with(scene, b), owners));
  }
  for (const Region& region : scene.voids) {
    report.hollows.push_back(give_region(lattice, range, region, owner_none, {}, owners));
  }
  const auto bodies = static_cast<std::int32_t>(scene.bodies.size());
  for (const std::int32_t owner : owners) {
    const std::int32_t body = owner - owner_first_body;
    if (body >= 0 && body < bodies) ++report.bodies[static_cast<std::size_t>(body)].left;
  }
  const bool may_float = scene.sample.kind == SampleKind::random_voids && scene.sample.overlap;
  if (may_float) settle_islands(scene, lattice, range, communicator, owners, report);
  return owners;
}

/// What the particles of one owner have in common.
struct Motion {
  int material = 0;
  int grain = 0;
  double density = 0.0;  ///< kg/m^3
  Triple velocity{};     ///< m/s, at `centre`
  Triple spin{};         ///< rad/s
  Triple centre{};       ///< m
};

std::vector<Motion> find_motions(const Scene& scene, const std::vector<Grain>& grains) {
  Motion sample;
  sample.material = scene.sample.material;
  sample.velocity = scene.loading.frame;
  sample.velocity[static_cast<std::size_t>(scene.dimension - 1)] -= scene.loading.velocity;
  std::vector<Motion> motions{sample};
  for (const Body& body : scene.bodies) {
    Motion motion = sample;
    motion.material = body.material;
    motion.grain = body.grain;
    for (std::size_t axis = 0; axis < 3; ++axis) motion.velocity[axis] += body.velocity[axis];
    motion.spin = body.spin;
    if (scene.dimension == 2) motion.spin[0] = motion.spin[1] = 0.0;
    motion.centre = centroid(body.region, scene.dimension);
    motions.push_back(motion);
  }
  for (std::size_t g = 0; g < grains.size(); ++g) {
    Motion motion = sample;
    motion.material = grains[g].material;
    motion.grain = first_grain_number(scene) + static_cast<int>(g);
    motions.push_back(motion);
  }
  for (Motion& motion : motions) {
    if (motion.material < 0 || motion.material >= static_cast<int>(scene.materials.size())) {
      throw InputError("Material number " + std::to_string(motion.material) +
                       " was asked for. Allowed is 0 to below " +
                       std::to_string(scene.materials.size()) +
                       ". Name one of the scene's [[material]] entries.");
    }
    motion.density = scene.materials[static_cast<std::size_t>(motion.material)].density;
  }
  return motions;
}

/// Velocity gradient of a spin: dv_i/dx_j, all three axes.
std::array<Triple, 3> spin_gradient(const Triple& w) {
  return {Triple{0.0, -w[2], w[1]}, Triple{w[2], 0.0, -w[0]}, Triple{-w[1], w[0], 0.0}};
}

template <int Dim>
void set_particle(const Motion& motion, const Triple& position, double volume, std::size_t p,
                  Particles<Dim>& particles) {
  const std::array<Triple, 3> gradient = spin_gradient(motion.spin);
  particles.grain[p] = motion.grain;
  particles.material[p] = motion.material;
  particles.mass[p] = motion.density * volume;
  particles.density[p] = motion.density;
  for (std::size_t i = 0; i < Dim; ++i) {
    double turning = 0.0;
    for (std::size_t j = 0; j < Dim; ++j) {
      turning += gradient[i][j] * (position[j] - motion.centre[j]);
      if (particles.options.affine) particles.affine[i * Dim + j][p] = gradient[i][j];
    }
    particles.position[i][p] = position[i];
    particles.velocity[i][p] = motion.velocity[i] + turning;
  }
}

template <int Dim>
void make_particles(const Scene& scene, const Lattice& lattice, LatticeRange range,
                    const std::vector<std::int32_t>& owners, const std::vector<Grain>& grains,
                    Particles<Dim>& particles) {
  const std::vector<Motion> motions = find_motions(scene, grains);
  double volume = 1.0;
  for (int axis = 0; axis < Dim; ++axis) volume *= lattice.spacing;
  const auto filled = [](std::int32_t owner) { return owner != owner_none; };
  resize(particles, 0);
  resize(particles, static_cast<std::size_t>(std::count_if(owners.begin(), owners.end(), filled)));
  std::size_t p = 0;
  const std::int64_t first_id = range.first * lattice.layer_size();
  for (std::size_t site = 0; site < owners.size(); ++site) {
    if (!filled(owners[site])) continue;
    std::int64_t rest = first_id + static_cast<std::int64_t>(site);
    particles.id[p] = rest;
    Triple position{};
    for (int axis = 0; axis < Dim; ++axis) {
      position[axis] = site_coordinate(lattice, rest % lattice.sites[axis]);
      rest /= lattice.sites[axis];
    }
    set_particle(motions[static_cast<std::size_t>(owners[site])], position, volume, p++, particles);
  }
}

/// Share of the sample block's sites that hold no particle.
void set_particle_void_fraction(SampleReport& report) {
  report.particle_void_fraction =
      report.lattice_sites == 0
          ? 0.0
          : static_cast<double>(report.lattice_sites - report.block_particles) /
                static_cast<double>(report.lattice_sites);
}

}  // namespace

int first_grain_number(const Scene& scene) {
  int largest = 0;
  for (const Body& body : scene.bodies) largest = std::max(largest, body.grain);
  return largest + 1;
}

LatticeRange own_layers(std::int64_t layers, MPI_Comm communicator) {
  const std::int64_t me = rank(communicator), ranks = size(communicator);
  return {layers * me / ranks, layers * (me + 1) / ranks};
}

template <int Dim>
void fill(const Scene& scene, LatticeRange range, MPI_Comm communicator, Particles<Dim>& particles,
          SampleReport& report) {
  const Lattice lattice = make_lattice(scene);
  range.first = std::clamp(range.first, std::int64_t{0}, lattice.layers());
  range.last = std::clamp(range.last, range.first, lattice.layers());
  report = {};
  report.voids = place_voids(scene);
  report.least_gap = std::numeric_limits<double>::infinity();
  if (!report.voids.empty()) {
    const Block block = sample_block(scene);
    report.least_gap = least_gap(report.voids, block);
    report.geometric_void_fraction = void_fraction(report.voids, block);
  }
  const GrainLayout layout = place_grains(scene, range, communicator);
  if (makes_grains(scene.sample) || scene.sample.kind == SampleKind::image) {
    report.grains = layout.grains;
    report.geometric_void_fraction = layout.void_fraction;
    if (layout.gap > 0.0) report.least_gap = layout.gap;
  }
  require_apart(scene, lattice);
  const std::vector<std::int32_t> owners =
      find_owners(scene, layout, lattice, range, communicator, report);
  const std::int64_t block_layers =
      std::clamp(lattice.sample_layers - range.first, std::int64_t{0}, range.last - range.first);
  report.lattice_sites = block_layers * lattice.layer_size();
  report.block_particles = std::count_if(owners.begin(), owners.begin() + report.lattice_sites,
                                         [](std::int32_t owner) { return owner != owner_none; });
  make_particles(scene, lattice, range, owners, report.grains, particles);
  report.particles = static_cast<std::int64_t>(particles.size());
  set_particle_void_fraction(report);
}

template <int Dim>
void fill_layers(const Scene& scene, const SampleReport& placed, LatticeRange range,
                 Particles<Dim>& particles) {
  const Lattice lattice = make_lattice(scene);
  GrainLayout layout;
  layout.grains = placed.grains;
  SampleReport report;
  report.voids = placed.voids;
  const std::vector<std::int32_t> owners =
      find_owners(scene, layout, lattice, range, MPI_COMM_SELF, report);
  make_particles(scene, lattice, range, owners, layout.grains, particles);
}

SampleReport total(const SampleReport& report, MPI_Comm communicator) {
  SampleReport result = report;
  std::vector<std::int64_t> counts = {report.lattice_sites, report.particles,
                                      report.block_particles, report.islands,
                                      report.island_particles};
  for (const auto* regions : {&report.bodies, &report.hollows}) {
    for (const RegionSites& r : *regions) {
      counts.insert(counts.end(), {r.inside, r.taken, r.left});
    }
  }
  sum(counts, communicator);
  result.lattice_sites = counts[0];
  result.particles = counts[1];
  result.block_particles = counts[2];
  result.islands = counts[3];
  result.island_particles = counts[4];
  std::size_t at = 5;
  for (auto* regions : {&result.bodies, &result.hollows}) {
    for (RegionSites& r : *regions) {
      r = {counts[at], counts[at + 1], counts[at + 2]};
      at += 3;
    }
  }
  set_particle_void_fraction(result);
  if (result.particles == 0) {
    throw InputError(
        "The scene makes no particle at all: the sample and the bodies contain no lattice site. "
        "Allowed is one or more. Set sample.kind and sample.height, add a [[body]] at least "
        "domain.cell / sample.particles_per_cell wide, or remove the [[void]] that takes all.");
  }
  return result;
}

template void fill_layers<2>(const Scene&, const SampleReport&, LatticeRange, Particles<2>&);
template void fill_layers<3>(const Scene&, const SampleReport&, LatticeRange, Particles<3>&);
template void fill<2>(const Scene&, LatticeRange, MPI_Comm, Particles<2>&, SampleReport&);
template void fill<3>(const Scene&, LatticeRange, MPI_Comm, Particles<3>&, SampleReport&);

}  // namespace poreshock
