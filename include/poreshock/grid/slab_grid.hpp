#pragma once
// The background grid of one rank: a slab of node rows, and the seam over which neighbouring slabs
// complete their nodal sums.
//
// Node index i = 0 ... cells + 2 along every axis lies at (i - 1) * cell: one node of padding below
// the domain and one above. A window that has moved up has the rows first ... rows - 1. Lateral
// axes are flattened into one row of `row_size` nodes. A particle belongs to its stencil cell,
// named by the lowest node of its stencil; a row of stencil cells has the index of its lowest node
// row, and each row belongs to exactly one rank.

#include <array>
#include <memory>
#include <vector>

#include "poreshock/core/lanes.hpp"
#include "poreshock/core/tensor.hpp"
#include "poreshock/grid/node_layout.hpp"
#include "poreshock/grid/partition.hpp"
#include "poreshock/grid/seam.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Shape of the grid, the same on every rank.
struct GridShape {
  int dimension = 2;
  ShapeFunction function = ShapeFunction::cubic;
  double half_length = 0.0;           ///< cells, half a particle's edge (GIMP)
  int stencil = 4;                    ///< nodes per axis of a stencil
  double cell = 0.0;                  ///< m
  std::array<int, 3> nodes{1, 1, 1};  ///< per axis: cells + 3; of the shock axis: rows
  std::array<bool, 2> periodic{};     ///< lateral axes
  Triple velocity{};                  ///< m/s, of all nodes
  int row_size = 0;                   ///< nodes of one row
  int first = 0;                      ///< lowest node row along the shock axis
  int rows = 0;                       ///< one more than the highest
};

/// The grid of a scene. It rides with walls, so that they stay on a line of nodes. Throws
/// InputError where a rank could not count its nodes.
GridShape make_grid_shape(const Scene& scene);

/// Throws InputError where PETSc cannot count what the seams between so many ranks hold.
void require_countable_seam(const GridShape& shape, int ranks);

/// The same grid so many rows higher: its planes and the ends of its domain come along.
GridShape moved_up(GridShape shape, int rows);

/// True for indices along an axis whose nodes are first ... last - 1 that no end of it reaches: one
/// row beyond its plane mirrors one row inside.
inline bool is_inner_index(int index, int first, int last) {
  return index > first + 2 && index < last - 3;
}

/// Velocity of the nodes, m/s.
template <int Dim>
Vector<Dim> grid_velocity(const GridShape& shape) {
  Vector<Dim> velocity;
  for (int a = 0; a < Dim; ++a) velocity[a] = shape.velocity[static_cast<std::size_t>(a)];
  return velocity;
}

/// Least rows per slab for this stencil (seam depth, and mirror nodes at the walls).
SlabLimits slab_limits(const GridShape& shape);

/// Nodes of one slab, in one velocity field or several. A class because it owns PETSc objects.
class SlabGrid {
 public:
  /// One field with all nodes. starts: parts + 1 row starts, shape.first ... shape.rows.
  /// Collective.
  SlabGrid(const GridShape& shape, std::vector<int> starts, MPI_Comm communicator);
  SlabGrid(const SlabGrid&) = delete;
  SlabGrid& operator=(const SlabGrid&) = delete;

  /// A grid with the nodes of this one, now and later. They share the seam: one may only be filled
  /// when the other has been exchanged. Not collective.
  std::unique_ptr<SlabGrid> sibling() const;

  const GridShape& shape() const { return shape_; }
  MPI_Comm communicator() const { return communicator_; }
  const std::vector<int>& starts() const { return starts_; }
  /// Rows of stencil cells owned: [first_row, last_row).
  int first_row() const { return first_; }
  int last_row() const { return last_; }
  /// Node rows that are complete here: [first_row, node_end), the last ones redundantly with the
  /// rank above.
  int node_end() const { return node_end_; }
  /// Rank that owns a row.
  int owner(int row) const;

  /// Velocity fields, and the nodes that each has.
  int fields() const { return layout_->fields; }
  const NodeLayout& layout() const { return *layout_; }

  /// Gives every field all nodes. Afterwards the grid awaits clear(). Collective.
  void take_fields(int fields);

  /// Gives one field the node rows that particles of a range of rows add to, of all ranks.
  /// Afterwards the grid awaits clear(). Not collective.
  void take_rows(int first, int last);

  /// Gives the fields the nodes that mark(layout) marks, the same on all ranks that hold them, and
  /// those that they stand for across periodic sides. Afterwards the grid awaits clear().
  /// Collective.
  template <class Mark>
  void take_fields(int fields, Mark&& mark) {
    begin_layout(fields, *layout_);
    mark(*layout_);
    finish_fields();
  }

  /// Nodes of one row, row_size entries, of a field that has all; row in [first_row, node_end).
  Lanes* row(int row, int field = 0) { return line(field, row, 0); }
  const Lanes* row(int row, int field = 0) const { return line(field, row, 0); }

  /// A node that the field has; its neighbours in the row follow as far as the field has them.
  Lanes* line(int field, int row, int lateral) {
    return nodes_.data() + shift_at(*layout_, field, row, lateral) + lateral;
  }
  const Lanes* line(int field, int row, int lateral) const {
    return nodes_.data() + shift_at(*layout_, field, row, lateral) + lateral;
  }

  /// A node, null where the field does not have it.
  Lanes* find(int field, int row, int lateral) {
    const std::int32_t shift = shift_at(*layout_, field, row, lateral);
    return shift == no_tile ? nullptr : nodes_.data() + shift + lateral;
  }

  /// The nodes of all fields in the rows from this one on, row after row, as they are stored.
  Lanes* nodes_from(int row) { return nodes_.data() + first_place(*layout_, row); }
  const Lanes* nodes_from(int row) const { return nodes_.data() + first_place(*layout_, row); }

  /// Sets all nodal sums and the seam to +0. Not collective.
  void clear();

  /// Adds the sums of the particles of one row and field to its `stencil` node rows. Call at most
  /// once per row and field, in row order. Not collective.
  void add_row(int row, const Lanes* buffer, int field = 0);

  /// Where the particles of a row add to a run of a field in one of its node rows: node i of the
  /// run is entry i. In the seam that is apart from what other rows add.
  Lanes* target(int row, int node_row, int field, const NodeRun& run);

  /// Completes the nodal sums: one exchange of the seam, sums in row order, periodic sides folded.
  /// Before: add_row for every row with particles. After: nodes in [first_row, node_end) hold the
  /// sums over all particles of the scene. Collective (neighbours).
  void exchange();

  /// Copies nodes onto their periodic images in all rows. Not collective.
  void fill_periodic_images();

  /// Bytes held on this rank.
  std::size_t bytes() const;

 private:
  SlabGrid(const GridShape& shape, std::vector<int> starts, MPI_Comm communicator,
           std::shared_ptr<NodeLayout> layout, std::shared_ptr<Seam> seam);
  void finish_fields();
  int down_plane(int row_offset, int node_offset) const;
  int up_plane(int row_offset, int node_offset) const;
  void assemble_seam_row(int field, int node_row, const Lanes* below, const Lanes* above,
                         int offset);
  void fold_periodic();

  GridShape shape_;
  std::vector<int> starts_;
  MPI_Comm communicator_;
  int first_ = 0, last_ = 0, node_end_ = 0;
  bool has_below_ = false, has_above_ = false;
  int planes_ = 0;  ///< seam planes per direction
  std::shared_ptr<NodeLayout> layout_;
  std::shared_ptr<Seam> seam_;  ///< none on a single rank
  std::vector<Lanes> nodes_;
};

}  // namespace poreshock
