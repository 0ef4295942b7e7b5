# Release with PETSc of 64-bit indices (libpetsc64-real-dev), for grids of more than 2^28 nodes:
# cmake -C tools/cmake/petsc64.cmake -B build/petsc64
include(${CMAKE_CURRENT_LIST_DIR}/release.cmake)
set(PORESHOCK_PETSC "PETSc64" CACHE STRING "")
