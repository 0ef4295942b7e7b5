#pragma once
// Helpers of the output tests: a folder of their own, made-up particles, damaged files.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/particles/particles.hpp"

namespace poreshock::test {

/// A fresh folder in the working directory, the same on all ranks, removed at the end. Collective.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    if (rank(MPI_COMM_WORLD) == 0) {
      char name[] = "output_test_XXXXXX";
      path_ = std::filesystem::absolute(mkdtemp(name)).string();
    }
    broadcast(path_, MPI_COMM_WORLD);
  }
  ~TemporaryFolder() {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank(MPI_COMM_WORLD) == 0) std::filesystem::remove_all(path_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Text of the exception of type Error that `action` throws; a failure of the test when it does
/// not.
template <class Error, class Action>
std::string thrown(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another exception: " << error.what();
    return {};
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Runs on rank 0 while the others wait.
template <class Action>
void rank_zero_alone(Action&& action) {
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank(MPI_COMM_WORLD) == 0) action();
  MPI_Barrier(MPI_COMM_WORLD);
}

inline void flip_byte(const std::string& path, std::uint64_t at) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(static_cast<std::streamoff>(at));
  const char byte = static_cast<char>(file.get() ^ 0x10);
  file.seekp(static_cast<std::streamoff>(at));
  file.put(byte);
}

inline std::string file_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Particles first ... first + count - 1 of a made-up body: every number differs, and among them
/// are those that text formats lose (-0, the least positive number, 1/3).
template <int Dim>
Particles<Dim> made_up_particles(std::int64_t first, std::int64_t count, ParticleOptions options) {
  Particles<Dim> particles;
  particles.options = options;
  resize(particles, static_cast<std::size_t>(count));
  int number = 0;
  for_each_column(particles, [&](std::string_view name, int, auto& column) {
    ++number;
    for (std::size_t i = 0; i < column.size(); ++i) {
      using T = std::remove_reference_t<decltype(column[i])>;
      const std::int64_t row = first + static_cast<std::int64_t>(i);
      const double value = std::sin(static_cast<double>(row)) * std::pow(10.0, number - 8) / 3.0;
      if constexpr (std::is_same_v<T, double>) {
        column[i] = row % 7 == 3   ? -0.0
                    : row % 7 == 5 ? std::numeric_limits<double>::denorm_min()
                                   : value;
      } else {
        column[i] = static_cast<T>(name == "id" ? 7919 * row + (std::int64_t{1} << 40)
                                                : (name == "grain" ? row - 5 : row % 2));
      }
    }
  });
  return particles;
}

/// True when every column has the same bytes.
template <int Dim>
bool same_bits(const Particles<Dim>& a, const Particles<Dim>& b) {
  std::vector<std::string> columns;
  const auto bytes = [&](std::string_view, int, const auto& column) {
    columns.emplace_back(reinterpret_cast<const char*>(column.data()),
                         column.size() * sizeof(column[0]));
  };
  for_each_column(a, bytes);
  const auto first = columns;
  columns.clear();
  for_each_column(b, bytes);
  return first == columns;
}

}  // namespace poreshock::test
