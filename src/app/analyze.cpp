#include "poreshock/app/analyze.hpp"

#include <cstdio>
#include <filesystem>
#include <set>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/output/folder.hpp"
#include "poreshock/run/measure.hpp"
#include "poreshock/scene/levels.hpp"
#include "stored_map.hpp"
#include "text.hpp"

namespace poreshock {

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts = {""};
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

[[noreturn]] void refuse_levels(const std::string& option, const std::string& text) {
  throw InputError(option + ": found \"" + text +
                   "\", allowed FROM:TO:STEP or A,B,C: 1 to 65534 numbers in ascending order, in "
                   "the unit of the field");
}

/// Thresholds from FROM:TO:STEP or a list.
std::vector<double> parse_levels(const std::string& option, const std::string& text) {
  const bool range = text.find(':') != std::string::npos;
  std::vector<double> numbers;
  for (const std::string& part : split(text, range ? ':' : ',')) {
    const auto number = parse_number(part);
    if (!number) refuse_levels(option, text);
    if (!range && !numbers.empty() && !(*number > numbers.back())) refuse_levels(option, text);
    numbers.push_back(*number);
  }
  if (!range && static_cast<double>(numbers.size()) > most_thresholds) refuse_levels(option, text);
  if (!range) return numbers;
  if (numbers.size() != 3) refuse_levels(option, text);
  const auto levels = levels_between(numbers[0], numbers[1], numbers[2]);
  if (!levels) refuse_levels(option, text);
  return *levels;
}

/// What all files share.
struct Request {
  const AnalyzeOptions& options;
  MorphologyField what;
  Morphology settings;
};

MapVoids parse_voids(const std::string& text) {
  if (text == "black") return MapVoids::black;
  if (text == "white") return MapVoids::white;
  if (text == "fill") return MapVoids::fill;
  if (text == "exclude") return MapVoids::exclude;
  throw InputError("--voids: found \"" + text +
                   "\", allowed \"black\", \"white\", \"fill\", \"exclude\"");
}

Request make_request(const AnalyzeOptions& options) {
  require_length("--pixel", options.pixel);
  if (options.thresholds.empty() == options.quantiles.empty()) {
    throw InputError(
        "--thresholds: give FROM:TO:STEP or A,B,C in the unit of the field, or, and not both, "
        "--quantiles with shares of the material");
  }
  Request request{options, {}, {}};
  request.settings.domains = true;
  if (options.quantiles.empty()) {
    request.what.thresholds = parse_levels("--thresholds", options.thresholds);
  } else {
    request.what.quantiles = parse_levels("--quantiles", options.quantiles);
  }
  if (!options.voids.empty()) request.settings.voids = parse_voids(options.voids);
  if (options.isoline) request.settings.length = BoundaryLength::isoline;
  if (!options.hot_spots.empty()) {
    request.what.hot_spots = parse_levels("--hot-spots", options.hot_spots);
  }
  return request;
}

/// One file, measured.
struct Measured {
  RecordStamp stamp;
  MorphologyRecord record;
  std::string held;  ///< what the map could not take as it is; empty: nothing
};

/// Says what was cut, held or left out of a map.
template <int Dim>
std::string held_text(const StoredMap<Dim>& stored) {
  const PixelField<Dim>& map = stored.map;
  std::string text;
  const auto add = [&](std::int64_t count, const std::string& what) {
    if (count > 0) text += "  " + std::to_string(count) + " " + what + "\n";
  };
  add(map.capped, "particles are larger than two cells and were cut to that");
  add(map.clamped,
      "particles have values that are not finite, or 64 times the density of the "
      "densest material; they were held");
  add(map.skipped, "particles without positive finite size, density and place were left out");
  add(stored.unknown,
      "pixels are material by the mask but have no value (NaN); they count as void");
  return text;
}

template <int Dim>
Measured measure_map(StoredMap<Dim> stored, Request request, MPI_Comm communicator) {
  request.what.name = stored.field;
  return {stored.stamp,
          measure<Dim>(stored.map, 0, request.what, stored.unit, request.settings, stored.shift,
                       communicator),
          held_text(stored)};
}

/// Arrays are numbered as they come; their time is that number.
Measured measure_array(const std::string& name, std::int64_t number, const Request& request,
                       MPI_Comm communicator) {
  const StoredArray array = find_array(name, communicator);
  const std::size_t dimension = array.shape.size();
  const bool empty = array.row_size() == 0 || (dimension > 0 && array.shape[0] == 0);
  if (dimension < 2 || dimension > 3 || empty) {
    throw InputError(name + ": found an array of " + std::to_string(dimension) +
                     (empty ? " dimensions without numbers" : " dimensions") +
                     ", allowed 2 or 3, the last one x and the first one the shock axis");
  }
  const AnalyzeOptions& options = request.options;
  Measured result =
      dimension == 2
          ? measure_map<2>(map_of_array<2>(array, options, communicator), request, communicator)
          : measure_map<3>(map_of_array<3>(array, options, communicator), request, communicator);
  result.stamp.record = number;
  result.stamp.time = static_cast<double>(number);
  return result;
}

Measured measure_snapshot(const std::string& path, const Request& request, MPI_Comm communicator) {
  const AnalyzeOptions& options = request.options;
  if (!options.mask.empty() || !options.periodic.empty()) {
    throw InputError(path + ": --mask and --periodic are for arrays; a snapshot knows both");
  }
  std::int64_t dimension = 0;
  {
    Hdf5File file = Hdf5File::open(path, communicator);
    const auto kind = file.attribute("kind");
    if (!kind || *kind != AttributeValue("snapshot")) {
      throw InputError(path + ": not a snapshot; for an array in an HDF5 file write " + path +
                       ":/path/of/the/array");
    }
    dimension = file.integer("dimension");
  }
  return dimension == 2 ? measure_map<2>(map_of_snapshot<2>(path, options, communicator), request,
                                         communicator)
                        : measure_map<3>(map_of_snapshot<3>(path, options, communicator), request,
                                         communicator);
}

void print(const std::string& name, const Measured& measured) {
  const MorphologyRecord& record = measured.record;
  std::printf("%s: %s, %lld pixels of material\n  %-16s", name.c_str(), record.field.c_str(),
              static_cast<long long>(record.pixels), ("threshold [" + record.unit + "]").c_str());
  for (const Curve& curve : record.functionals) std::printf(" %-13s", curve.name.c_str());
  std::printf("\n");
  for (std::size_t j = 0; j < record.threshold.size(); ++j) {
    std::printf("  %-16.8g", record.threshold[j]);
    for (const Curve& curve : record.functionals) std::printf(" %-13.6g", curve.values[j]);
    std::printf("\n");
  }
  if (!record.spot_columns.empty()) std::printf("  %zu hot spots listed\n", record.spots);
  std::printf("%s", measured.held.c_str());
}

}  // namespace

void analyze(const AnalyzeOptions& options, MPI_Comm communicator) {
  const Request request = make_request(options);
  const bool written = !options.output.empty();
  if (written) require_output_folder(options.output, options.force, false, communicator);
  bool prepared = false;
  std::unique_ptr<FolderLock> lock;
  std::set<std::int64_t> numbers;
  for (const std::string& name : options.files) {
    const auto number = static_cast<std::int64_t>(numbers.size());
    const Measured measured = names_array(name) ? measure_array(name, number, request, communicator)
                                                : measure_snapshot(name, request, communicator);
    if (!numbers.insert(measured.stamp.record).second) {
      throw InputError(name + ": another of the files has the same record number, " +
                       std::to_string(measured.stamp.record) + "; analyse one run at a time");
    }
    if (rank(communicator) == 0) print(name, measured);
    if (!written) continue;
    // Not before the first file has been read: a wrong name costs no earlier result.
    if (!prepared) {
      lock = prepare_output_folder(options.output, options.force, false, communicator);
    }
    prepared = true;
    write_morphology(options.output + "/" + morphology_name(measured.stamp.record), measured.stamp,
                     {measured.record}, communicator);
  }
  if (written) collect_morphology(options.output, communicator);
}

}  // namespace poreshock
