#include "poreshock/particles/particles.hpp"

#include <algorithm>
#include <cstring>
#include <tuple>

namespace poreshock {

template <int Dim>
void resize(Particles<Dim>& particles, std::size_t count) {
  for_each_column(particles, [&](std::string_view, int, auto& column) {
    // A vector alone would double its room when a few particles come over from the next slab.
    if (count > column.capacity()) column.reserve(count + count / 32);
    column.resize(count);
  });
}

template <int Dim>
void release_spare(Particles<Dim>& particles) {
  for_each_column(particles, [](std::string_view, int, auto& column) { column.shrink_to_fit(); });
}

template <int Dim>
void reorder(const std::vector<std::uint32_t>& order, Particles<Dim>& particles,
             std::size_t first) {
  // One column more per type, which they hand on: a new one each would be new pages each.
  std::tuple<std::vector<std::int64_t>, std::vector<std::int32_t>, std::vector<double>> spare;
  for_each_column(particles, [&](std::string_view, int, auto& column) {
    auto& sorted = std::get<std::remove_reference_t<decltype(column)>>(spare);
    if (sorted.size() != order.size()) {
      if (first == 0) sorted.reserve(column.capacity());
      sorted.resize(order.size());
    }
    for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = column[order[k]];
    if (first == 0) return column.swap(sorted);
    column.resize(first + order.size());
    std::copy(sorted.begin(), sorted.end(), column.begin() + static_cast<std::ptrdiff_t>(first));
  });
}

template <int Dim>
std::size_t bytes_per_particle(const Particles<Dim>& particles) {
  std::size_t bytes = 0;
  for_each_column(particles,
                  [&](std::string_view, int, const auto& column) { bytes += sizeof(column[0]); });
  return bytes;
}

template <int Dim>
void pack(const Particles<Dim>& source, const std::vector<std::uint32_t>& indices,
          std::vector<std::byte>& buffer) {
  std::size_t at = buffer.size();
  buffer.resize(at + indices.size() * bytes_per_particle(source));
  for_each_column(source, [&](std::string_view, int, const auto& column) {
    for (const std::uint32_t i : indices) {
      std::memcpy(buffer.data() + at, &column[i], sizeof(column[i]));
      at += sizeof(column[i]);
    }
  });
}

template <int Dim>
void unpack(const std::byte* buffer, std::size_t count, Particles<Dim>& particles) {
  if (count == 0) return;  // an empty buffer may be a null pointer
  const std::size_t before = particles.size();
  resize(particles, before + count);
  for_each_column(particles, [&](std::string_view, int, auto& column) {
    std::memcpy(column.data() + before, buffer, count * sizeof(column[0]));
    buffer += count * sizeof(column[0]);
  });
}

template <int Dim>
void append(const Particles<Dim>& source, const std::vector<std::uint32_t>& indices,
            Particles<Dim>& target) {
  std::vector<std::byte> buffer;
  pack(source, indices, buffer);
  unpack(buffer.data(), indices.size(), target);
}

template <int Dim>
std::array<double, Dim> mode_squares(const Particles<Dim>& particles, double inertia,
                                     std::size_t p) {
  std::array<double, Dim> squares{};
  if (particles.options.affine) {
    for (std::size_t k = 0; k < particles.affine.size(); ++k) {
      squares[k / Dim] += inertia * (particles.affine[k][p] * particles.affine[k][p]);
    }
  }
  if (particles.options.quadratic) {
    for (std::size_t k = 0; k < particles.quadratic.size(); ++k) {
      squares[k / second_modes<Dim>] += particles.quadratic[k][p] * particles.quadratic[k][p];
    }
  }
  return squares;
}

template <int Dim>
double kinetic_energy(const Particles<Dim>& particles, double inertia, std::size_t p) {
  const std::array<double, Dim> modes = mode_squares(particles, inertia, p);
  double square = 0.0;
  for (int a = 0; a < Dim; ++a) {
    square += particles.velocity[a][p] * particles.velocity[a][p] + modes[a];
  }
  return 0.5 * square;
}

template void resize<2>(Particles<2>&, std::size_t);
template void resize<3>(Particles<3>&, std::size_t);
template void reorder<2>(const std::vector<std::uint32_t>&, Particles<2>&, std::size_t);
template void reorder<3>(const std::vector<std::uint32_t>&, Particles<3>&, std::size_t);
template void release_spare<2>(Particles<2>&);
template void release_spare<3>(Particles<3>&);
template std::size_t bytes_per_particle<2>(const Particles<2>&);
template std::size_t bytes_per_particle<3>(const Particles<3>&);
template void pack<2>(const Particles<2>&, const std::vector<std::uint32_t>&,
                      std::vector<std::byte>&);
template void pack<3>(const Particles<3>&, const std::vector<std::uint32_t>&,
                      std::vector<std::byte>&);
template void unpack<2>(const std::byte*, std::size_t, Particles<2>&);
template void append<2>(const Particles<2>&, const std::vector<std::uint32_t>&, Particles<2>&);
template void unpack<3>(const std::byte*, std::size_t, Particles<3>&);
template void append<3>(const Particles<3>&, const std::vector<std::uint32_t>&, Particles<3>&);

template std::array<double, 2> mode_squares<2>(const Particles<2>&, double, std::size_t);
template std::array<double, 3> mode_squares<3>(const Particles<3>&, double, std::size_t);
template double kinetic_energy<2>(const Particles<2>&, double, std::size_t);
template double kinetic_energy<3>(const Particles<3>&, double, std::size_t);

}  // namespace poreshock
