// The covariance of a 3D Gaussian from a quaternion and three log-scales [Kerbl2023, Eq. 6].
//
// With the rotation R(q / |q|) of ops/quaternion.h, s = exp(log_scale) and M = R diag(s):
//
//   cov = M M^T, six numbers xx, xy, xz, yy, yz, zz         positive semidefinite by construction
//
// Adjoint: an off-diagonal number stands for two equal entries of the matrix, so the matrix of
// derivatives G has G_ii = d_cov_ii and G_ij = G_ji = d_cov_ij / 2.
//
//   dM        = 2 G M                  since d(M M^T) = dM M^T + M dM^T, and G is symmetric
//   d_log_s_j = sum_i dM_ij M_ij       since dM_ij/dlog_s_j = M_ij
//   dR_ij     = dM_ij s_j
#pragma once

#include "photograd/ops/quaternion.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

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
