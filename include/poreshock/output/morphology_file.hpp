#pragma once
// Files of measured morphology: one small file per record while the run goes on, one file at its
// end.

#include <mpi.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "poreshock/output/record_stamp.hpp"

namespace poreshock {

/// One quantity of every hot spot, `width` values per spot.
struct SpotColumn {
  enum class Kind { numbers, integers };
  std::string name;
  std::string unit;
  Kind kind = Kind::numbers;
  std::uint64_t width = 1;
  std::vector<double> numbers{};
  std::vector<std::int64_t> integers{};
};

/// One number per threshold.
struct Curve {
  std::string name;
  std::vector<double> values;
  std::string unit = "1";
};

/// Measurements of one field at one time; all curves have one entry per threshold.
struct MorphologyRecord {
  std::string field;
  std::string unit;
  std::vector<double> threshold;  ///< in `unit`
  std::int64_t pixels = 0;        ///< material pixels
  std::vector<std::pair<std::string, std::vector<std::int64_t>>> counts;
  std::vector<Curve> functionals;        ///< per pixel, and in physical units
  std::size_t spots = 0;                 ///< hot spots listed
  std::vector<SpotColumn> spot_columns;  ///< `spots` rows each; none when none are asked for
  std::optional<double> low;  ///< m, where the map begins along the shock axis, if that changes
};

/// What of the sample the maps of a file show: the domain at a time, or a strip when it was handed
/// over.
enum class MapPart { domain, strip };

/// File name of a record in its folder: morphology_NNNNNN.h5 or strip_NNNNNN.h5.
std::string morphology_name(std::int64_t record, MapPart part = MapPart::domain);

/// Writes /<field>/{time, step, record, threshold, pixels, counts..., functionals...}, curves as
/// 1 x thresholds, and hot spots as /<field>/domains/{record, columns...}, one row per spot,
/// replacing an older file. The stamp's numbers have the side of a pixel (m) as "pixel". Rank 0's
/// arguments count, and rank 0 works; SystemError on all ranks when it fails. Collective.
void write_morphology(const std::string& path, const RecordStamp& stamp,
                      const std::vector<MorphologyRecord>& records, MPI_Comm communicator,
                      MapPart part = MapPart::domain);

/// Functionals of one field over the records of a run.
struct MorphologyCurves {
  std::string scene;                                       ///< scene text, empty for arrays
  std::string unit;                                        ///< of the thresholds
  double pixel = 0.0;                                      ///< m, side of a pixel
  std::vector<double> threshold;                           ///< ascending
  std::vector<double> time;                                ///< s, ascending
  std::map<std::string, std::vector<double>> functionals;  ///< by name, each times x thresholds
};

/// Reads all functionals of one field from morphology.h5 of a folder, or from the file `path`
/// itself, whole on every rank. InputError on all ranks when the file is missing or damaged, or
/// lacks the field. Collective.
MorphologyCurves read_morphology(const std::string& path, const std::string& field,
                                 MPI_Comm communicator);

/// Takes the records from number `first` on out of morphology.h5, which a restarted run is about to
/// measure again. Without such a file or such records nothing changes; InputError on all ranks when
/// the file is damaged. Rank 0 works. Collective.
void remove_morphology_from(const std::string& folder, std::int64_t first, MPI_Comm communicator);

/// Merges all morphology_NNNNNN.h5 of a folder (strip_NNNNNN.h5 into strips.h5), and what an
/// earlier morphology.h5 holds of other records, into morphology.h5 (curves as times x thresholds,
/// in the order of the records) and removes the small files once it is safely there. Without small
/// files nothing changes. InputError on all ranks when a file is damaged or its thresholds or
/// curves differ from the others'; the small files are kept then. Rank 0 works. Returns the number
/// of records merged. Collective.
std::int64_t collect_morphology(const std::string& folder, MPI_Comm communicator,
                                MapPart part = MapPart::domain);

}  // namespace poreshock
