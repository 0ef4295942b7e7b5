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

/// Planes of nodes that a rank sends to one neighbour: each of its outer rows keeps apart what it
/// adds to each row of the seam.
int seam_planes(const GridShape& shape) {
  const int depth = shape.stencil - 1;
  return depth * (depth + 1) / 2;
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
  std::int64_t nodes = 1;
  for (int axis = 0; axis < scene.dimension; ++axis) {
    shape.nodes[axis] = scene.domain.cells[axis] + 3;
    nodes *= shape.nodes[axis];
  }
  // The slab of a rank may be nearly all of the grid, where most rows sleep.
  if (nodes > most_nodes) {
    throw InputError("the grid has " + std::to_string(nodes) + " nodes, allowed are " +
                     std::to_string(most_nodes) +
                     ", which a rank can count in 32 bits: use larger cells");
  }
  shape.row_size = scene.dimension == 2 ? shape.nodes[0] : shape.nodes[0] * shape.nodes[1];
  shape.rows = shape.nodes[scene.dimension - 1];
  return shape;
}

GridShape moved_up(GridShape shape, int rows) {
  shape.first += rows;
  shape.rows += rows;
  shape.nodes[shape.dimension - 1] += rows;
  return shape;
}

void require_countable_seam(const GridShape& shape, int ranks) {
  constexpr std::int64_t most = std::numeric_limits<PetscInt>::max();
  const std::int64_t of_rank = std::int64_t{lane_count} * shape.row_size * seam_planes(shape) * 2;
  if (ranks == 1 || of_rank * ranks <= most) return;
  throw InputError("the seams between " + std::to_string(ranks) + " ranks hold " +
                   std::to_string(of_rank * ranks) + " numbers, allowed are " +
                   std::to_string(most) + " with this PETSc: use at most " +
                   std::to_string(most / of_rank) +
                   " ranks, larger cells, or build with a PETSc of 64-bit indices "
                   "(libpetsc64-real-dev)");
}

SlabLimits slab_limits(const GridShape& shape) {
  // Inner slabs: the seam depth. At a wall the nodes one row beyond it mirror those one row inside,
  // and no other rank may hold only one of the two.
  return {3, shape.stencil - 1, shape.stencil + 2};
}

SlabGrid::SlabGrid(const GridShape& shape, std::vector<int> starts, MPI_Comm communicator)
    : SlabGrid(shape, std::move(starts), communicator, std::make_shared<NodeLayout>(), nullptr) {
  layout_->first_row = first_;
  layout_->rows = node_end_ - first_;
  layout_->row_size = shape.row_size;
  if (has_below_ || has_above_) {
    seam_ = std::make_shared<Seam>(shape.row_size, planes_, communicator);
  }
  take_fields(1);
  clear();
}

SlabGrid::SlabGrid(const GridShape& shape, std::vector<int> starts, MPI_Comm communicator,
                   std::shared_ptr<NodeLayout> layout, std::shared_ptr<Seam> seam)
    : shape_(shape),
      starts_(std::move(starts)),
      communicator_(communicator),
      layout_(std::move(layout)),
      seam_(std::move(seam)) {
  const int me = rank(communicator);
  const int depth = shape.stencil - 1;
  first_ = starts_[me];
  last_ = starts_[me + 1];
  has_below_ = me > 0;
  has_above_ = me + 1 < size(communicator);
  node_end_ = has_above_ ? last_ + depth : shape.rows;
  planes_ = seam_planes(shape);
}

std::unique_ptr<SlabGrid> SlabGrid::sibling() const {
  return std::unique_ptr<SlabGrid>(new SlabGrid(shape_, starts_, communicator_, layout_, seam_));
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
  // A vector alone would double its room when a few nodes are added.
  if (layout_->size > nodes_.capacity()) {
    nodes_ = {};
    nodes_.reserve(layout_->size + layout_->size / 16);
  }
  nodes_.resize(layout_->size);
  set_zero(nodes_.data(), static_cast<std::ptrdiff_t>(nodes_.size()));
  if (!seam_) return;
  for (int field = 0; field < fields(); ++field) {
    set_zero(seam_->field(field), std::ptrdiff_t{2} * planes_ * shape_.row_size);
  }
}

Lanes* SlabGrid::target(int row, int node_row, int field, const NodeRun& run) {
  const std::ptrdiff_t width = shape_.row_size;
  const int depth = shape_.stencil - 1;
  if (has_below_ && node_row < first_ + depth) {
    return seam_->field(field) + down_plane(row - first_, node_row - first_) * width;
  }
  if (has_above_ && node_row >= last_) {
    return seam_->field(field) + up_plane(row - (last_ - depth), node_row - last_) * width;
  }
  return nodes_.data() + run.shift;
}

void SlabGrid::add_row(int row, const Lanes* buffer, int field) {
  for (int k = 0; k < shape_.stencil; ++k) {
    const Lanes* source = buffer + std::ptrdiff_t{k} * shape_.row_size;
    for (const NodeRun& run : runs_of(*layout_, field, row + k)) {
      Lanes* to = target(row, row + k, field, run);
      for (std::ptrdiff_t i = run.first; i < run.last; ++i) to[i] += source[i];
    }
  }
}

void SlabGrid::assemble_seam_row(int field, int node_row, const Lanes* below, const Lanes* above,
                                 int offset) {
  const std::ptrdiff_t width = shape_.row_size;
  const int depth = shape_.stencil - 1;
  for (const NodeRun& run : runs_of(*layout_, field, node_row)) {
    Lanes* target = nodes_.data() + run.shift;
    const auto add = [&](const Lanes* plane) {
      for (std::ptrdiff_t i = run.first; i < run.last; ++i) target[i] += plane[i];
    };
    set_zero(target + run.first, run.last - run.first);
    for (int a = offset; a < depth; ++a) add(below + up_plane(a, offset) * width);
    for (int a = 0; a <= offset; ++a) add(above + down_plane(a, offset) * width);
  }
}

void SlabGrid::exchange() {
  const std::ptrdiff_t neighbour = std::ptrdiff_t{2} * planes_ * shape_.row_size;
  if (seam_) seam_->exchange(fields());
  // The neighbour below shares its upper planes, at -planes_ ... -1 of mine; counted from its first
  // plane they start at planes_. The neighbour above shares its lower planes, right after mine.
  for (int field = 0; field < fields(); ++field) {
    for (int offset = 0; offset < shape_.stencil - 1; ++offset) {
      const Lanes* own = seam_ ? seam_->field(field) : nullptr;
      if (has_below_) assemble_seam_row(field, first_ + offset, own - neighbour, own, offset);
      if (has_above_) assemble_seam_row(field, last_ + offset, own, own + neighbour, offset);
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

void SlabGrid::take_fields(int fields) {
  take_all_nodes(fields, *layout_);
  if (seam_) seam_->make_fields(fields);
}

void SlabGrid::take_rows(int first, int last) {
  first = std::clamp(first, first_, node_end_);
  take_node_rows(first, std::clamp(last + shape_.stencil - 1, first, node_end_), *layout_);
}

void SlabGrid::finish_fields() {
  for (int r = first_; r < node_end_; ++r) {
    for (int field = 0; field < fields(); ++field) {
      for_each_image(shape_, [&](int image, int original) {
        if (shift_at(*layout_, field, r, image) == no_tile) return;
        mark_nodes(field, r, original, original + 1, *layout_);
      });
    }
  }
  finish_layout(*layout_);
  if (seam_) seam_->make_fields(fields());
}

// Where only one of both is there, it has come with a tile and belongs to no particle.
void SlabGrid::fold_periodic() {
  for (int r = first_; r < node_end_; ++r) {
    for (int field = 0; field < fields(); ++field) {
      for_each_image(shape_, [&](int image, int original) {
        Lanes *from = find(field, r, image), *to = find(field, r, original);
        if (from == nullptr || to == nullptr) return;
        *to += *from;
        *from = Lanes{};
      });
    }
  }
}

void SlabGrid::fill_periodic_images() {
  for (int r = first_; r < node_end_; ++r) {
    for (int field = 0; field < fields(); ++field) {
      for_each_image(shape_, [&](int image, int original) {
        Lanes *to = find(field, r, image), *from = find(field, r, original);
        if (from != nullptr && to != nullptr) *to = *from;
      });
    }
  }
}

std::size_t SlabGrid::bytes() const {
  return sizeof(Lanes) * nodes_.size() + (seam_ ? seam_->bytes() : 0);
}

}  // namespace poreshock
