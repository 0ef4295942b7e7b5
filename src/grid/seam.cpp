#include "poreshock/grid/seam.hpp"

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {

Seam::Seam(int row_size, int planes, MPI_Comm communicator)
    : own_(rank(communicator) > 0 ? static_cast<std::ptrdiff_t>(planes) * row_size : 0) {
  const int ranks = size(communicator);
  const PetscInt all[1] = {row_size};
  const std::vector<PetscInt> rows(static_cast<std::size_t>(ranks), 2 * planes);
  // Lateral axes stay whole on every rank, so one flattened lateral axis serves 2-D and 3-D.
  check_petsc(
      DMDACreate2d(communicator, DM_BOUNDARY_NONE, DM_BOUNDARY_NONE, DMDA_STENCIL_BOX, row_size,
                   2 * planes * ranks, 1, ranks, lane_count, planes, all, rows.data(), &dm_),
      "DMDACreate2d for the seam");
  check_petsc(DMSetUp(dm_), "DMSetUp for the seam");
  make_fields(1);
}

Seam::~Seam() {
  for (std::size_t f = 0; f < vectors_.size(); ++f) {
    VecRestoreArray(vectors_[f], &arrays_[f]);
    VecDestroy(&vectors_[f]);
  }
  DMDestroy(&dm_);
}

void Seam::take_array(std::size_t number) {
  check_petsc(VecGetArray(vectors_[number], &arrays_[number]), "VecGetArray");
  first_[number] = reinterpret_cast<Lanes*>(arrays_[number]) + own_;
}

void Seam::make_fields(int fields) {
  for (std::size_t f = vectors_.size(); f < static_cast<std::size_t>(fields); ++f) {
    vectors_.push_back(nullptr);
    arrays_.push_back(nullptr);
    first_.push_back(nullptr);
    check_petsc(DMCreateLocalVector(dm_, &vectors_[f]), "DMCreateLocalVector");
    take_array(f);
  }
}

void Seam::exchange(int fields) {
  for (std::size_t f = 0; f < static_cast<std::size_t>(fields); ++f) {
    check_petsc(VecRestoreArray(vectors_[f], &arrays_[f]), "VecRestoreArray");
    check_petsc(DMLocalToLocalBegin(dm_, vectors_[f], INSERT_VALUES, vectors_[f]),
                "DMLocalToLocalBegin");
    check_petsc(DMLocalToLocalEnd(dm_, vectors_[f], INSERT_VALUES, vectors_[f]),
                "DMLocalToLocalEnd");
    take_array(f);
  }
}

std::size_t Seam::bytes() const {
  std::size_t numbers = 0;
  for (const Vec& vector : vectors_) {
    PetscInt size = 0;
    VecGetLocalSize(vector, &size);
    numbers += static_cast<std::size_t>(size);
  }
  return sizeof(double) * numbers;
}

}  // namespace poreshock
