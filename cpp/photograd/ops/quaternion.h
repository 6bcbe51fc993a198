// Rotations from quaternions of any length, and the adjoint.
//
// With n = q / |q| = (w, x, y, z), R(n) turns counterclockwise, seen against the axis. Dividing by
// |q| is part of the function, so that an optimizer may move q freely; q and -q give the same
// rotation.
//
//   dn from dR by R's formula,   dq = (dn - n <n, dn>) / |q|      no part along q
//
// A zero quaternion has no direction: it stands for no rotation, with derivative zero.
#pragma once

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// n = q / |q| and 1 / |q|; (1, 0, 0, 0) and 0 for the zero quaternion.
template <class R>
struct UnitQuaternion {
    R n[4];
    R inverse_length;

    static UnitQuaternion of(const R* q) {
        // Divided by the largest entry first, so that squares neither overflow nor vanish.
        R largest = R(0);
        for (int i = 0; i < 4; ++i) largest = larger(largest, larger(q[i], -q[i]));
        if (!(largest > R(0))) return {{R(1), R(0), R(0), R(0)}, R(0)};
        R scaled[4], square = R(0);
        for (int i = 0; i < 4; ++i) {
            scaled[i] = q[i] / largest;
            square += scaled[i] * scaled[i];
        }
        const R length = sqrt(square);
        UnitQuaternion out;
        for (int i = 0; i < 4; ++i) out.n[i] = scaled[i] / length;
        out.inverse_length = R(1) / (length * largest);
        return out;
    }
};

/// R(n), row by row.
template <class R>
inline void rotation_matrix(const R* n, R (&r)[3][3]) {
    const R w = n[0], x = n[1], y = n[2], z = n[3], two = R(2);
    r[0][0] = R(1) - two * (y * y + z * z);
    r[0][1] = two * (x * y - w * z);
    r[0][2] = two * (x * z + w * y);
    r[1][0] = two * (x * y + w * z);
    r[1][1] = R(1) - two * (x * x + z * z);
    r[1][2] = two * (y * z - w * x);
    r[2][0] = two * (x * z - w * y);
    r[2][1] = two * (y * z + w * x);
    r[2][2] = R(1) - two * (x * x + y * y);
}
/// Adds dL/dn to d_n[4]. Each line collects where its letter stands above.
template <class R>
inline void rotation_matrix_backward(const R* n, const R (&g)[3][3], R* d_n) {
    const R w = n[0], x = n[1], y = n[2], z = n[3], two = R(2);
    d_n[0] += two * (z * (g[1][0] - g[0][1]) + y * (g[0][2] - g[2][0]) + x * (g[2][1] - g[1][2]));
    d_n[1] += two * (y * (g[0][1] + g[1][0]) + z * (g[0][2] + g[2][0]) + w * (g[2][1] - g[1][2]) -
                     two * x * (g[1][1] + g[2][2]));
    d_n[2] += two * (x * (g[0][1] + g[1][0]) + z * (g[1][2] + g[2][1]) + w * (g[0][2] - g[2][0]) -
                     two * y * (g[0][0] + g[2][2]));
    d_n[3] += two * (x * (g[0][2] + g[2][0]) + y * (g[1][2] + g[2][1]) + w * (g[1][0] - g[0][1]) -
                     two * z * (g[0][0] + g[1][1]));
}

/// For R(q / |q|): adds dL/dq to d_quat[4].
template <class R>
inline void rotation_of_quaternion_backward(const UnitQuaternion<R>& q, const R (&d_r)[3][3],
                                            R* d_quat) {
    const R* n = q.n;
    R d_n[4] = {R(0), R(0), R(0), R(0)};
    rotation_matrix_backward(n, d_r, d_n);
    const R along = n[0] * d_n[0] + n[1] * d_n[1] + n[2] * d_n[2] + n[3] * d_n[3];
    for (int i = 0; i < 4; ++i) d_quat[i] += (d_n[i] - n[i] * along) * q.inverse_length;
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
