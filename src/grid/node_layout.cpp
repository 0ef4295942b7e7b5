#include "poreshock/grid/node_layout.hpp"

#include <algorithm>
#include <string>

#include "poreshock/core/error.hpp"

namespace poreshock {

namespace {

constexpr int row_bits = 30;   // a tile is a whole row
constexpr int small_bits = 2;  // a tile is four nodes

void reset(int fields, int tile_bits, std::int32_t shift, NodeLayout& layout) {
  layout.fields = fields;
  layout.tile_bits = tile_bits;
  layout.tiles = ((layout.row_size - 1) >> tile_bits) + 1;
  layout.shift.assign(static_cast<std::size_t>(layout.rows) * fields * layout.tiles, shift);
}

}  // namespace

void take_all_nodes(int fields, NodeLayout& layout) {
  reset(fields, row_bits, 0, layout);
  finish_layout(layout);
}

void take_node_rows(int first, int last, NodeLayout& layout) {
  reset(1, row_bits, no_tile, layout);
  std::fill(layout.shift.begin() + (first - layout.first_row),
            layout.shift.begin() + (last - layout.first_row), 0);
  finish_layout(layout);
}

void begin_layout(int fields, NodeLayout& layout) {
  reset(fields, small_bits, no_tile, layout);
}

void mark_nodes(int field, int row, int first, int last, NodeLayout& layout) {
  std::int32_t* const tiles = layout.shift.data() + line_number(layout, field, row) * layout.tiles;
  std::fill(tiles + (first >> layout.tile_bits), tiles + ((last - 1) >> layout.tile_bits) + 1, 0);
}

void finish_layout(NodeLayout& layout) {
  layout.runs.clear();
  layout.first_run.clear();
  std::int64_t place = 0;
  std::int32_t* tiles = layout.shift.data();
  for (int line = 0; line < layout.rows * layout.fields; ++line, tiles += layout.tiles) {
    layout.first_run.push_back(static_cast<std::uint32_t>(layout.runs.size()));
    bool goes_on = false;
    for (int t = 0; t < layout.tiles; ++t) {
      const bool there = tiles[t] != no_tile;
      if (there) {
        const int first = t << layout.tile_bits;
        const auto shift = static_cast<std::int32_t>(place - first);
        if (!goes_on) layout.runs.push_back({first, first, shift});
        NodeRun& run = layout.runs.back();
        const int end = std::min(layout.row_size, first + (1 << layout.tile_bits));
        place += end - run.last;
        run.last = end;
        tiles[t] = run.shift;
      }
      goes_on = there;
    }
  }
  layout.first_run.push_back(static_cast<std::uint32_t>(layout.runs.size()));
  layout.size = static_cast<std::size_t>(place);
  if (place > most_nodes) {
    throw InputError("the velocity fields of a rank have " + std::to_string(place) +
                     " nodes, allowed are " + std::to_string(most_nodes) + ": use more ranks");
  }
}

}  // namespace poreshock
