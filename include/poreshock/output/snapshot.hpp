#pragma once
// Snapshots: the particles as a reader wants them, one row per particle, in SI units.

#include <mpi.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "poreshock/core/tensor.hpp"
#include "poreshock/material/material.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// A map on pixels (voxels) beside the particles: this rank's rows of it.
struct SnapshotMap {
  std::string name;
  std::string unit;
  std::vector<std::uint64_t> shape;  ///< of the whole map, rows across the shock axis first
  std::uint64_t first_row = 0;
  std::span<const double> values;  ///< NaN where there is no material
  double pixel = 0.0;              ///< m
  std::array<double, 3> low{};     ///< m, low corner
};

/// What a snapshot is made of; all but the colours is referred to.
template <int Dim>
struct SnapshotInput {
  const Scene& scene;
  const std::string& scene_text;  ///< resolved scene, TOML
  const std::vector<Material>& materials;
  const Particles<Dim>& particles;  ///< of this rank
  std::int64_t record = 0;
  std::int64_t step = 0;
  double time = 0.0;                        ///< s
  Vector<Dim> shift = Vector<Dim>::Zero();  ///< m, added to the positions
  std::vector<std::int32_t> colour = {};    ///< velocity field of each particle; empty: not written
  std::vector<SnapshotMap> maps = {};
  double bottom = 0.0;  ///< m, height of the domain's low side, without the shift
};

/// File name of a snapshot in its folder: snapshot_NNNNNN.h5.
std::string snapshot_name(std::int64_t record);

/// Bytes that one particle takes in a snapshot; `coloured` where it has a colour there, whether or
/// not `input` brings them yet. Not collective.
template <int Dim>
std::size_t snapshot_bytes_per_particle(const SnapshotInput<Dim>& input, bool coloured);

/// Writes /particles/... of all ranks into one sealed file, rank after rank in the order the
/// particles are stored, replacing an older file. Fields as scene.output.fields says (all when
/// empty), as float32 when the scene asks for single precision (ids, grains and materials stay
/// integers), /slabs/owner, the rank of each particle, and the maps as /map/... with `pixel` and
/// `low_x` ... as attributes. Returns the number of temperatures, over
/// all ranks, that were set to the floor of 1 K. Throws SystemError on all ranks when the disk is
/// full. Collective.
template <int Dim>
std::int64_t write_snapshot(const std::string& path, const SnapshotInput<Dim>& input,
                            MPI_Comm communicator);

}  // namespace poreshock
