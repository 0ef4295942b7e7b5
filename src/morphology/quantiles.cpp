#include "poreshock/morphology/quantiles.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
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

/// Values of the owned material pixels, NaN left out.
template <int Dim>
std::vector<double> own_values(const PixelField<Dim>& map, std::size_t field) {
  const Slab slab = slab_of(map);
  const std::size_t owned = slab.layer_size() * static_cast<std::size_t>(slab.layers);
  const std::vector<double>& all = map.values.at(field);
  std::vector<double> values;
  for (std::size_t i = 0; i < owned; ++i) {
    if (map.solid[i] != 0 && !std::isnan(all[i])) values.push_back(all[i]);
  }
  return values;
}

/// Bins of equal width over the finite values of all ranks, so that few values need to be sorted. A
/// larger value never lies in a lower bin.
struct Bins {
  static constexpr std::size_t count = 4096;
  double low = 0.0;
  double scale = 0.0;  ///< bins per unit; zero when all values are equal or too far apart

  std::size_t bin(double value) const {
    const double place = (value - low) * scale;
    // An infinite value in a single bin has no place.
    const double from_zero = place > 0.0 ? place : 0.0;
    return static_cast<std::size_t>(std::min(from_zero, static_cast<double>(count - 1)));
  }
};

/// Collective.
Bins make_bins(std::span<const double> values, MPI_Comm communicator) {
  // The lowest value as the largest of the negatives, so that one reduction gives both.
  std::array<double, 2> ends = {-std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    ends[0] = std::max(ends[0], -value);
    ends[1] = std::max(ends[1], value);
  }
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, ends.data(), 2, MPI_DOUBLE, MPI_MAX, communicator),
            "MPI_Allreduce");
  const double scale = static_cast<double>(Bins::count) / (ends[0] + ends[1]);
  const bool usable = std::isfinite(scale) && scale > 0.0 && std::isfinite(ends[0]);
  return {usable ? -ends[0] : 0.0, usable ? scale : 0.0};
}

/// Numbers of values on all ranks in each bin. Collective.
std::vector<std::int64_t> fill_bins(const Bins& bins, std::span<const double> values,
                                    MPI_Comm communicator) {
  std::vector<std::int64_t> counts(Bins::count, 0);
  for (const double value : values) ++counts[bins.bin(value)];
  sum(counts, communicator);
  return counts;
}

/// Marks the bins that hold a wanted value, and turns the number of each among all values into its
/// number among those in marked bins.
std::vector<std::uint8_t> mark_bins(std::span<const std::int64_t> counts,
                                    std::vector<std::int64_t>& wanted) {
  std::vector<std::uint8_t> marked(counts.size(), 0);
  std::vector<std::size_t> bin_of(wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    std::int64_t up_to = counts[0];
    while (up_to < wanted[k]) up_to += counts[++bin_of[k]];
    marked[bin_of[k]] = 1;
  }
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    for (std::size_t b = 0; b < bin_of[k]; ++b) wanted[k] -= marked[b] != 0 ? 0 : counts[b];
  }
  return marked;
}

/// Keys of the values in marked bins, sorted.
std::vector<std::uint64_t> sorted_keys(const Bins& bins, std::span<const std::uint8_t> marked,
                                       std::span<const double> values) {
  std::vector<std::uint64_t> keys;
  for (const double value : values) {
    if (marked[bins.bin(value)] != 0) keys.push_back(key_of(value));
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

}  // namespace

template <int Dim>
std::vector<double> quantiles(const PixelField<Dim>& map, std::size_t field,
                              std::span<const double> shares, MPI_Comm communicator) {
  const std::vector<double> values = own_values(map, field);
  const std::int64_t total = sum(static_cast<std::int64_t>(values.size()), communicator);
  std::vector<std::int64_t> wanted;
  for (const double share : shares) {
    if (!(share >= 0.0 && share <= 1.0)) {
      throw InputError("quantiles: found a share of " + std::to_string(share) +
                       ", allowed 0 ... 1");
    }
    const auto number = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(total)));
    wanted.push_back(std::clamp<std::int64_t>(number, 1, std::max<std::int64_t>(total, 1)));
  }
  if (total == 0) return std::vector<double>(shares.size(), std::nan(""));
  const Bins bins = make_bins(values, communicator);
  const auto marked = mark_bins(fill_bins(bins, values, communicator), wanted);
  const std::vector<std::uint64_t> keys = sorted_keys(bins, marked, values);
  // The least key with at least the wanted number of keys up to it, bit by bit.
  std::vector<std::uint64_t> found(shares.size(), 0);
  for (int bit = 63; bit >= 0; --bit) {
    const std::uint64_t rest = (std::uint64_t{1} << bit) - 1;
    std::vector<std::int64_t> up_to;
    up_to.reserve(found.size());
    for (const std::uint64_t key : found) {
      up_to.push_back(std::upper_bound(keys.begin(), keys.end(), key | rest) - keys.begin());
    }
    sum(up_to, communicator);
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (up_to[k] < wanted[k]) found[k] |= std::uint64_t{1} << bit;
    }
  }
  std::vector<double> result;
  result.reserve(found.size());
  for (const std::uint64_t key : found) result.push_back(value_of(key));
  return result;
}

template std::vector<double> quantiles<2>(const PixelField<2>&, std::size_t,
                                          std::span<const double>, MPI_Comm);
template std::vector<double> quantiles<3>(const PixelField<3>&, std::size_t,
                                          std::span<const double>, MPI_Comm);

}  // namespace poreshock
