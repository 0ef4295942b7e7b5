#pragma once
// The seal of our HDF5 files: a 4096-byte block before the HDF5 content that holds a magic word,
// the version of the format, the length of the file, a hash of all the rest, and a hash of itself.
// The rest is hashed in blocks of 1 MiB spread over the ranks; the hashes of the blocks are hashed
// in order, so the seal does not depend on the number of ranks.

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace poreshock {

inline constexpr std::uint64_t seal_bytes = 4096;
inline constexpr std::uint32_t seal_version = 1;

/// 64-bit hash of a piece of memory (XXH64 with seed 0).
std::uint64_t block_hash(const std::byte* data, std::size_t count);

/// Hashes a closed file and writes its seal; with `sync` every rank first forces it to disk.
/// SystemError on all ranks when it cannot be read or written. Collective.
void write_seal(const std::string& path, bool sync, MPI_Comm communicator);

/// Reads a whole file again and compares it with its seal; InputError on all ranks that names what
/// is wrong: foreign, of a newer version, truncated, or damaged. Collective.
void verify(const std::string& path, MPI_Comm communicator);

/// True when the file begins like one of ours, whatever its state. Not collective.
bool has_seal(const std::string& path);

}  // namespace poreshock
