// Bricks: cubes of 8^3 cells, the unit in which gradients of a grid are accumulated.
//
// A cell belongs to the brick that holds its lower corner, so every sample has exactly one owner.
// The owner accumulates into a private copy of the brick with a halo: one more voxel along each
// axis, since a cell's far corners may lie in the next brick. The copy fits into the L1 cache and
// is then added to the gradient. Halos overlap the next bricks, so bricks are flushed in eight
// colors, by the parity of their coordinates: two bricks of one color share no voxel, and the order
// of the additions to a voxel (by color) does not depend on threads.
#pragma once

#include "photograd/core/isa.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

inline constexpr int brick_side = 8;
inline constexpr int brick_halo_side = brick_side + 1;
inline constexpr int brick_halo_voxels = brick_halo_side * brick_halo_side * brick_halo_side;
inline constexpr int brick_colors = 8;

/// How a grid of (x, y, z) voxels is covered by bricks.
struct BrickLayout {
    int shape[3];
    int bricks[3];

    static BrickLayout of(const int* shape) {
        BrickLayout layout{};
        for (int axis = 0; axis < 3; ++axis) {
            layout.shape[axis] = shape[axis];
            layout.bricks[axis] = (shape[axis] + brick_side - 1) / brick_side;
        }
        return layout;
    }
    [[nodiscard]] int count() const { return bricks[0] * bricks[1] * bricks[2]; }
    [[nodiscard]] int owner(int i, int j, int k) const {
        return (i / brick_side * bricks[1] + j / brick_side) * bricks[2] + k / brick_side;
    }
    /// Lower corner of a brick, in voxels.
    void corner(int brick, int* out) const {
        out[0] = brick / (bricks[1] * bricks[2]) * brick_side;
        out[1] = brick / bricks[2] % bricks[1] * brick_side;
        out[2] = brick % bricks[2] * brick_side;
    }
    [[nodiscard]] int color(int brick) const {
        int at[3];
        corner(brick, at);
        return (at[0] / brick_side % 2) * 4 + (at[1] / brick_side % 2) * 2 + at[2] / brick_side % 2;
    }
};

/// gradient (X, Y, Z, C) += halo (brick_halo_side^3, C), leaving out what lies beyond the grid.
template <class R, int C>
void flush_halo(const BrickLayout& layout, int brick, const R* halo, R* gradient) {
    int at[3], size[3];
    layout.corner(brick, at);
    for (int axis = 0; axis < 3; ++axis) {
        const int left = layout.shape[axis] - at[axis];
        size[axis] = left < brick_halo_side ? left : brick_halo_side;
    }
    for (int i = 0; i < size[0]; ++i)
        for (int j = 0; j < size[1]; ++j) {
            const R* from = halo + (i * brick_halo_side + j) * brick_halo_side * C;
            R* to = gradient + ((static_cast<long long>(at[0] + i) * layout.shape[1] + at[1] + j) *
                                    layout.shape[2] +
                                at[2]) *
                                   C;
            for (int k = 0; k < size[2] * C; ++k) to[k] += from[k];
        }
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
