#pragma once
// The last that is seen of material that a domain leaves behind when it moves with the front.

#include "poreshock/run/records.hpp"

namespace poreshock {

/// File name of the particles of a strip in its folder: handed_over_NNNNNN.h5.
std::string strip_name(std::int64_t strip);

/// Hands the lowest strip over, after its particles have been written as a snapshot and its
/// morphology has been measured. Throws StateError where the front is not yet far above it.
/// Collective.
template <int Dim>
void leave_strip(Simulation<Dim>& sim, Recorder<Dim>& recorder);

}  // namespace poreshock
