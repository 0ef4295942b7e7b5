// What a file holds: datasets, shapes, units, attributes.
#include <algorithm>

#include "hdf5_handle.hpp"
#include "poreshock/core/rank_zero.hpp"

namespace poreshock {

namespace {

std::optional<NumberType> number_type(hid_t dataset) {
  const Handle type(H5Dget_type(dataset), H5Tclose, "read a type");
  const H5T_class_t kind = H5Tget_class(type.get());
  const std::size_t bytes = H5Tget_size(type.get());
  if (kind == H5T_FLOAT && bytes == 8) return NumberType::float64;
  if (kind == H5T_FLOAT && bytes == 4) return NumberType::float32;
  if (kind == H5T_INTEGER && bytes == 8) return NumberType::int64;
  if (kind == H5T_INTEGER && bytes == 4) return NumberType::int32;
  if (kind == H5T_INTEGER && bytes == 1) return NumberType::uint8;
  return std::nullopt;
}

/// Whether HDF5 makes numbers of it: ours, integers of any size, and flags (h5py: an enumeration).
bool holds_numbers(hid_t dataset) {
  const Handle type(H5Dget_type(dataset), H5Tclose, "read a type");
  const H5T_class_t kind = H5Tget_class(type.get());
  return kind == H5T_INTEGER || kind == H5T_ENUM || number_type(dataset).has_value();
}

std::string read_text_attribute(hid_t attribute, hid_t type, const std::string& what) {
  if (H5Tis_variable_str(type) > 0) {
    const Handle memory(H5Tcopy(type), H5Tclose, what);
    char* data = nullptr;
    check_hdf5(H5Aread(attribute, memory.get(), &data), what);
    const std::string text = data != nullptr ? data : "";
    H5free_memory(data);
    return text;
  }
  std::string text(H5Tget_size(type), '\0');
  check_hdf5(H5Aread(attribute, type, text.data()), what);
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

std::optional<AttributeValue> read_attribute(hid_t file, const std::string& object,
                                             const std::string& name) {
  const std::string what = "read the attribute " + name + " of " + object;
  const htri_t exists = H5Aexists_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT);
  if (exists <= 0) return std::nullopt;
  const Handle attribute(
      H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
      what);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose, what);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose, what);
  if (H5Sget_simple_extent_npoints(space.get()) != 1) return std::nullopt;
  switch (H5Tget_class(type.get())) {
    case H5T_STRING:
      return read_text_attribute(attribute.get(), type.get(), what);
    case H5T_INTEGER: {
      std::int64_t value = 0;
      check_hdf5(H5Aread(attribute.get(), H5T_NATIVE_INT64, &value), what);
      return value;
    }
    case H5T_FLOAT: {
      double value = 0.0;
      check_hdf5(H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value), what);
      return value;
    }
    default:
      return std::nullopt;
  }
}

DatasetInfo read_info(hid_t file, const std::string& path) {
  const Handle dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, "open " + path);
  const Handle space(H5Dget_space(dataset.get()), H5Sclose, "read the shape of " + path);
  DatasetInfo info;
  info.path = path;
  info.type = number_type(dataset.get());
  info.numbers = holds_numbers(dataset.get());
  std::vector<hsize_t> shape(
      static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.get()))));
  if (!shape.empty()) H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
  info.shape.assign(shape.begin(), shape.end());
  const auto unit = read_attribute(file, path, "unit");
  if (unit && std::holds_alternative<std::string>(*unit)) info.unit = std::get<std::string>(*unit);
  return info;
}

std::vector<std::string> dataset_paths(hid_t file) {
  std::vector<std::string> paths;
  const auto visit = [](hid_t, const char* name, const H5O_info_t* info, void* data) -> herr_t {
    if (info->type != H5O_TYPE_DATASET) return 0;
    static_cast<std::vector<std::string>*>(data)->push_back(std::string("/").append(name));
    return 0;
  };
  check_hdf5(H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit, &paths, H5O_INFO_BASIC),
             "list the datasets");
  return paths;
}

}  // namespace

std::string_view number_type_name(NumberType type) {
  constexpr std::string_view names[] = {"float64", "float32", "int64", "int32", "uint8"};
  return names[static_cast<int>(type)];
}

std::size_t number_size(NumberType type) {
  constexpr std::size_t sizes[] = {8, 4, 8, 4, 1};
  return sizes[static_cast<int>(type)];
}

std::optional<AttributeValue> Hdf5File::attribute(const std::string& name,
                                                  const std::string& object) {
  std::optional<AttributeValue> value;
  agree_here(attempt([&] { value = read_attribute(handle_, object, name); }));
  return value;
}

std::int64_t Hdf5File::integer(const std::string& name) {
  const auto value = attribute(name);
  if (value && std::holds_alternative<std::int64_t>(*value)) return std::get<std::int64_t>(*value);
  throw InputError(path_ + ": has no integer attribute " + name);
}

double Hdf5File::number(const std::string& name) {
  const auto value = attribute(name);
  if (value && std::holds_alternative<double>(*value)) return std::get<double>(*value);
  if (value && std::holds_alternative<std::int64_t>(*value)) {
    return static_cast<double>(std::get<std::int64_t>(*value));
  }
  throw InputError(path_ + ": has no number attribute " + name);
}

std::string Hdf5File::text(const std::string& name) {
  const auto value = attribute(name);
  if (value && std::holds_alternative<std::string>(*value)) return std::get<std::string>(*value);
  throw InputError(path_ + ": has no text attribute " + name);
}

std::vector<DatasetInfo> Hdf5File::datasets() {
  std::vector<DatasetInfo> infos;
  agree_here(attempt([&] {
    for (const std::string& path : dataset_paths(handle_)) {
      infos.push_back(read_info(handle_, path));
    }
  }));
  return infos;
}

DatasetInfo Hdf5File::dataset(const std::string& path) {
  DatasetInfo info;
  agree_here(attempt([&] {
    // A path through a missing group is an error of H5Lexists, hence the plain attempt to
    // open.
    const hid_t found = H5Dopen2(handle_, path.c_str(), H5P_DEFAULT);
    if (found < 0) throw InputError(path_ + ": has no dataset " + path);
    H5Dclose(found);
    info = read_info(handle_, path);
  }));
  return info;
}

}  // namespace poreshock
