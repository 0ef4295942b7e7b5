#pragma once
// The seams between the slabs of the ranks: planes of nodes that neighbours send each other.

#include <petscdmda.h>

#include <vector>

#include "poreshock/core/lanes.hpp"

namespace poreshock {

/// Planes of `row_size` nodes, `planes` for each of the two neighbours, of several velocity fields.
/// A class because it owns PETSc objects.
class Seam {
 public:
  /// Collective.
  Seam(int row_size, int planes, MPI_Comm communicator);
  ~Seam();
  Seam(const Seam&) = delete;
  Seam& operator=(const Seam&) = delete;

  /// Makes room for so many fields. Collective.
  void make_fields(int fields);

  /// Planes of a field: 2 * planes of this rank, those for the rank below first. After exchange()
  /// the planes of the rank below end where these begin, and those of the rank above follow.
  Lanes* field(int number) { return first_[static_cast<std::size_t>(number)]; }

  /// Sends the planes of the first `fields` fields and receives those of the neighbours.
  /// Collective (neighbours).
  void exchange(int fields);

  /// Bytes held on this rank.
  std::size_t bytes() const;

 private:
  void take_array(std::size_t number);

  std::ptrdiff_t own_ = 0;  ///< nodes before the first plane of this rank
  DM dm_ = nullptr;
  std::vector<Vec> vectors_;
  std::vector<double*> arrays_;
  std::vector<Lanes*> first_;
};

}  // namespace poreshock
