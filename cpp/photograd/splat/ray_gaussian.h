// The peak of a 3D Gaussian along a ray [MoenneLoccoz2024].
//
// The whitening W = diag(1/s) R^T makes a Gaussian with rotation R and standard deviations s a unit
// ball. A ray o + t d becomes a + t b there, and the Gaussian is largest where the ray is nearest
// to the center:
//
//   a = W (o - mean),   b = W d,   u = b / |b|
//   t = -<a, u> / |b|,   p = a + t b = u x (a x u),   q = |p|^2,   largest value exp(-q / 2)
//
// q is the smallest value of (x - mean)^T cov^-1 (x - mean) on the line. p is not computed as a + t
// b: of a Gaussian as flat as paper both terms are huge and nearly cancel, while the cross products
// keep their digits.
//
// Adjoint. p is orthogonal to u, and moving the nearest point along the ray changes q in second
// order only:
//
//   dq/da = 2 p,           dq/db = 2 t p
//   dt/da = -u / |b|,      dt/db = -(p / |b| + t u) / |b|
//
// The ray's share follows from a and b being linear: d_o = W^T d_a, d_d = W^T d_b. The Gaussian's:
// d_mean = -W^T d_a, and for W itself ask what a small strain, W to (I + E) W, does. d_strain = d_a
// a^T + d_b b^T, and with the above
//
//   d_strain = 2 d_q p p^T - (d_t / |b|) (u p^T + p u^T)
//
// It is symmetric, as it must be: turning the unit ball, E antisymmetric, changes nothing. It takes
// six numbers, which rays add up, and which become derivatives of rotation and scales once a
// Gaussian. From dW = -diag(dlog_s) W + diag(1/s) dR^T, E = dW W^-1 and M = R diag(s) = W^-1:
//
//   d_log_s_i = -d_strain_ii,      dR_ki = (1/s_i) sum_j M_kj d_strain_ij
#pragma once

#include "photograd/splat/covariance.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

template <class R>
struct RayGaussian {
    R mean[3];
    R w[3][3];  // W

    static RayGaussian of(const R* mean, const GaussianAxes<R>& axes) {
        RayGaussian out;
        R r[3][3];
        rotation_matrix(axes.q.n, r);
        for (int i = 0; i < 3; ++i) {
            out.mean[i] = mean[i];
            for (int j = 0; j < 3; ++j) out.w[i][j] = r[j][i] / axes.s[i];
        }
        return out;
    }
};

/// The nearest pass of a ray.
template <class R>
struct RayPeak {
    R u[3];     // the ray's direction, whitened, of unit length
    R p[3];     // the nearest point, whitened
    R inverse;  // 1 / |W d|
    R q;
    R t;  // in lengths of d
};

template <class R>
inline void cross_product(const R* x, const R* y, R* out) {
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = x[j] * y[k] - x[k] * y[j];
    }
}

/// The ray must have a direction.
template <class R>
inline RayPeak<R> ray_peak(const RayGaussian<R>& g, const R* origin, const R* direction) {
    RayPeak<R> out;
    R a[3], c[3], square = R(0);
    for (int i = 0; i < 3; ++i) {
        const R* w = g.w[i];
        a[i] = w[0] * (origin[0] - g.mean[0]) + w[1] * (origin[1] - g.mean[1]) +
               w[2] * (origin[2] - g.mean[2]);
        out.u[i] = w[0] * direction[0] + w[1] * direction[1] + w[2] * direction[2];
        square += out.u[i] * out.u[i];
    }
    out.inverse = R(1) / sqrt(square);
    for (int i = 0; i < 3; ++i) out.u[i] *= out.inverse;
    cross_product(a, out.u, c);
    cross_product(out.u, c, out.p);
    out.q = out.p[0] * out.p[0] + out.p[1] * out.p[1] + out.p[2] * out.p[2];
    out.t = -((a[0] * out.u[0] + a[1] * out.u[1] + a[2] * out.u[2]) * out.inverse);
    return out;
}
/// The ray's share: adds to d_origin[3] and d_direction[3].
template <class R>
inline void ray_peak_backward_ray(const RayGaussian<R>& g, const RayPeak<R>& peak, R d_q, R d_t,
                                  R* d_origin, R* d_direction) {
    const R two_q = R(2) * d_q, along = d_t * peak.inverse;
    for (int i = 0; i < 3; ++i) {
        const R d_a = two_q * peak.p[i] - along * peak.u[i];
        const R d_b =
            two_q * (peak.t * peak.p[i]) - along * (peak.inverse * peak.p[i] + peak.t * peak.u[i]);
        for (int j = 0; j < 3; ++j) {
            d_origin[j] += g.w[i][j] * d_a;
            d_direction[j] += g.w[i][j] * d_b;
        }
    }
}
/// The Gaussian's share: adds to d_mean[3] and d_strain[6] = xx, xy, xz, yy, yz, zz. `Sum` may be
/// wider than R.
template <class R, class Sum>
inline void ray_peak_backward_gaussian(const RayGaussian<R>& g, const RayPeak<R>& peak, R d_q,
                                       R d_t, Sum* d_mean, Sum* d_strain) {
    const R two_q = R(2) * d_q, along = d_t * peak.inverse;
    const R *p = peak.p, *u = peak.u;
    for (int i = 0, k = 0; i < 3; ++i) {
        const R d_a = two_q * p[i] - along * u[i];
        for (int j = 0; j < 3; ++j) d_mean[j] -= Sum(g.w[i][j] * d_a);
        for (int j = i; j < 3; ++j, ++k)
            d_strain[k] += Sum(two_q * (p[i] * p[j]) - along * (u[i] * p[j] + p[i] * u[j]));
    }
}

/// From the strain to what makes the shape: adds to d_quat[4] and d_log_scale[3].
template <class R>
inline void strain_backward(const GaussianAxes<R>& axes, const R* d_strain, R* d_quat,
                            R* d_log_scale) {
    const R e[3][3] = {{d_strain[0], d_strain[1], d_strain[2]},
                       {d_strain[1], d_strain[3], d_strain[4]},
                       {d_strain[2], d_strain[4], d_strain[5]}};
    R d_r[3][3];
    for (int i = 0; i < 3; ++i) {
        d_log_scale[i] -= e[i][i];
        for (int k = 0; k < 3; ++k)
            d_r[k][i] = (axes.m[k][0] * e[i][0] + axes.m[k][1] * e[i][1] + axes.m[k][2] * e[i][2]) /
                        axes.s[i];
    }
    rotation_of_quaternion_backward(axes.q, d_r, d_quat);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
