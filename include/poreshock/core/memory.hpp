#pragma once
// Memory of this process: what it holds, and giving back what is freed.

#include <cstdint>

namespace poreshock {

/// Largest memory this process has held so far, bytes. Not collective.
std::int64_t peak_memory();

/// Memory this process holds for itself now, bytes, without the code of libraries, which all
/// processes of a machine share; 0 where the system does not say. Not collective.
std::int64_t own_memory();

/// Gives freed memory back to the system, also what smaller blocks have left in the heap, where the
/// library can. Not collective.
void release_freed_memory();

/// From now on blocks above 640 KiB go back to the system once they are freed, where the library
/// can. SuperLU_DIST, which PETSc brings along, turns that off when it is loaded: then all come
/// from one heap, which only grows, and what lies free between the blocks is lost. Not collective.
void return_large_blocks();

}  // namespace poreshock
