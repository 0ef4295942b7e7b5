#pragma once
// Pieces of a lattice sample that hang together through shared faces (4 neighbours in 2-D, 6 in
// 3-D, periodic sides included), kept as runs of sites along x: memory grows with the number of
// runs.

#include <cstdint>
#include <vector>

#include "lattice.hpp"

namespace poreshock {

/// Sites [begin, end) of one lattice row, all filled.
struct Run {
  std::int32_t begin = 0;
  std::int32_t end = 0;
  std::int32_t piece = -1;  ///< set by find_pieces; pieces are numbered by their first site
};

/// Runs of consecutive lattice rows.
struct Runs {
  std::vector<Run> runs;
  std::vector<std::size_t> row_start{0};  ///< runs of row r: row_start[r] ... row_start[r + 1] - 1
};

/// Appends the runs of filled sites of whole rows of `row_length` sites.
void append_runs(const std::vector<std::int32_t>& owners, std::int64_t row_length, Runs& runs);

/// Numbers the connected pieces of the runs of all sample layers and returns the sites of each.
std::vector<std::int64_t> find_pieces(const Lattice& lattice, const std::array<bool, 2>& periodic,
                                      Runs& runs);

/// All runs of the sample that float: they belong to a piece that is not the largest one (the first
/// of the largest on a tie).
struct IslandPieces {
  Runs runs;                             ///< of all sample layers
  std::vector<std::int64_t> piece_size;  ///< sites
  std::int32_t largest = -1;             ///< the piece that stays
};

/// The floating pieces as grains, in the order of their numbers.
std::vector<Grain> grains_of_islands(const Scene& scene, const Lattice& lattice,
                                     const IslandPieces& islands);

/// Islands of the sample with its generated voids and the scene's explicit voids taken out. Each
/// rank looks at its share of the lattice, all keep the runs of all. Collective.
IslandPieces find_islands(const Scene& scene, const std::vector<Void>& voids,
                          MPI_Comm communicator);

}  // namespace poreshock
