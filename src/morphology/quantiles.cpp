#include "poreshock/morphology/quantiles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "slab.hpp"

namespace poreshock {
namespace {

constexpr std::uint64_t sign_bit = std::uint64_t{1} << 63;

/// Numbers in the order of the values, so that a search over them is exact.
std::uint64_t key_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return (bits & sign_bit) != 0 ? ~bits : bits | sign_bit;
}

double value_of(std::uint64_t key) {
  return std::bit_cast<double>((key & sign_bit) != 0 ? key ^ sign_bit : ~key);
}

/// Keys of the owned material pixels, sorted.
template <int Dim>
std::vector<std::uint64_t> sorted_keys(const PixelField<Dim>& map, std::size_t field) {
  const Slab slab = slab_of(map);
  const std::size_t owned = slab.layer_size() * static_cast<std::size_t>(slab.layers);
  const std::vector<double>& values = map.values.at(field);
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < owned; ++i) {
    if (map.solid[i] != 0 && !std::isnan(values[i])) keys.push_back(key_of(values[i]));
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

}  // namespace

template <int Dim>
std::vector<double> quantiles(const PixelField<Dim>& map, std::size_t field,
                              std::span<const double> shares, MPI_Comm communicator) {
  const std::vector<std::uint64_t> keys = sorted_keys(map, field);
  const std::int64_t total = sum(static_cast<std::int64_t>(keys.size()), communicator);
  if (total == 0) throw InputError("quantiles: the map has no pixel with a value");
  std::vector<std::int64_t> wanted;
  for (const double share : shares) {
    if (!(share >= 0.0 && share <= 1.0)) {
      throw InputError("quantiles: found a share of " + std::to_string(share) +
                       ", allowed 0 ... 1");
    }
    const auto number = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(total)));
    wanted.push_back(std::clamp<std::int64_t>(number, 1, total));
  }
  // The least key with at least the wanted number of keys up to it, bit by bit.
  std::vector<std::uint64_t> found(shares.size(), 0);
  for (int bit = 63; bit >= 0; --bit) {
    const std::uint64_t rest = (std::uint64_t{1} << bit) - 1;
    std::vector<std::int64_t> up_to;
    for (const std::uint64_t key : found) {
      up_to.push_back(std::upper_bound(keys.begin(), keys.end(), key | rest) - keys.begin());
    }
    sum(up_to, communicator);
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (up_to[k] < wanted[k]) found[k] |= std::uint64_t{1} << bit;
    }
  }
  std::vector<double> result;
  for (const std::uint64_t key : found) result.push_back(value_of(key));
  return result;
}

template std::vector<double> quantiles<2>(const PixelField<2>&, std::size_t,
                                          std::span<const double>, MPI_Comm);
template std::vector<double> quantiles<3>(const PixelField<3>&, std::size_t,
                                          std::span<const double>, MPI_Comm);

}  // namespace poreshock
