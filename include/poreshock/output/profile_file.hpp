#pragma once
// Files of profiles along the shock axis: one small file per record while the run goes on, one file
// at its end.

#include <mpi.h>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "poreshock/output/record_stamp.hpp"

namespace poreshock {

/// Rows with less solid than this have no averages.
inline constexpr double least_solid_fraction = 1e-4;

/// Averages over each row of cells along the shock axis at one time. Means are over the solid in
/// the row, weighted with mass or with volume as said; NaN below least_solid_fraction.
struct Profile {
  double shift = 0.0;                  ///< m, displacement of the grid since the start
  std::vector<double> height;          ///< m, centre of the row above the low side of the grid
  std::vector<double> solid_fraction;  ///< solid volume over row volume
  std::vector<double> density;         ///< kg/m^3, mass over solid volume
  std::vector<double> pressure;        ///< Pa, weighted with volume
  std::vector<double> stress;          ///< Pa, longitudinal, compression positive, without
                                       ///< artificial viscosity, weighted with volume
  std::vector<double> momentum_flux;   ///< Pa, through planes that move with the row's mean
                                       ///< velocity: stress, artificial viscosity and density x
                                       ///< square of the deviation of the velocity along the axis
  std::vector<double> temperature;     ///< K, weighted with mass
  std::vector<double> plastic_strain;  ///< weighted with mass
  std::array<std::vector<double>, 3> velocity;  ///< m/s, weighted with mass; z empty in 2-D
  std::vector<double> fluctuation;  ///< J/kg, kinetic energy of the deviation from the row's mean
                                    ///< velocity, affine part included
  double front = std::numeric_limits<double>::quiet_NaN();  ///< m, height of the front
  double width = std::numeric_limits<double>::quiet_NaN();  ///< m, of the front
};

/// File name of a record in its folder: profile_NNNNNN.h5.
std::string profile_name(std::int64_t record);

/// Writes /row/{time, step, record, shift, height, solid_fraction, ...}, curves as 1 x rows, and
/// /front/{time, step, record, position, width}, replacing an older file. Rank 0's arguments count,
/// and rank 0 works; SystemError on all ranks when it fails. Collective.
void write_profile(const std::string& path, const RecordStamp& stamp, const Profile& profile,
                   MPI_Comm communicator);

/// Throws InputError on all ranks, which says how to go on, when the profiles of a folder have
/// other rows or curves than this one. Rank 0's arguments count, and rank 0 works. Collective.
void require_same_profiles(const std::string& folder, const Profile& profile,
                           MPI_Comm communicator);

/// Takes the records from number `first` on out of profiles.h5, which a restarted run is about to
/// measure again. Without such a file or such records nothing changes; InputError on all ranks when
/// the file is damaged. Rank 0 works. Collective.
void remove_profiles_from(const std::string& folder, std::int64_t first, MPI_Comm communicator);

/// Merges all profile_NNNNNN.h5 of a folder, and what an earlier profiles.h5 holds of other
/// records, into profiles.h5 (curves as times x rows, in the order of the records) and removes the
/// small files once it is safely there. Without small files nothing changes. InputError on all
/// ranks when a file is damaged or has other rows; the small files are kept then. Rank 0 works.
/// Returns the number of records merged. Collective.
std::int64_t collect_profiles(const std::string& folder, MPI_Comm communicator);

}  // namespace poreshock
