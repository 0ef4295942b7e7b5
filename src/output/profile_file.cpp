#include "poreshock/output/profile_file.hpp"

#include "poreshock/core/rank_zero.hpp"
#include "record_tables.hpp"

namespace poreshock {

namespace {

TableFormat format() {
  return {"profile", "profiles.h5", "height"};
}

RecordTables make_tables(const RecordStamp& stamp, const Profile& profile) {
  RecordTables tables;
  RecordTable& row = tables["row"];
  row = one_record(stamp);
  row.axis_unit = std::string("m");
  row.axis = profile.height;
  row.curves.series["shift"] = {"m", 0, false, {}, {profile.shift}};
  const auto add = [&](const char* name, const char* unit, const std::vector<double>& values) {
    if (!values.empty()) row.curves.series[name] = {unit, values.size(), false, {}, values};
  };
  add("solid_fraction", "1", profile.solid_fraction);
  add("density", "kg/m^3", profile.density);
  add("pressure", "Pa", profile.pressure);
  add("stress", "Pa", profile.stress);
  add("momentum_flux", "Pa", profile.momentum_flux);
  add("temperature", "K", profile.temperature);
  add("plastic_strain", "1", profile.plastic_strain);
  add("velocity_x", "m/s", profile.velocity[0]);
  add("velocity_y", "m/s", profile.velocity[1]);
  add("velocity_z", "m/s", profile.velocity[2]);
  add("fluctuation", "J/kg", profile.fluctuation);
  RecordTable& front = tables["front"];
  front = one_record(stamp);
  front.curves.series["position"] = {"m", 0, false, {}, {profile.front}};
  front.curves.series["width"] = {"m", 0, false, {}, {profile.width}};
  return tables;
}

}  // namespace

std::string profile_name(std::int64_t record) {
  return record_name(format(), record);
}

void write_profile(const std::string& path, const RecordStamp& stamp, const Profile& profile,
                   MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    write_tables(path, format(), stamp, make_tables(stamp, profile), Durable::later);
  });
}

void require_same_profiles(const std::string& folder, const Profile& profile,
                           MPI_Comm communicator) {
  on_rank_zero(communicator,
               [&] { require_same_tables(folder, format(), make_tables({}, profile)); });
}

void remove_profiles_from(const std::string& folder, std::int64_t first, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] { remove_tables_from(folder, format(), first); });
}

std::int64_t collect_profiles(const std::string& folder, MPI_Comm communicator) {
  std::int64_t merged = 0;
  on_rank_zero(communicator, [&] { merged = collect_tables(folder, format()); });
  check_mpi(MPI_Bcast(&merged, 1, MPI_INT64_T, 0, communicator), "MPI_Bcast");
  return merged;
}

}  // namespace poreshock
