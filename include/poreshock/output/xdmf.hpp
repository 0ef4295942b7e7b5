#pragma once
// snapshots.xdmf and maps.xdmf: the snapshots of a folder as time series that ParaView opens.

#include <mpi.h>

#include <string>

namespace poreshock {

/// Rewrites snapshots.xdmf of an output folder from the snapshots found in it: points with every
/// particle dataset as an attribute, at the times of the files; where they hold maps also
/// maps.xdmf: a rectangular mesh with the maps as values of its cells. Unreadable snapshots are
/// left out. Rank 0 works; SystemError on all ranks when it cannot write. Collective.
void write_xdmf(const std::string& folder, MPI_Comm communicator);

}  // namespace poreshock
