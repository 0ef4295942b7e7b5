#include "poreshock/app/build_information.hpp"

#include <mpi.h>
#include <petscsys.h>

#include <Eigen/Core>
#include <string_view>

#include "poreshock/core/parallel.hpp"

namespace poreshock {

namespace {

/// The first sentence of what MPI says of itself.
std::string mpi_version() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string_view all(text, static_cast<std::size_t>(length));
  return std::string(all.substr(0, all.find_first_of(",\n")));
}

std::string eigen_version() {
  return std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
         std::to_string(EIGEN_MINOR_VERSION);
}

std::string petsc_version() {
  return std::to_string(PETSC_VERSION_MAJOR) + "." + std::to_string(PETSC_VERSION_MINOR) + "." +
         std::to_string(PETSC_VERSION_SUBMINOR) + " with " + std::to_string(8 * sizeof(PetscInt)) +
         "-bit indices";
}

}  // namespace

std::string build_information() {
  return "poreshock " + version() + " (" + revision() +
         ")\ncompiler   " PORESHOCK_COMPILER "\nflags      " PORESHOCK_FLAGS "\nlibraries  " +
         mpi_version() + ", PETSc " + petsc_version() +
         ", HDF5 " PORESHOCK_HDF5 ", METIS " PORESHOCK_METIS ", Eigen " + eigen_version() +
         ", toml++ " PORESHOCK_TOML ", CLI11 " PORESHOCK_CLI11 ", libpng " PORESHOCK_PNG
         ", libtiff " PORESHOCK_TIFF;
}

}  // namespace poreshock
