#pragma once
// Which nodes of a slab each of several velocity fields has, and where they are stored: row after
// row, in a row field after field. With one field that is every node of the rows in use. With
// several, a field has tiles of four nodes where its particles are.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace poreshock {

/// A node of a slab: its row and its index in it, and some of its fields, bit f for field f.
struct NodePlace {
  std::int32_t row = 0, lateral = 0;
  std::uint32_t fields = 0;
};

/// Neighbouring nodes first ... last - 1 of a row that a field has; node i is stored at shift + i.
struct NodeRun {
  std::int32_t first = 0, last = 0, shift = 0;
};

/// Nodes of the rows first_row ... first_row + rows - 1.
struct NodeLayout {
  int first_row = 0, rows = 0, row_size = 0;
  int fields = 0;
  int tile_bits = 0;                     ///< a tile has 2^tile_bits nodes, or is a whole row
  int tiles = 0;                         ///< of a row
  std::vector<std::int32_t> shift;       ///< of every tile, row after row, field after field
  std::vector<NodeRun> runs;             ///< in the order of storage
  std::vector<std::uint32_t> first_run;  ///< of every row and field, and the end
  std::size_t size = 0;                  ///< nodes
};

/// Most nodes of a rank.
inline constexpr std::int64_t most_nodes = std::numeric_limits<std::int32_t>::max();

/// The shift of a tile that a field does not have.
inline constexpr std::int32_t no_tile = std::numeric_limits<std::int32_t>::min();

/// Gives every field all nodes.
void take_all_nodes(int fields, NodeLayout& layout);

/// Gives one field all nodes of the rows first ... last - 1.
void take_node_rows(int first, int last, NodeLayout& layout);

/// Begins a layout without nodes; mark_nodes adds them, finish_layout places them.
void begin_layout(int fields, NodeLayout& layout);

/// Gives a field the nodes first ... last - 1 of a row, and with them all of their tiles.
void mark_nodes(int field, int row, int first, int last, NodeLayout& layout);

/// Throws InputError where there are more than most_nodes.
void finish_layout(NodeLayout& layout);

/// Number of a row and field.
inline std::size_t line_number(const NodeLayout& layout, int field, int row) {
  return static_cast<std::size_t>(row - layout.first_row) * layout.fields + field;
}

/// Shift of the tile of a node, or no_tile.
inline std::int32_t shift_at(const NodeLayout& layout, int field, int row, int lateral) {
  return layout
      .shift[line_number(layout, field, row) * layout.tiles + (lateral >> layout.tile_bits)];
}

/// The runs of a row and field.
inline std::span<const NodeRun> runs_of(const NodeLayout& layout, int field, int row) {
  const std::size_t line = line_number(layout, field, row);
  return {layout.runs.data() + layout.first_run[line],
          layout.runs.data() + layout.first_run[line + 1]};
}

/// Where the nodes of all fields in a row begin.
inline std::size_t first_place(const NodeLayout& layout, int row) {
  const std::uint32_t run = layout.first_run[line_number(layout, 0, row)];
  if (run == layout.runs.size()) return layout.size;
  return static_cast<std::size_t>(std::int64_t{layout.runs[run].shift} + layout.runs[run].first);
}

}  // namespace poreshock
