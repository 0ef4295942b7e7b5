// Mean temperature and pressure of a snapshot, weighted with mass. Usage: read_snapshot FILE

#include <cstdio>

#include "poreshock/core/parallel.hpp"
#include "poreshock/files/hdf5_file.hpp"

int main(int argc, char** argv) {
  const poreshock::Runtime runtime(argc, argv);
  if (argc < 2) return 2;
  auto file = poreshock::Hdf5File::open(argv[1], runtime.communicator());
  const auto mass = file.read_all<double>("/particles/mass");
  const auto temperature = file.read_all<double>("/particles/temperature");
  double sum = 0.0, weighted = 0.0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    sum += mass[i];
    weighted += mass[i] * temperature[i];
  }
  std::printf("%zu particles at %.4g s, mean temperature %.10g K\n", mass.size(),
              file.number("time"), weighted / sum);
}
