#pragma once
// Files of measured morphology: one small file per record while the run goes on, one file at its
// end.

#include <mpi.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "poreshock/output/record_stamp.hpp"

namespace poreshock {

/// Measurements of one field at one time; all curves have one entry per threshold.
struct MorphologyRecord {
  std::string field;
  std::string unit;
  std::vector<double> threshold;  ///< in `unit`
  std::int64_t pixels = 0;        ///< material pixels
  std::vector<std::pair<std::string, std::vector<std::int64_t>>> counts;
  std::vector<std::pair<std::string, std::vector<double>>> functionals;  ///< in pixel units
};

/// File name of a record in its folder: morphology_NNNNNN.h5.
std::string morphology_name(std::int64_t record);

/// Writes /<field>/{time, step, record, threshold, pixels, counts..., functionals...}, curves as
/// 1 x thresholds, replacing an older file. Rank 0's arguments count, and rank 0 works; SystemError
/// on all ranks when it fails. Collective.
void write_morphology(const std::string& path, const RecordStamp& stamp,
                      const std::vector<MorphologyRecord>& records, MPI_Comm communicator);

/// Takes the records from number `first` on out of morphology.h5, which a restarted run is about to
/// measure again. Without such a file or such records nothing changes; InputError on all ranks when
/// the file is damaged. Rank 0 works. Collective.
void remove_morphology_from(const std::string& folder, std::int64_t first, MPI_Comm communicator);

/// Merges all morphology_NNNNNN.h5 of a folder, and what an earlier morphology.h5 holds of other
/// records, into morphology.h5 (curves as times x thresholds, in the order of the records) and
/// removes the small files once it is safely there. Without small files nothing changes. InputError
/// on all ranks when a file is damaged or its thresholds or curves differ from the others'; the
/// small files are kept then. Rank 0 works. Returns the number of records merged. Collective.
std::int64_t collect_morphology(const std::string& folder, MPI_Comm communicator);

}  // namespace poreshock
