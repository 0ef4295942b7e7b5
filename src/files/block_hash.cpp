#include "poreshock/files/block_hash.hpp"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <vector>

#include "poreshock/core/rank_zero.hpp"
#include "poreshock/files/posix_file.hpp"

namespace poreshock {

namespace {

static_assert(std::endian::native == std::endian::little, "seals are written little-endian");

constexpr std::size_t block_bytes = std::size_t{1} << 20;
constexpr std::array<char, 8> magic = {'p', 'o', 'r', 'e', 's', 'h', 'k', '\n'};

/// The part of the seal that holds something; the rest of its 4096 bytes is zero.
struct Seal {
  std::array<char, 8> word = magic;
  std::uint32_t version = seal_version;
  std::uint32_t block = block_bytes;
  std::uint64_t length = 0;   ///< bytes of the whole file
  std::uint64_t content = 0;  ///< hash of everything after the seal
};
static_assert(sizeof(Seal) == 32);

using SealBytes = std::array<std::byte, seal_bytes>;
constexpr std::size_t own_hash_at = seal_bytes - sizeof(std::uint64_t);

constexpr std::uint64_t prime1 = 0x9E3779B185EBCA87u;
constexpr std::uint64_t prime2 = 0xC2B2AE3D27D4EB4Fu;
constexpr std::uint64_t prime3 = 0x165667B19E3779F9u;
constexpr std::uint64_t prime4 = 0x85EBCA77C2B2AE63u;
constexpr std::uint64_t prime5 = 0x27D4EB2F165667C5u;

template <class T>
T load(const std::byte* data) {
  T value;
  std::memcpy(&value, data, sizeof(T));
  return value;
}

std::uint64_t mix(std::uint64_t lane, std::uint64_t input) {
  return std::rotl(lane + input * prime2, 31) * prime1;
}

/// Hashes of all blocks of this rank's contiguous share of the blocks.
std::vector<std::uint64_t> hash_share(const FileDescriptor& file, std::uint64_t length, int rank,
                                      int ranks) {
  const std::uint64_t blocks = (length - seal_bytes + block_bytes - 1) / block_bytes;
  const auto first = blocks * static_cast<std::uint64_t>(rank) / static_cast<std::uint64_t>(ranks);
  const auto last =
      blocks * (static_cast<std::uint64_t>(rank) + 1) / static_cast<std::uint64_t>(ranks);
  std::vector<std::uint64_t> hashes;
  std::vector<std::byte> buffer(block_bytes);
  for (std::uint64_t b = first; b < last; ++b) {
    const std::uint64_t at = seal_bytes + b * block_bytes;
    const std::size_t count = std::min<std::uint64_t>(block_bytes, length - at);
    file.read(at, buffer.data(), count);
    hashes.push_back(block_hash(buffer.data(), count));
  }
  return hashes;
}

/// Hash of everything after the seal, the same on all ranks.
std::uint64_t hash_content(const std::string& path, std::uint64_t length, bool sync,
                           MPI_Comm communicator) {
  std::vector<std::uint64_t> mine;
  agree(attempt([&] {
          const FileDescriptor file(path, O_RDONLY);
          if (sync) file.sync();
          mine = hash_share(file, length, rank(communicator), size(communicator));
        }),
        communicator);
  const int count = static_cast<int>(mine.size());
  std::vector<int> counts(static_cast<std::size_t>(size(communicator)));
  check_mpi(MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, communicator),
            "MPI_Gather");
  std::vector<int> starts(counts.size(), 0);
  for (std::size_t r = 1; r < counts.size(); ++r) starts[r] = starts[r - 1] + counts[r - 1];
  std::vector<std::uint64_t> all(static_cast<std::size_t>(starts.back() + counts.back()));
  check_mpi(MPI_Gatherv(mine.data(), count, MPI_UINT64_T, all.data(), counts.data(), starts.data(),
                        MPI_UINT64_T, 0, communicator),
            "MPI_Gatherv");
  std::uint64_t hash = block_hash(reinterpret_cast<const std::byte*>(all.data()),
                                  all.size() * sizeof(std::uint64_t));
  check_mpi(MPI_Bcast(&hash, 1, MPI_UINT64_T, 0, communicator), "MPI_Bcast");
  return hash;
}

/// Reads and checks the seal itself and the length of the file.
Seal read_seal(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError(path + ": not found, or not a file");
  }
  const FileDescriptor file(path, O_RDONLY);
  const std::uint64_t length = file.size();
  if (length < seal_bytes) {
    throw InputError(path + ": not a file of poreshock, or truncated: it has " +
                     std::to_string(length) + " bytes, its header alone takes " +
                     std::to_string(seal_bytes));
  }
  SealBytes bytes{};
  file.read(0, bytes.data(), bytes.size());
  const Seal seal = load<Seal>(bytes.data());
  const auto matches = [](const SealBytes& b) {
    return load<std::uint64_t>(b.data() + own_hash_at) == block_hash(b.data(), own_hash_at);
  };
  if (seal.word != magic) {
    // With the right mark in place the header's own hash tells a damaged file from a foreign one.
    SealBytes repaired = bytes;
    std::memcpy(repaired.data(), magic.data(), magic.size());
    throw InputError(path + (matches(repaired) ? ": damaged" : ": not written by poreshock") +
                     ", its first 8 bytes are not the mark of poreshock files");
  }
  if (!matches(bytes))
    throw InputError(path + ": damaged: its header does not match the header's own hash");
  if (seal.version > seal_version) {
    throw InputError(path + ": written by a newer poreshock: format version " +
                     std::to_string(seal.version) + ", this program reads up to " +
                     std::to_string(seal_version));
  }
  if (seal.length != length) {
    throw InputError(path + ": truncated or extended: it has " + std::to_string(length) +
                     " bytes, its header says " + std::to_string(seal.length));
  }
  return seal;
}

}  // namespace

std::uint64_t block_hash(const std::byte* data, std::size_t count) {
  const std::byte* const end = data + count;
  std::uint64_t hash = prime5;
  if (count >= 32) {
    std::array<std::uint64_t, 4> lanes = {prime1 + prime2, prime2, 0, 0 - prime1};
    for (; end - data >= 32; data += 32) {
      for (std::size_t i = 0; i < 4; ++i) {
        lanes[i] = mix(lanes[i], load<std::uint64_t>(data + 8 * i));
      }
    }
    hash = std::rotl(lanes[0], 1) + std::rotl(lanes[1], 7) + std::rotl(lanes[2], 12) +
           std::rotl(lanes[3], 18);
    for (const std::uint64_t lane : lanes) hash = (hash ^ mix(0, lane)) * prime1 + prime4;
  }
  hash += count;
  for (; end - data >= 8; data += 8) {
    hash = std::rotl(hash ^ mix(0, load<std::uint64_t>(data)), 27) * prime1 + prime4;
  }
  if (end - data >= 4) {
    hash = std::rotl(hash ^ (load<std::uint32_t>(data) * prime1), 23) * prime2 + prime3;
    data += 4;
  }
  for (; data != end; ++data) {
    hash = std::rotl(hash ^ (std::to_integer<std::uint64_t>(*data) * prime5), 11) * prime1;
  }
  hash = (hash ^ (hash >> 33)) * prime2;
  hash = (hash ^ (hash >> 29)) * prime3;
  return hash ^ (hash >> 32);
}

void write_seal(const std::string& path, bool sync, MPI_Comm communicator) {
  Seal seal;
  on_rank_zero(communicator, [&] { seal.length = FileDescriptor(path, O_RDONLY).size(); });
  check_mpi(MPI_Bcast(&seal.length, 1, MPI_UINT64_T, 0, communicator), "MPI_Bcast");
  seal.content = hash_content(path, seal.length, sync, communicator);
  on_rank_zero(communicator, [&] {
    SealBytes bytes{};
    std::memcpy(bytes.data(), &seal, sizeof(seal));
    const std::uint64_t own = block_hash(bytes.data(), own_hash_at);
    std::memcpy(bytes.data() + own_hash_at, &own, sizeof(own));
    FileDescriptor(path, O_WRONLY).write(0, bytes.data(), bytes.size());
  });
}

void verify(const std::string& path, MPI_Comm communicator) {
  Seal seal;
  on_rank_zero(communicator, [&] { seal = read_seal(path); });
  std::array<std::uint64_t, 2> shared = {seal.length, seal.content};
  check_mpi(MPI_Bcast(shared.data(), 2, MPI_UINT64_T, 0, communicator), "MPI_Bcast");
  if (hash_content(path, shared[0], false, communicator) != shared[1]) {
    throw InputError(path + ": damaged: its content does not match the hash in its header");
  }
}

bool has_seal(const std::string& path) {
  const FileDescriptor file(path, O_RDONLY);
  std::array<std::byte, magic.size()> first{};
  if (file.size() < first.size()) return false;
  file.read(0, first.data(), first.size());
  return std::memcmp(first.data(), magic.data(), magic.size()) == 0;
}

}  // namespace poreshock
