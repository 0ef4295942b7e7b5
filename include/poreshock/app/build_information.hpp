#pragma once
// What this program was built from.

#include <string>

namespace poreshock {

/// Version and revision, then compiler and flags, then the libraries with their versions, one line
/// each. Needs no MPI.
std::string build_information();

}  // namespace poreshock
