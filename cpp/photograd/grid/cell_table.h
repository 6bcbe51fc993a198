// The cells of a sparse grid, for marching: the rows at the eight corners of a cell without a
// search, and the distance to the nearest cell that has any.
//
// A cell has the number of its lowest voxel. Cells are kept in tiles of 8^3; a tile holds the rows
// of the 9^3 voxels that its cells have as corners, so that a cell's corners lie at fixed offsets
// in one tile. Where no corner of a tile is active the table holds, negated, the Chebyshev distance
// to the nearest tile in bricks: what lies nearer is empty space to skip [Levoy1990].
//
//   cell (i, j, k) -> top[((i >> 3) + 1, (j >> 3) + 1, (k >> 3) + 1)] -> tile, or -distance
//                  -> rows[tile][((i & 7) 9 + (j & 7)) 9 + (k & 7) + corner_offset] -> row, or none
//
// Tile 0 has no rows: a lookup in empty space needs no branch.
#pragma once

#include <array>
#include <vector>

#include "photograd/core/parallel.h"
#include "photograd/grid/brick_topology.h"
#include "photograd/grid/cell_view.h"

namespace photograd {

class CellTable {
public:
    /// For a grid of `shape` voxels, the first of which is (0, 0, 0). Throws RangeError when a
    /// voxel of the topology lies outside, or the table would need more than `memory_limit` bytes.
    CellTable(const BrickTopology& topology, std::array<int, 3> shape, std::int64_t memory_limit);

    [[nodiscard]] CellView view() const {
        return {top_.data(), rows_.data(), active_.data(), {extent_[0], extent_[1], extent_[2]}};
    }
    [[nodiscard]] std::array<int, 3> shape() const { return shape_; }
    [[nodiscard]] std::int64_t tiles() const {
        return static_cast<std::int64_t>(rows_.size()) / cell_tile_voxels - 1;
    }
    [[nodiscard]] std::int64_t memory() const {
        return static_cast<std::int64_t>(4 * (top_.size() + rows_.size()) + active_.size());
    }
    /// out (T + 1, 9, 9, 9): the value of each row of a tile, or `missing` where there is none.
    template <class R>
    void spread(const R* values, R missing, R* out) const {
        parallel_for(tiles() + 1, [&](std::int64_t tile) {
            for (std::int64_t v = tile * cell_tile_voxels; v < (tile + 1) * cell_tile_voxels; ++v) {
                const std::int32_t row = rows_[static_cast<std::size_t>(v)];
                out[v] = row < 0 ? missing : values[row];
            }
        });
    }

    // Owners of gradients: the bricks of the topology, whose rows follow one another.
    [[nodiscard]] const BrickTopology& topology() const { return topology_; }

private:
    void measure_distances();
    void mark_active();

    BrickTopology topology_;
    std::array<int, 3> shape_, extent_;
    std::vector<std::int32_t> top_, rows_;
    std::vector<std::uint8_t> active_;
};

}  // namespace photograd
