// The view that kernels get of grid/cell_table.h: plain pointers.
#pragma once

#include <cstdint>

#include "photograd/core/isa.h"

namespace photograd {

inline constexpr int cell_tile_side = 9;
inline constexpr int cell_tile_voxels = cell_tile_side * cell_tile_side * cell_tile_side;

struct CellView {
    const std::int32_t* top;     // (X, Y, Z) tiles, the first of which begins at cell (-8, -8, -8)
    const std::int32_t* rows;    // (T, 9, 9, 9)
    const std::uint8_t* active;  // (T, 9, 9, 9) bit n: corner n of the cell has a row
    int extent[3];
};

/// Inputs to the gradient of one sample.
template <class R>
struct CellRecord {
    R q[3];             // voxel coordinates
    std::uint32_t ray;  // whose basis counts
    R d[4];             // dL/d color (3), dL/d raw density
};

inline namespace PHOTOGRAD_ISA {

/// Where corner n = 4 x + 2 y + z of a cell lies, from its lowest voxel.
constexpr int corner_offset(int n) {
    return ((n >> 2) * cell_tile_side + (n >> 1 & 1)) * cell_tile_side + (n & 1);
}

/// Entry of the tile that holds cell (i, j, k), or -1 outside of the table.
inline int tile_entry(const CellView& v, int i, int j, int k) {
    const int x = (i >> 3) + 1, y = (j >> 3) + 1, z = (k >> 3) + 1;
    const bool inside =
        (x >= 0) & (y >= 0) & (z >= 0) & (x < v.extent[0]) & (y < v.extent[1]) & (z < v.extent[2]);
    return inside ? (x * v.extent[1] + y) * v.extent[2] + z : -1;
}

/// Place of a cell's lowest voxel within a tile.
constexpr int offset_in_tile(int i, int j, int k) {
    return ((i & 7) * cell_tile_side + (j & 7)) * cell_tile_side + (k & 7);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
