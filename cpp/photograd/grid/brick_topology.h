// Where a sparse grid keeps its values: a dense table of bricks, and in each brick a row for each
// voxel.
//
//   voxel (i, j, k) -> brick (i >> 3, j >> 3, k >> 3) -> top -> number of the brick, or none
//                   -> rows[brick][(i & 7) 64 + (j & 7) 8 + (k & 7)] -> row of the values, or none
//
// Two loads instead of the walk down a tree. Bricks are numbered in the order of OpenVDB's leaves,
// rows in the order of the voxels of each leaf, so that values go to and fro without a search.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace photograd {

inline constexpr std::int32_t no_row = -1;

class BrickTopology {
public:
    static constexpr int side = 8, voxels_per_brick = side * side * side;

    /// From the leaves of a grid: origins (B, 3), multiples of 8, and active (B, 8, 8, 8). Throws
    /// RangeError for origins off the lattice or twice the same, and for a table beyond
    /// `memory_limit` bytes, before it is made.
    BrickTopology(std::span<const std::int32_t> origins, std::span<const std::uint8_t> active,
                  std::int64_t memory_limit);

    [[nodiscard]] int bricks() const { return static_cast<int>(origins_.size() / 3); }
    [[nodiscard]] std::int64_t voxels() const { return voxels_; }
    [[nodiscard]] std::int64_t memory() const {
        return static_cast<std::int64_t>(4 * (top_.size() + rows_.size() + origins_.size()));
    }

    /// (B, 3) the lowest voxel of each brick.
    [[nodiscard]] const std::vector<std::int32_t>& origins() const { return origins_; }
    /// Rows of the 8^3 voxels of a brick, in C order.
    [[nodiscard]] const std::int32_t* rows_of(std::int32_t brick) const {
        return rows_.data() + static_cast<std::size_t>(brick) * voxels_per_brick;
    }

    /// Number of the brick that holds voxel (i, j, k), or -1.
    [[nodiscard]] std::int32_t brick_of(int i, int j, int k) const {
        const int at[3] = {(i >> 3) - lowest_[0], (j >> 3) - lowest_[1], (k >> 3) - lowest_[2]};
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (at[axis] < 0 || at[axis] >= extent_[axis]) return no_row;
        return top_[static_cast<std::size_t>(
            (std::int64_t(at[0]) * extent_[1] + at[1]) * extent_[2] + at[2])];
    }
    [[nodiscard]] std::int32_t row_in(std::int32_t brick, int i, int j, int k) const {
        return rows_[static_cast<std::size_t>(brick) * voxels_per_brick + offset(i, j, k)];
    }

    /// The bricks and rows of the eight corners of the cell whose lowest voxel is (i, j, k), in the
    /// order of ops/cell_blend.h; no_row where nothing is active.
    void cell(int i, int j, int k, std::int32_t* brick, std::int32_t* row) const {
        if ((i & 7) < 7 && (j & 7) < 7 && (k & 7) < 7) {  // two of three cells: one brick for all
            const std::int32_t only = brick_of(i, j, k);
            for (int n = 0; n < 8; ++n) {
                brick[n] = only;
                row[n] =
                    only < 0 ? no_row : row_in(only, i + (n >> 2), j + (n >> 1 & 1), k + (n & 1));
            }
            return;
        }
        for (int n = 0; n < 8; ++n) {
            const int x = i + (n >> 2), y = j + (n >> 1 & 1), z = k + (n & 1);
            brick[n] = brick_of(x, y, z);
            row[n] = brick[n] < 0 ? no_row : row_in(brick[n], x, y, z);
        }
    }

private:
    static std::size_t offset(int i, int j, int k) {
        return static_cast<std::size_t>((i & 7) * 64 + (j & 7) * 8 + (k & 7));
    }

    std::array<int, 3> lowest_{}, extent_{};  // of the table, in bricks
    std::vector<std::int32_t> top_, rows_, origins_;
    std::int64_t voxels_ = 0;
};

}  // namespace photograd
