// Trilinear interpolation on a grid of values at voxel centers.
//
// Along one axis a coordinate q (in voxels, voxel i at q = i) picks the voxels `base` and `base +
// 1` with weights w0 and w1:
//
//   inside           base = floor(q),  w1 = q - base,  w0 = 1 - w1     dw0/dq = -1  dw1/dq = +1
//   clamp, outside   the border value continues: q is moved onto the border, slopes 0
//   zero, outside    voxels beyond the border hold 0: the border voxel fades over one voxel
//
// `base` always lies in [0, n - 2], so that base + 1 exists and the lookup has no branches.
// In three dimensions the weights multiply: f = sum_xyz wx wy wz v[x, y, z], hence
//   df/dv[x, y, z] = wx wy wz,     df/dq_x = sum slope_x wy wz v, ...
#pragma once

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

enum class Border : int { clamp = 0, zero = 1 };

template <class R>
struct AxisWeights {
    int base;
    R w0, w1;  // weights of voxels base and base + 1
    R s0, s1;  // their derivatives with respect to q
};

template <class R>
inline AxisWeights<R> axis_weights(R q, int n, Border border) {
    const R last = R(n - 1);
    const R inside = clamped(q, R(0), last);
    const int base = smaller(to_int(inside), n - 2);
    const R fraction = inside - R(base);
    const bool before = q<R(0), behind = q> last, fades = border == Border::zero;
    // Written as selections, not branches, so that a loop over samples turns into lanes.
    // zero: in front of the grid our base, voxel 0, keeps 1 + q; behind it voxel n - 1 keeps n - q.
    const R w0_before = fades ? larger(R(1) + q, R(0)) : R(1);
    const R w1_behind = fades ? larger(last + R(1) - q, R(0)) : R(1);
    const R s0_before = fades && q > R(-1) ? R(1) : R(0);
    const R s1_behind = fades && q < last + R(1) ? R(-1) : R(0);
    return {base, before ? w0_before : R(1) - fraction, behind ? w1_behind : fraction,
            before ? s0_before : (behind ? R(0) : R(-1)),
            behind ? s1_behind : (before ? R(0) : R(1))};
}

struct GridShape {
    int x, y, z;

    /// Index of voxel (i, j, k) in C order.
    [[nodiscard]] long long index(int i, int j, int k) const {
        return (static_cast<long long>(i) * y + j) * z + k;
    }
    [[nodiscard]] long long size() const { return static_cast<long long>(x) * y * z; }
};

/// out[c] = interpolated value of channel c; values (X, Y, Z, C). The four rows (x, y) are summed
/// in the order 00 01 10 11, then the two z ends are blended: the order that the vector kernel
/// follows.
template <class R, int C>
inline void trilinear(const R* values, const GridShape& shape, const AxisWeights<R>& ax,
                      const AxisWeights<R>& ay, const AxisWeights<R>& az, R* out) {
    const R* row = values + shape.index(ax.base, ay.base, az.base) * C;
    const long long to_y = static_cast<long long>(shape.z) * C;
    const long long to_x = static_cast<long long>(shape.y) * to_y;
    const R w00 = ax.w0 * ay.w0, w01 = ax.w0 * ay.w1, w10 = ax.w1 * ay.w0, w11 = ax.w1 * ay.w1;
    for (int c = 0; c < C; ++c) {
        R end[2];
        for (int k = 0; k < 2; ++k) {
            const R* v = row + k * C + c;
            end[k] = ((w00 * v[0] + w01 * v[to_y]) + w10 * v[to_x]) + w11 * v[to_x + to_y];
        }
        out[c] = end[0] * az.w0 + end[1] * az.w1;
    }
}

/// d_values[corner] += d_out * weight, for a buffer laid out like `values`.
template <class R, int C>
inline void trilinear_backward(const GridShape& shape, const AxisWeights<R>& ax,
                               const AxisWeights<R>& ay, const AxisWeights<R>& az, const R* d_out,
                               R* d_values) {
    R* row = d_values + shape.index(ax.base, ay.base, az.base) * C;
    const long long to_y = static_cast<long long>(shape.z) * C;
    const long long to_x = static_cast<long long>(shape.y) * to_y;
    const R w[4] = {ax.w0 * ay.w0, ax.w0 * ay.w1, ax.w1 * ay.w0, ax.w1 * ay.w1};
    const long long offset[4] = {0, to_y, to_x, to_x + to_y};
    for (int c = 0; c < C; ++c) {
        const R ends[2] = {d_out[c] * az.w0, d_out[c] * az.w1};
        for (int r = 0; r < 4; ++r) {
            row[offset[r] + c] += w[r] * ends[0];
            row[offset[r] + C + c] += w[r] * ends[1];
        }
    }
}

/// d_q[axis] += <d_out, d out / d q_axis>: the adjoint of the position, for camera gradients.
template <class R, int C>
inline void trilinear_position_backward(const R* values, const GridShape& shape,
                                        const AxisWeights<R>& ax, const AxisWeights<R>& ay,
                                        const AxisWeights<R>& az, const R* d_out, R* d_q) {
    const AxisWeights<R> slope_x{ax.base, ax.s0, ax.s1, R(0), R(0)};
    const AxisWeights<R> slope_y{ay.base, ay.s0, ay.s1, R(0), R(0)};
    const AxisWeights<R> slope_z{az.base, az.s0, az.s1, R(0), R(0)};
    R dx[C], dy[C], dz[C];
    trilinear<R, C>(values, shape, slope_x, ay, az, dx);
    trilinear<R, C>(values, shape, ax, slope_y, az, dy);
    trilinear<R, C>(values, shape, ax, ay, slope_z, dz);
    for (int c = 0; c < C; ++c) {
        d_q[0] += d_out[c] * dx[c];
        d_q[1] += d_out[c] * dy[c];
        d_q[2] += d_out[c] * dz[c];
    }
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
