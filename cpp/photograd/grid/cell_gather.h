// Gradients of a sparse grid from records of samples: every brick adds what concerns its own rows, in the
// order of the records, so that a row is summed as a plain loop would sum it, on any number of threads.
#pragma once

#include <algorithm>
#include <cmath>

#include "photograd/grid/cell_table.h"

namespace photograd {

/// A point in its cell.
template <class R>
struct CellPoint {
    int base[3];
    R fraction[3], w[8];

    static CellPoint of(const R* q) {
        CellPoint at;
        for (int axis = 0; axis < 3; ++axis) {
            const R floor = std::floor(q[axis]);
            at.base[axis] = static_cast<int>(floor);
            at.fraction[axis] = q[axis] - floor;
        }
        const R *f = at.fraction, x[2] = {R(1) - f[0], f[0]}, y[2] = {R(1) - f[1], f[1]},
                z[2] = {R(1) - f[2], f[2]};
        for (int n = 0; n < 8; ++n) at.w[n] = (x[n >> 2] * y[n >> 1 & 1]) * z[n & 1];
        return at;
    }
};

/// Parameter gradients of a sparse_sh field, added to.
template <class R>
struct SparseShGradients {
    R* d_density;     // (N,)
    R* d_sh;          // (N, K, 3)
    R* d_background;  // (1 + 3 K,)
};

/// The bricks that hold active corners of the cell at `base`, each once; returns how many.
inline int bricks_of_cell(const BrickTopology& topology, const int* base, std::int32_t* brick) {
    if ((base[0] & 7) < 7 && (base[1] & 7) < 7 && (base[2] & 7) < 7) {
        brick[0] = topology.brick_of(base[0], base[1], base[2]);
        return brick[0] < 0 ? 0 : 1;
    }
    int count = 0;
    for (int n = 0; n < 8; ++n) {
        const std::int32_t found =
            topology.brick_of(base[0] + (n >> 2), base[1] + (n >> 1 & 1), base[2] + (n & 1));
        if (found >= 0 && std::find(brick, brick + count, found) == brick + count)
            brick[count++] = found;
    }
    return count;
}

/// visit(row, trilinear weight) for the corners of a record's cell that a brick owns.
template <class R, class Visit>
void for_own_corners(const BrickTopology& topology, std::int32_t brick, const CellRecord<R>& record,
                     Visit&& visit) {
    const CellPoint<R> at = CellPoint<R>::of(record.q);
    const std::int32_t* rows = topology.rows_of(brick);
    const std::int32_t* origin = topology.origins().data() + 3 * std::int64_t(brick);
    for (int n = 0; n < 8; ++n) {
        const int x = at.base[0] + (n >> 2) - origin[0], y = at.base[1] + (n >> 1 & 1) - origin[1],
                  z = at.base[2] + (n & 1) - origin[2];
        if (((x | y | z) & ~7) != 0) continue;  // another brick's
        const std::int32_t row = rows[(x * 8 + y) * 8 + z];
        if (row >= 0) visit(row, at.w[n]);
    }
}

/// Adds the part of one record that belongs to a brick; D (3 K) is Y_k d_color_c.
template <class R>
void gather_record(const BrickTopology& topology, std::int32_t brick, const CellRecord<R>& record,
                   const R* D, int numbers, const SparseShGradients<R>& to) {
    for_own_corners(topology, brick, record, [&](std::int32_t row, R w) {
        to.d_density[row] = to.d_density[row] + w * record.d[3];
        R* d_sh = to.d_sh + std::int64_t(row) * numbers;
        for (int j = 0; j < numbers; ++j) d_sh[j] = d_sh[j] + w * D[j];
    });
}

/// most[row] = max(most[row], trilinear weight times record.d[0]).
template <class R>
void gather_greatest(const BrickTopology& topology, std::int32_t brick, const CellRecord<R>& record,
                     R* most) {
    for_own_corners(topology, brick, record, [&](std::int32_t row, R w) {
        most[row] = std::max(most[row], w * record.d[0]);
    });
}

}  // namespace photograd
