// The covariance of a 3D Gaussian from a quaternion and three log-scales [Kerbl2023, Eq. 6].
//
// With n = q / |q| = (w, x, y, z), the rotation R(n), s = exp(log_scale) and M = R diag(s):
//
//   cov = M M^T, six numbers xx, xy, xz, yy, yz, zz         positive semidefinite by construction
//
// q need not have unit length: dividing by |q| is part of the function, so that an optimiser may move
// q freely, and q and -q are the same Gaussian. Adjoint: an off-diagonal number stands for two equal
// entries of the matrix, so the matrix of derivatives G has G_ii = d_cov_ii and G_ij = G_ji = d_cov_ij / 2.
//
//   dM        = 2 G M                  since d(M M^T) = dM M^T + M dM^T, and G is symmetric
//   d_log_s_j = sum_i dM_ij M_ij       since dM_ij/dlog_s_j = M_ij
//   dR_ij     = dM_ij s_j,  dn from dR by R's formula
//   dq        = (dn - n <n, dn>) / |q|      the part along q changes nothing: it must vanish
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

/// The same for R(q / |q|): adds dL/dq to d_quat[4].
template <class R>
inline void rotation_of_quaternion_backward(const UnitQuaternion<R>& q, const R (&d_r)[3][3],
                                            R* d_quat) {
    const R* n = q.n;
    R d_n[4] = {R(0), R(0), R(0), R(0)};
    rotation_matrix_backward(n, d_r, d_n);
    const R along = n[0] * d_n[0] + n[1] * d_n[1] + n[2] * d_n[2] + n[3] * d_n[3];
    for (int i = 0; i < 4; ++i) d_quat[i] += (d_n[i] - n[i] * along) * q.inverse_length;
}

/// The axes of a Gaussian, as long as its standard deviations.
template <class R>
struct GaussianAxes {
    UnitQuaternion<R> q;
    R s[3];     // exp(log_scale)
    R m[3][3];  // R(n) diag(s)

    static GaussianAxes of(const R* quat, const R* log_scale) {
        GaussianAxes out;
        out.q = UnitQuaternion<R>::of(quat);
        rotation_matrix(out.q.n, out.m);
        for (int j = 0; j < 3; ++j) {
            out.s[j] = exp(log_scale[j]);
            for (int i = 0; i < 3; ++i) out.m[i][j] *= out.s[j];
        }
        return out;
    }
};

/// cov[6] = xx, xy, xz, yy, yz, zz of M M^T.
template <class R>
inline void covariance(const GaussianAxes<R>& axes, R* cov) {
    const auto& m = axes.m;
    for (int i = 0, k = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j, ++k)
            cov[k] = m[i][0] * m[j][0] + m[i][1] * m[j][1] + m[i][2] * m[j][2];
}
template <class R>
inline void covariance_backward(const GaussianAxes<R>& axes, const R* d_cov, R* d_quat,
                                R* d_log_scale) {
    const auto& m = axes.m;
    const R g[3][3] = {{R(2) * d_cov[0], d_cov[1], d_cov[2]},
                       {d_cov[1], R(2) * d_cov[3], d_cov[4]},
                       {d_cov[2], d_cov[4], R(2) * d_cov[5]}};  // 2 G
    R d_r[3][3];
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            const R d_m = g[i][0] * m[0][j] + g[i][1] * m[1][j] + g[i][2] * m[2][j];
            d_log_scale[j] += d_m * m[i][j];
            d_r[i][j] = d_m * axes.s[j];
        }
    }
    rotation_of_quaternion_backward(axes.q, d_r, d_quat);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
