// A 3D Gaussian seen through a pinhole: mean and covariance on the screen, in pixels [Zwicker2001].
//
// The view [W | b] = camera_from_world takes a point p to t = W p + b (+X right, +Y down, +Z
// forward):
//
//   mean2d = (fx u + cx, fy v + cy)  with u = t_x / t_z, v = t_y / t_z;      depth = t_z
//   cov2d  = A cov A^T, three numbers xx, xy, yy, with A = J W and the projection's Jacobian
//            J = [ fx / t_z   0          -fx u' / t_z ]
//                [ 0          fy / t_z   -fy v' / t_z ]
//
// u' is u held inside of `limit_u`, the field of view plus a margin [Kerbl2023]: the linear
// approximation explodes for points that are far off the screen. mean2d is not held.
//
// Adjoint. G is the symmetric matrix with G_xx = d_cov2d_xx, G_xy = d_cov2d_xy / 2, G_yy =
// d_cov2d_yy:
//
//   d_cov = A^T G A, an off-diagonal number once for each of its two entries
//   dA    = 2 G A cov,   dJ = dA W^T,   dW = J^T dA + dt p^T,   db = dt,   dp = W^T dt
//   J_xx  = fx / t_z:       dt_z -= dJ_xx J_xx / t_z
//   J_xz  = -fx u' / t_z:   du'  -= dJ_xz fx / t_z,   dt_z -= dJ_xz J_xz / t_z
//   u = t_x / t_z:          dt_x += du / t_z,         dt_z -= du u / t_z
//
// and likewise in y. Where u is held, du' ends there: only the 1 / t_z of J_xz is left. (Formulas
// that substitute t_x = u' t_z and differentiate as if t_x moved get dt_z wrong by that term.)
#pragma once

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// The pinhole of the projection; limits in units of t_x / t_z.
template <class R>
struct SplatLens {
    R fx, fy, cx, cy;
    R limit_u[2], limit_v[2];
};

/// W, b as twelve numbers, row by row: (W_00 W_01 W_02 b_0 W_10 ...).
template <class R>
struct SplatProjection {
    R t[3], u, v, held_u, held_v;
    R mean2d[2];
    R a[2][3];   // A
    R cov2d[3];  // xx, xy, yy; without low-pass
};

template <class R>
inline void view_point(const R* view, const R* mean, R* t) {
    for (int i = 0; i < 3; ++i) {
        const R* w = view + 4 * i;
        t[i] = ((w[0] * mean[0] + w[1] * mean[1]) + w[2] * mean[2]) + w[3];
    }
}

/// A cov for a cov of six numbers.
template <class R>
inline void times_covariance(const R (&a)[2][3], const R* cov, R (&out)[2][3]) {
    for (int i = 0; i < 2; ++i) {
        out[i][0] = a[i][0] * cov[0] + a[i][1] * cov[1] + a[i][2] * cov[2];
        out[i][1] = a[i][0] * cov[1] + a[i][1] * cov[3] + a[i][2] * cov[4];
        out[i][2] = a[i][0] * cov[2] + a[i][1] * cov[4] + a[i][2] * cov[5];
    }
}

/// The mean must lie in front of the camera: t_z > 0.
template <class R>
inline SplatProjection<R> project_gaussian(const SplatLens<R>& lens, const R* view, const R* mean,
                                           const R* cov) {
    SplatProjection<R> p;
    view_point(view, mean, p.t);
    const R iz = R(1) / p.t[2];
    p.u = p.t[0] * iz;
    p.v = p.t[1] * iz;
    p.mean2d[0] = lens.fx * p.u + lens.cx;
    p.mean2d[1] = lens.fy * p.v + lens.cy;
    p.held_u = clamped(p.u, lens.limit_u[0], lens.limit_u[1]);
    p.held_v = clamped(p.v, lens.limit_v[0], lens.limit_v[1]);
    const R jx = lens.fx * iz, jy = lens.fy * iz;
    for (int k = 0; k < 3; ++k) {
        p.a[0][k] = jx * (view[k] - p.held_u * view[8 + k]);
        p.a[1][k] = jy * (view[4 + k] - p.held_v * view[8 + k]);
    }
    R b[2][3];
    times_covariance(p.a, cov, b);
    p.cov2d[0] = b[0][0] * p.a[0][0] + b[0][1] * p.a[0][1] + b[0][2] * p.a[0][2];
    p.cov2d[1] = b[0][0] * p.a[1][0] + b[0][1] * p.a[1][1] + b[0][2] * p.a[1][2];
    p.cov2d[2] = b[1][0] * p.a[1][0] + b[1][1] * p.a[1][1] + b[1][2] * p.a[1][2];
    return p;
}

/// d_cov[6] += A^T G A.
template <class R>
inline void projected_covariance_backward(const R (&a)[2][3], const R* d_cov2d, R* d_cov) {
    for (int i = 0, k = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j, ++k) {
            const R once = d_cov2d[0] * a[0][i] * a[0][j] + d_cov2d[2] * a[1][i] * a[1][j] +
                           R(0.5) * d_cov2d[1] * (a[0][i] * a[1][j] + a[1][i] * a[0][j]);
            d_cov[k] += i == j ? once : R(2) * once;
        }
    }
}

/// Adds to d_mean[3], d_cov[6] and d_view[12].
template <class R>
inline void project_gaussian_backward(const SplatLens<R>& lens, const R* view, const R* mean,
                                      const R* cov, const SplatProjection<R>& p, const R* d_mean2d,
                                      R d_depth, const R* d_cov2d, R* d_mean, R* d_cov, R* d_view) {
    projected_covariance_backward(p.a, d_cov2d, d_cov);
    R b[2][3], d_a[2][3];
    times_covariance(p.a, cov, b);
    for (int k = 0; k < 3; ++k) {
        d_a[0][k] = R(2) * d_cov2d[0] * b[0][k] + d_cov2d[1] * b[1][k];
        d_a[1][k] = d_cov2d[1] * b[0][k] + R(2) * d_cov2d[2] * b[1][k];
    }
    // Of J W, whose rows are J_xx W_0 + J_xz W_2 and J_yy W_1 + J_yz W_2.
    const R iz = R(1) / p.t[2];
    const R jx = lens.fx * iz, jy = lens.fy * iz, jxz = -(jx * p.held_u), jyz = -(jy * p.held_v);
    R d_jx = R(0), d_jxz = R(0), d_jy = R(0), d_jyz = R(0);
    for (int k = 0; k < 3; ++k) {
        d_jx += d_a[0][k] * view[k];
        d_jxz += d_a[0][k] * view[8 + k];
        d_jy += d_a[1][k] * view[4 + k];
        d_jyz += d_a[1][k] * view[8 + k];
        d_view[k] += jx * d_a[0][k];
        d_view[4 + k] += jy * d_a[1][k];
        d_view[8 + k] += jxz * d_a[0][k] + jyz * d_a[1][k];
    }
    R d_u = lens.fx * d_mean2d[0], d_v = lens.fy * d_mean2d[1];
    if (p.held_u == p.u) d_u -= d_jxz * jx;
    if (p.held_v == p.v) d_v -= d_jyz * jy;
    const R d_t[3] = {d_u * iz, d_v * iz,
                      d_depth - (((d_u * p.u + d_v * p.v) + (d_jx * jx + d_jxz * jxz)) +
                                 (d_jy * jy + d_jyz * jyz)) *
                                    iz};
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            d_mean[k] += d_t[i] * view[4 * i + k];
            d_view[4 * i + k] += d_t[i] * mean[k];
        }
        d_view[4 * i + 3] += d_t[i];
    }
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
