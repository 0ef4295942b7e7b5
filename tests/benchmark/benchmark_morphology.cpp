// Speed of the morphology kernels on one core, in pixels per second. The maps are 2048 x 2048 with
// 5 % of voids, x periodic: noise, the worst case; a smooth field of eight pixels per wave; a hot
// band with a rough front, as a shock leaves it.

#include <benchmark/benchmark.h>
#include <petscsys.h>

#include <cmath>
#include <numbers>

#include "poreshock/morphology/analysis.hpp"
#include "poreshock/morphology/domains.hpp"
#include "support/random_numbers.hpp"

namespace poreshock {
namespace {

enum Texture : std::int64_t { noise, smooth, shock };

double value_at(std::int64_t texture, int x, int y, double random) {
  if (texture == noise) return random;
  const double wave =
      0.5 + 0.25 * (std::sin(0.8 * x) * std::sin(0.8 * y) + std::sin(0.33 * x + 0.21 * y));
  if (texture == smooth) return wave;
  const double front = 1200.0 + 30.0 * std::sin(2.0 * std::numbers::pi * x / 512.0);
  return y < front ? 0.3 + 0.5 * wave : 0.1;
}

PixelField<2> make_map(std::int64_t texture, int side) {
  PixelField<2> map;
  map.layout = {{side, side}, 1.0, {true}};
  map.rows = side;
  map.first = map.last = true;
  reference::Random random{1};
  std::vector<double>& values = map.values.emplace_back();
  for (int y = 0; y <= side; ++y) {
    for (int x = 0; x < side; ++x) {
      // Voids are discs of eight pixels, or single pixels of the noise.
      const double from = std::hypot(x % 64 - 32, y % 64 - 32);
      const bool solid = texture == noise ? random.uniform() >= 0.05 : from >= 8.0;
      values.push_back(solid ? value_at(texture, x, y, random.uniform()) : std::nan(""));
      map.solid.push_back(solid ? 1 : 0);
    }
  }
  return map;
}

std::vector<double> levels(std::int64_t count) {
  std::vector<double> result;
  for (int k = 1; k <= count; ++k) result.push_back(k / (static_cast<double>(count) + 1.0));
  return result;
}

void report(const PixelField<2>& map, benchmark::State& state) {
  const double pixels = static_cast<double>(map.rows) * map.layout.pixels[0];
  state.counters["Mpixel/s"] = benchmark::Counter(
      1e-6 * pixels * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void count_pixels(benchmark::State& state) {
  const PixelField<2> map = make_map(state.range(0), 2048);
  const std::vector<double> thresholds = levels(state.range(1));
  for (auto _ : state) {
    PixelCounts counts = poreshock::count_pixels(block(map, 0), thresholds);
    benchmark::DoNotOptimize(counts.F.data());
  }
  report(map, state);
}

void count_domains(benchmark::State& state) {
  const PixelField<2> map = make_map(state.range(0), 1024);
  const std::vector<double> thresholds = levels(state.range(1));
  for (auto _ : state) {
    DomainCounts counts =
        poreshock::count_domains<2>(map, 0, thresholds, Joining::corners, MPI_COMM_SELF);
    benchmark::DoNotOptimize(counts.n_W.data());
  }
  report(map, state);
}

void find_hot_spots(benchmark::State& state) {
  const PixelField<2> map = make_map(state.range(0), 2048);
  for (auto _ : state) {
    auto spots = poreshock::find_hot_spots<2>(map, 0, 0.5, Joining::corners, MPI_COMM_SELF);
    benchmark::DoNotOptimize(spots.data());
  }
  report(map, state);
}

/// Two by two particles a pixel, a tenth of a pixel off their lattice.
void deposit(benchmark::State& state) {
  const int side = 512;
  const PixelGrid<2> grid(MPI_COMM_SELF, {{side, side}, 1.0, {true}});
  std::vector<double> x, y, mass, density, value;
  reference::Random random{1};
  for (int j = 0; j < 2 * side; ++j) {
    for (int i = 0; i < 2 * side; ++i) {
      x.push_back(0.25 + 0.5 * i + 0.2 * (random.uniform() - 0.5));
      y.push_back(0.25 + 0.5 * j + 0.2 * (random.uniform() - 0.5));
      mass.push_back(0.25);
      density.push_back(1.0 + 0.2 * random.uniform());
      value.push_back(random.uniform());
    }
  }
  const PixelSources<2> particles{{x, y}, mass, density};
  for (auto _ : state) {
    auto map = poreshock::deposit<2>(particles, {value}, {1.0, 2.0}, grid);
    benchmark::DoNotOptimize(map.values.data());
  }
  state.counters["Mparticle/s"] = benchmark::Counter(
      1e-6 * static_cast<double>(x.size()) * static_cast<double>(state.iterations()),
      benchmark::Counter::kIsRate);
}

BENCHMARK(deposit)->Unit(benchmark::kMillisecond);
BENCHMARK(count_pixels)
    ->ArgNames({"texture", "thresholds"})
    ->ArgsProduct({{noise, smooth, shock}, {1, 16, 70, 256, 700}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(count_domains)
    ->ArgNames({"texture", "thresholds"})
    ->ArgsProduct({{noise, smooth, shock}, {16, 256}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(find_hot_spots)
    ->ArgNames({"texture"})
    ->ArgsProduct({{noise, smooth, shock}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace poreshock

int main(int argc, char** argv) {
  // The layers below use MPI and PETSc even on one rank.
  PetscInitialize(nullptr, nullptr, nullptr, nullptr);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  PetscFinalize();
  return 0;
}
