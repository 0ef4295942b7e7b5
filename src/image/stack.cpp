#include "poreshock/image/stack.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "image_format.hpp"
#include "poreshock/core/rank_zero.hpp"
#include "slice_names.hpp"
#include "tiff_file.hpp"
#include "volume_header.hpp"

namespace poreshock {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

bool is_tiff(const std::string& name) {
  return name.ends_with(".tif") || name.ends_with(".tiff") || name.ends_with(".TIF") ||
         name.ends_with(".TIFF");
}

/// Sizes that follow from the axes of an array, the first of which is the slowest.
void take_shape(Stack& stack) {
  const std::vector<std::uint64_t>& shape = stack.array->shape;
  const auto dimension = static_cast<std::size_t>(stack.dimension);
  const bool good = shape.size() == dimension &&
                    std::all_of(shape.begin(), shape.end(),
                                [](std::uint64_t n) { return n >= 1 && n <= 1000000000; });
  if (good) {
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      stack.size[axis] = static_cast<std::int64_t>(shape[dimension - 1 - axis]);
    }
    return;
  }
  std::string found;
  for (const std::uint64_t n : shape) found += (found.empty() ? "" : " x ") + std::to_string(n);
  throw InputError("sample.image: " + stack.name + ": is an array of " + found +
                   " numbers, allowed are " + std::to_string(dimension) +
                   " axes from 1 to 1e9 long, x the last.");
}

StoredArray raw_array(const Stack& stack, const RawLayout& raw) {
  StoredArray array;
  array.file = stack.name;
  array.number = raw.number;
  array.big_endian = raw.big_endian;
  array.data_begin = static_cast<std::uint64_t>(raw.skip);
  for (int axis = stack.dimension - 1; axis >= 0; --axis) {
    array.shape.push_back(static_cast<std::uint64_t>(raw.size[static_cast<std::size_t>(axis)]));
  }
  return array;
}

/// The first picture tells the size and depth of all.
void take_first(const Image& image, std::int64_t slices, Stack& stack) {
  stack.size = {image.columns, image.rows, slices};
  stack.depth = image.depth;
}

/// A folder, a picture or a TIFF file. Not collective.
void find_pictures(Stack& stack) {
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(stack.name, ignored);
  if (stack.dimension == 2) {
    if (folder) refuse_image(stack.name, "is a folder, which is a stack for three dimensions");
    stack.slices = {stack.name};
    return take_first(read_image(stack.name, stack.grey), 1, stack);
  }
  stack.pages = !folder && is_tiff(stack.name);
  if (stack.pages) {
    TiffFile file(stack.name);
    return take_first(file.read(0, stack.grey), file.pages(), stack);
  }
  if (!folder) {
    throw InputError("sample.image: " + stack.name +
                     ": is no stack of slices. Allowed are in three dimensions a folder of slices, "
                     ".tif, .mhd, .mha, .nrrd, .nhdr, .npy, FILE.h5:/path, or any file with "
                     "sample.raw_size.");
  }
  stack.slices = find_slices(stack.name, stack.problems);
  take_first(read_image(stack.slices[0], stack.grey),
             static_cast<std::int64_t>(stack.slices.size()), stack);
}

/// Runs `action` on rank 0 and, when it has found nothing wrong, on all. Collective.
void after_rank_zero(MPI_Comm communicator, const std::function<void()>& action) {
  on_rank_zero(communicator, action);
  agree(rank(communicator) == 0 ? Outcome{} : attempt(action), communicator);
}

/// The message of a failure without the name of the key.
std::string plain_reason(const std::string& message) {
  constexpr std::string_view key = "sample.image: ";
  return message.starts_with(key) ? message.substr(key.size()) : message;
}

/// Copies a picture into its place unless it differs from the first.
void place(const Stack& stack, const Image& image, double* values) {
  if (image.columns != stack.size[0] || image.rows != stack.size[1] || image.depth != stack.depth) {
    const auto text = [](std::int64_t columns, std::int64_t rows, int depth) {
      return std::to_string(columns) + " x " + std::to_string(rows) + " pixels of " +
             std::to_string(depth) + " bits";
    };
    throw InputError("has " + text(image.columns, image.rows, image.depth) + ", allowed are " +
                     text(stack.size[0], stack.size[1], stack.depth) + " as in the first");
  }
  std::copy(image.value.begin(), image.value.end(), values);
}

/// Slices of a folder, or pages of a TIFF file. Not collective.
void read_pictures(const Stack& stack, std::int64_t first, std::int64_t count, double* values,
                   std::vector<std::string>& problems) {
  std::optional<TiffFile> file;
  for (std::int64_t k = first; k < first + count; ++k) {
    const std::string of = std::to_string(k + 1) + " of " + std::to_string(stack.size[2]);
    const std::string name = stack.pages ? stack.name : stack.slices[static_cast<std::size_t>(k)];
    try {
      if (stack.pages && !file) file.emplace(stack.name);
      place(stack, stack.pages ? file->read(k, stack.grey) : read_image(name, stack.grey), values);
    } catch (const InputError& error) {
      const std::string reason = plain_reason(error.what());
      const std::string where = stack.pages ? name + ": page " + of : name + ": slice " + of;
      const std::string known = name + ": ";
      problems.push_back(
          where + (reason.starts_with(known) ? " " + reason.substr(known.size()) : " " + reason));
    }
    values += stack.layer_size();
  }
}

/// Rows of a picture or array in two dimensions from the last one, the lowest, up.
void turn_rows(std::int64_t columns, std::vector<double>& values) {
  const std::int64_t rows = static_cast<std::int64_t>(values.size()) / columns;
  for (std::int64_t y = 0; y < rows / 2; ++y) {
    std::swap_ranges(values.begin() + y * columns, values.begin() + (y + 1) * columns,
                     values.begin() + (rows - 1 - y) * columns);
  }
}

/// Labels with a fraction are grey values that lack a threshold.
void check_labels(const Stack& stack, std::int64_t first, const std::vector<double>& values,
                  std::vector<std::string>& problems) {
  const auto odd = std::find_if(values.begin(), values.end(),
                                [](double v) { return !std::isnan(v) && v != std::floor(v); });
  if (odd == values.end()) return;
  const std::int64_t layer = first + (odd - values.begin()) / stack.layer_size();
  problems.push_back(stack.name + ": " + (stack.dimension == 3 ? "slice " : "row ") +
                     std::to_string(layer + 1) + " has the value " + std::to_string(*odd) +
                     ", labels are whole numbers. Set sample.threshold if values are grey");
}

/// find_stack for a stack that knows its name. Collective.
void find_values(const std::optional<RawLayout>& raw, MPI_Comm communicator, Stack& stack) {
  const char* layer = stack.dimension == 3 ? "slice" : "row";
  if (!raw && names_array(stack.name)) {
    stack.array = find_array(stack.name, communicator, layer);
    return take_shape(stack);
  }
  after_rank_zero(communicator, [&] {
    Stack found = stack;
    if (raw || names_volume(found.name)) {
      found.array = raw ? raw_array(found, *raw) : read_volume_header(found.name, found.dimension);
      require_numbers(*found.array, layer);
      take_shape(found);
    } else {
      find_pictures(found);
    }
    stack = found;
  });
}

}  // namespace

Stack find_stack(const std::string& name, int dimension, bool grey,
                 const std::optional<RawLayout>& raw, MPI_Comm communicator) {
  Stack stack;
  stack.name = name;
  stack.dimension = dimension;
  stack.grey = grey;
  try {
    find_values(raw, communicator, stack);
  } catch (const InputError& error) {
    throw InputError("sample.image: " + plain_reason(error.what()));
  }
  return stack;
}

std::int64_t layers_at_once(const Stack& stack) {
  if (stack.dimension == 2 && !stack.array) return stack.layers();
  return std::max<std::int64_t>(1, (std::int64_t{1} << 20) / stack.layer_size());
}

std::vector<double> read_layers(const Stack& stack, std::int64_t first, std::int64_t count,
                                MPI_Comm communicator, std::vector<std::string>& problems) {
  std::vector<double> values;
  const bool flat = stack.dimension == 2;
  if (stack.array) {
    const std::int64_t begin = flat ? stack.layers() - first - count : first;
    values = read_rows(*stack.array, static_cast<std::uint64_t>(begin),
                       static_cast<std::uint64_t>(count), communicator);
  } else if (flat && count > 0) {
    values = read_image(stack.name, stack.grey).value;
    const auto begin = values.begin() + (stack.layers() - first - count) * stack.size[0];
    values.erase(begin + count * stack.size[0], values.end());
    values.erase(values.begin(), begin);
  } else if (count > 0) {
    values.assign(static_cast<std::size_t>(count * stack.layer_size()), nothing);
    read_pictures(stack, first, count, values.data(), problems);
  }
  if (flat) turn_rows(stack.size[0], values);
  if (!stack.grey) check_labels(stack, first, values, problems);
  return values;
}

}  // namespace poreshock
