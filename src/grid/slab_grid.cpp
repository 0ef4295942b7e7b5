#include "poreshock/grid/slab_grid.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {

namespace {

/// Sets nodes to +0. Not std::fill: as a template argument Lanes is a type aligned to 64 bytes,
/// which memory of PETSc is not.
void set_zero(Lanes* nodes, std::ptrdiff_t count) {
  for (std::ptrdiff_t i = 0; i < count; ++i) nodes[i] = Lanes{};
}

/// The sides that a grid rides with: planes that stop material, the low one first.
Triple velocity_of_planes(const Scene& scene) {
  Triple velocity{};
  for (int a = 0; a < scene.dimension; ++a) {
    for (const bool high : {true, false}) {
      const Side side = side_at(scene.boundary, a, high, scene.dimension);
      const auto axis = static_cast<std::size_t>(a);
      if (side_law(side.kind).mirrors) velocity[axis] = side.velocity + scene.loading.frame[axis];
    }
  }
  return velocity;
}

}  // namespace

GridShape make_grid_shape(const Scene& scene) {
  GridShape shape;
  shape.dimension = scene.dimension;
  shape.function = scene.transfer.shape;
  shape.half_length = scene.transfer.half_length;
  shape.stencil = of_shape(shape.function, [](const auto& s) { return s.width; });
  shape.cell = scene.domain.cell;
  shape.periodic = scene.domain.periodic;
  shape.velocity = velocity_of_planes(scene);
  // PETSc counts in PetscInt, 32 bits in Debian's default build.
  std::int64_t numbers = lane_count;
  for (int axis = 0; axis < scene.dimension; ++axis) {
    shape.nodes[axis] = scene.domain.cells[axis] + 3;
    numbers *= shape.nodes[axis];
  }
  if (numbers > std::numeric_limits<PetscInt>::max()) {
    throw InputError("the grid has " + std::to_string(numbers / lane_count) +
                     " nodes, allowed are " +
                     std::to_string(std::numeric_limits<PetscInt>::max() / lane_count) +
                     " with this PETSc: use larger cells, or build with a PETSc of 64-bit indices "
                     "(libpetsc64-real-dev)");
  }
  shape.row_size = scene.dimension == 2 ? shape.nodes[0] : shape.nodes[0] * shape.nodes[1];
  shape.rows = shape.nodes[scene.dimension - 1];
  return shape;
}

SlabLimits slab_limits(const GridShape& shape) {
  // Inner slabs: the seam depth. At a wall the nodes one row beyond it mirror those one row inside,
  // and no other rank may hold only one of the two.
  return {3, shape.stencil - 1, shape.stencil + 2};
}

SlabGrid::SlabGrid(const GridShape& shape, std::vector<int> starts, MPI_Comm communicator)
    : shape_(shape), starts_(std::move(starts)), communicator_(communicator) {
  const int me = rank(communicator);
  const int ranks = size(communicator);
  const int depth = shape.stencil - 1;
  first_ = starts_[me];
  last_ = starts_[me + 1];
  has_below_ = me > 0;
  has_above_ = me + 1 < ranks;
  node_end_ = has_above_ ? last_ + depth : shape.rows;
  planes_ = depth * (depth + 1) / 2;

  std::vector<PetscInt> rows_per_rank;
  rows_per_rank.reserve(static_cast<std::size_t>(ranks));
  for (int r = 0; r < ranks; ++r) rows_per_rank.push_back(starts_[r + 1] - starts_[r]);
  const PetscInt all[1] = {shape.row_size};
  // Lateral axes stay whole on every rank, so one flattened lateral axis serves 2-D and 3-D.
  check_petsc(DMDACreate2d(communicator, DM_BOUNDARY_NONE, DM_BOUNDARY_NONE, DMDA_STENCIL_BOX,
                           shape.row_size, shape.rows, 1, ranks, lane_count, depth, all,
                           rows_per_rank.data(), &node_dm_),
              "DMDACreate2d for the nodes");
  check_petsc(DMSetUp(node_dm_), "DMSetUp for the nodes");
  const std::vector<PetscInt> seam_rows(static_cast<std::size_t>(ranks), 2 * planes_);
  check_petsc(DMDACreate2d(communicator, DM_BOUNDARY_NONE, DM_BOUNDARY_NONE, DMDA_STENCIL_BOX,
                           shape.row_size, 2 * planes_ * ranks, 1, ranks, lane_count, planes_, all,
                           seam_rows.data(), &seam_dm_),
              "DMDACreate2d for the seam");
  check_petsc(DMSetUp(seam_dm_), "DMSetUp for the seam");
  check_petsc(DMCreateLocalVector(node_dm_, &node_vector_), "DMCreateLocalVector");
  check_petsc(DMCreateLocalVector(seam_dm_, &seam_vector_), "DMCreateLocalVector");
  check_petsc(VecGetArray(node_vector_, &node_array_), "VecGetArray");
  check_petsc(VecGetArray(seam_vector_, &seam_array_), "VecGetArray");
  PetscInt ghost_row = 0;
  check_petsc(
      DMDAGetGhostCorners(node_dm_, nullptr, &ghost_row, nullptr, nullptr, nullptr, nullptr),
      "DMDAGetGhostCorners");
  nodes_ = reinterpret_cast<Lanes*>(node_array_) +
           static_cast<std::ptrdiff_t>(first_ - ghost_row) * shape.row_size;
  seam_ = reinterpret_cast<Lanes*>(seam_array_) +
          static_cast<std::ptrdiff_t>(has_below_ ? planes_ : 0) * shape.row_size;
}

SlabGrid::~SlabGrid() {
  VecRestoreArray(node_vector_, &node_array_);
  VecRestoreArray(seam_vector_, &seam_array_);
  VecDestroy(&node_vector_);
  VecDestroy(&seam_vector_);
  DMDestroy(&node_dm_);
  DMDestroy(&seam_dm_);
}

int SlabGrid::owner(int row) const {
  const auto above = std::upper_bound(starts_.begin(), starts_.end() - 1, row);
  return static_cast<int>(above - starts_.begin()) - 1;
}

// Plane of my row first + row_offset for the node row first + node_offset (node_offset >=
// row_offset).
int SlabGrid::down_plane(int row_offset, int node_offset) const {
  const int depth = shape_.stencil - 1;
  return row_offset * depth - row_offset * (row_offset - 1) / 2 + (node_offset - row_offset);
}

// Plane of my row last - depth + row_offset for the node row last + node_offset (<= row_offset).
int SlabGrid::up_plane(int row_offset, int node_offset) const {
  return planes_ + row_offset * (row_offset + 1) / 2 + node_offset;
}

void SlabGrid::clear() {
  const std::ptrdiff_t width = shape_.row_size;
  set_zero(nodes_, (node_end_ - first_) * width);
  set_zero(seam_, 2 * planes_ * width);
}

void SlabGrid::add_row(int row, const Lanes* buffer) {
  const std::ptrdiff_t width = shape_.row_size;
  const int depth = shape_.stencil - 1;
  for (int k = 0; k <= depth; ++k) {
    const int node_row = row + k;
    const Lanes* source = buffer + k * width;
    if (has_below_ && node_row < first_ + depth) {
      std::copy(source, source + width,
                seam_ + down_plane(row - first_, node_row - first_) * width);
    } else if (has_above_ && node_row >= last_) {
      std::copy(source, source + width,
                seam_ + up_plane(row - (last_ - depth), node_row - last_) * width);
    } else {
      Lanes* target = this->row(node_row);
      for (std::ptrdiff_t i = 0; i < width; ++i) target[i] += source[i];
    }
  }
}

void SlabGrid::assemble_seam_row(int node_row, const Lanes* below, const Lanes* above, int offset) {
  const std::ptrdiff_t width = shape_.row_size;
  const int depth = shape_.stencil - 1;
  Lanes* target = row(node_row);
  set_zero(target, width);
  for (int a = offset; a < depth; ++a) {
    const Lanes* plane = below + up_plane(a, offset) * width;
    for (std::ptrdiff_t i = 0; i < width; ++i) target[i] += plane[i];
  }
  for (int a = 0; a <= offset; ++a) {
    const Lanes* plane = above + down_plane(a, offset) * width;
    for (std::ptrdiff_t i = 0; i < width; ++i) target[i] += plane[i];
  }
}

void SlabGrid::exchange() {
  const std::ptrdiff_t width = shape_.row_size;
  const int depth = shape_.stencil - 1;
  if (has_below_ || has_above_) {
    check_petsc(VecRestoreArray(seam_vector_, &seam_array_), "VecRestoreArray");
    check_petsc(DMLocalToLocalBegin(seam_dm_, seam_vector_, INSERT_VALUES, seam_vector_),
                "DMLocalToLocalBegin");
    check_petsc(DMLocalToLocalEnd(seam_dm_, seam_vector_, INSERT_VALUES, seam_vector_),
                "DMLocalToLocalEnd");
    check_petsc(VecGetArray(seam_vector_, &seam_array_), "VecGetArray");
  }
  // The neighbour below shares its upper planes, at -planes_ ... -1 of mine; counted from its first
  // plane they start at planes_. The neighbour above shares its lower planes, right after mine.
  for (int offset = 0; offset < depth; ++offset) {
    if (has_below_) {
      assemble_seam_row(first_ + offset, seam_ - 2 * planes_ * width, seam_, offset);
    }
    if (has_above_) {
      assemble_seam_row(last_ + offset, seam_, seam_ + 2 * planes_ * width, offset);
    }
  }
  fold_periodic();
}

namespace {

/// Calls visit(image, original) for every pair of node indices of a row that periodicity
/// identifies, axis after axis.
template <class Visitor>
void for_each_image(const GridShape& shape, Visitor&& visit) {
  const int nx = shape.nodes[0];
  const int ny = shape.dimension == 3 ? shape.nodes[1] : 1;
  if (shape.periodic[0]) {
    for (int y = 0; y < ny; ++y) {
      visit(y * nx, y * nx + nx - 3);
      visit(y * nx + nx - 2, y * nx + 1);
      visit(y * nx + nx - 1, y * nx + 2);
    }
  }
  if (shape.dimension == 3 && shape.periodic[1]) {
    for (int x = 0; x < nx; ++x) {
      visit(x, (ny - 3) * nx + x);
      visit((ny - 2) * nx + x, nx + x);
      visit((ny - 1) * nx + x, 2 * nx + x);
    }
  }
}

}  // namespace

void SlabGrid::fold_periodic() {
  for (int r = first_; r < node_end_; ++r) {
    Lanes* nodes = row(r);
    for_each_image(shape_, [nodes](int image, int original) {
      nodes[original] += nodes[image];
      nodes[image] = Lanes{};
    });
  }
}

void SlabGrid::fill_periodic_images() {
  for (int r = first_; r < node_end_; ++r) {
    Lanes* nodes = row(r);
    for_each_image(shape_, [nodes](int image, int original) { nodes[image] = nodes[original]; });
  }
}

std::size_t SlabGrid::bytes() const {
  PetscInt nodes = 0, seam = 0;
  VecGetLocalSize(node_vector_, &nodes);
  VecGetLocalSize(seam_vector_, &seam);
  return sizeof(double) * static_cast<std::size_t>(nodes + seam);
}

}  // namespace poreshock
