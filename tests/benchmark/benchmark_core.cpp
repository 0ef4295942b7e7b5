// What one core of this machine can do at most: simple instructions per second, and bytes from and
// to memory. tools/benchmark compares the phases of a step to it.

#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

namespace poreshock {
namespace {

void set_rate(const char* name, double per_iteration, benchmark::State& state) {
  state.counters[name] = benchmark::Counter(per_iteration * static_cast<double>(state.iterations()),
                                            benchmark::Counter::kIsRate);
}

/// Independent additions of integers in registers, as many at a time as any core starts.
void instructions(benchmark::State& state) {
  constexpr int rounds = 256, chains = 8;
  std::uint64_t a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0;
  for (auto _ : state) {
#pragma GCC unroll 256
    for (int i = 0; i < rounds; ++i) {
      benchmark::DoNotOptimize(++a);
      benchmark::DoNotOptimize(++b);
      benchmark::DoNotOptimize(++c);
      benchmark::DoNotOptimize(++d);
      benchmark::DoNotOptimize(++e);
      benchmark::DoNotOptimize(++f);
      benchmark::DoNotOptimize(++g);
      benchmark::DoNotOptimize(++h);
    }
  }
  set_rate("instructions/s", rounds * chains, state);
}

/// a = b + s c over arrays far larger than any cache; what is written is read first.
void triad(benchmark::State& state) {
  constexpr std::size_t count = std::size_t{1} << 24;
  std::vector<double> a(count, 0.0), b(count, 1.0), c(count, 2.0);
  double s = 0.5;
  benchmark::DoNotOptimize(s);
  for (auto _ : state) {
    for (std::size_t i = 0; i < count; ++i) a[i] = b[i] + s * c[i];
    benchmark::ClobberMemory();
  }
  set_rate("bytes/s", 3.0 * sizeof(double) * count, state);
}

BENCHMARK(instructions);
BENCHMARK(triad)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace poreshock

BENCHMARK_MAIN();
