// Trilinear interpolation of eight corners that may lie anywhere in memory, as in a sparse grid.
//
// Corner (x, y, z) of a cell, each 0 or 1, has number 4 x + 2 y + z. With the fractions f of a
// point in the cell and the weights w(0) = 1 - f, w(1) = f along each axis
//
//   out = sum_xyz w_x w_y w_z v_xyz,   dout/dv_xyz = w_x w_y w_z,
//   dout/df_x = sum_yz w_y w_z (v_1yz - v_0yz), ...
//
// The sum has the order of ops/trilinear.h, so that dense and sparse lookups agree bit for bit.
#pragma once

#include <cmath>

#include "photograd/core/dual.h"

namespace photograd {

template <class R>
struct CellWeights {
    R x[2], y[2], z[2];

    static CellWeights of(const R* fraction) {
        return {{R(1) - fraction[0], fraction[0]},
                {R(1) - fraction[1], fraction[1]},
                {R(1) - fraction[2], fraction[2]}};
    }
    [[nodiscard]] R corner(int number) const {
        return (x[number >> 2] * y[number >> 1 & 1]) * z[number & 1];
    }
    /// d_fraction[axis] += d_weight d corner(number) / d fraction[axis].
    void corner_backward(int number, R d_weight, R* d_fraction) const {
        const int i = number >> 2, j = number >> 1 & 1, k = number & 1;
        d_fraction[0] += (i ? d_weight : -d_weight) * (y[j] * z[k]);
        d_fraction[1] += (j ? d_weight : -d_weight) * (x[i] * z[k]);
        d_fraction[2] += (k ? d_weight : -d_weight) * (x[i] * y[j]);
    }
};

/// A point in its cell; q in voxels, voxel i at q = i.
template <class R>
struct CellPoint {
    int base[3];  // the lowest corner
    CellWeights<R> weights;

    static CellPoint of(const R* q) {
        CellPoint at;
        R fraction[3];
        for (int axis = 0; axis < 3; ++axis) {
            const R floor = std::floor(q[axis]);
            at.base[axis] = static_cast<int>(floor);
            fraction[axis] = q[axis] - floor;
        }
        at.weights = CellWeights<R>::of(fraction);
        return at;
    }
};

/// out[c] = the blend of corner[0..7][c].
template <class R>
inline void cell_blend(const R* const* corner, const CellWeights<R>& w, int channels, R* out) {
    const R w00 = w.x[0] * w.y[0], w01 = w.x[0] * w.y[1], w10 = w.x[1] * w.y[0],
            w11 = w.x[1] * w.y[1];
    for (int c = 0; c < channels; ++c) {
        R end[2];
        for (int k = 0; k < 2; ++k)
            end[k] = ((w00 * corner[k][c] + w01 * corner[2 + k][c]) + w10 * corner[4 + k][c]) +
                     w11 * corner[6 + k][c];
        out[c] = end[0] * w.z[0] + end[1] * w.z[1];
    }
}

/// d_corner[c] += d_out[c] weight of corner `number`.
template <class R>
inline void cell_blend_backward(int number, const CellWeights<R>& w, int channels, const R* d_out,
                                R* d_corner) {
    const R weight = w.corner(number);
    for (int c = 0; c < channels; ++c) d_corner[c] += weight * d_out[c];
}

/// d_fraction[axis] += <d_out, d out / d fraction[axis]>.
template <class R>
inline void cell_blend_fraction_backward(const R* const* corner, const CellWeights<R>& w,
                                         int channels, const R* d_out, R* d_fraction) {
    for (int number = 0; number < 8; ++number) {
        R d_weight = R(0);
        for (int c = 0; c < channels; ++c) d_weight += d_out[c] * corner[number][c];
        w.corner_backward(number, d_weight, d_fraction);
    }
}

}  // namespace photograd
