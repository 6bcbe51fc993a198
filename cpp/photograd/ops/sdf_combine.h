// Signed distances of shapes that are moved, and of two shapes blended into one [Hart1996].
//
// The union of two shapes is as far away as the nearer one, min(a, b); their intersection is max(a,
// b), and a without b is max(a, -b). All three keep the slope at or below 1, so that a distance is
// never overstated.
//
// A smooth union rounds the seam, within k meters of it, by a parabola that meets both sides with
// their slope:
//
//   h = max(0, 1 - |a - b| / k)        f = min(a, b) - k h^2 / 4
//
//   df/da = h / 2 where a > b, 1 - h / 2 where a < b;   dh/da = -sign(a - b) / k
//   df/db is the other one
//   df/dk = -h^2 / 4 - h (1 - h) / 2      since dh/dk = (1 - h) / k
//
// The two slopes lie between 0 and 1 and add up to 1: what was 1-Lipschitz stays so.
//
// A shape turned by R and then moved by s is asked at p' = R^T (p - s):
//
//   dL/dp = R dL/dp'     dL/ds = -R dL/dp'     dL/dR_ij = (p - s)_i dL/dp'_j
#pragma once

#include "photograd/core/vec.h"
#include "photograd/ops/quaternion.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// h above: 0 where the shapes do not feel each other.
template <class R>
inline R seam(R a, R b, R k) {
    const R h = R(1) - (a > b ? a - b : b - a) / k;
    return h > R(0) ? h : R(0);
}

template <class R>
inline R smooth_union(R a, R b, R k) {
    const R h = seam(a, b, k);
    return (a < b ? a : b) - R(0.25) * k * h * h;
}
template <class R>
inline void smooth_union_backward(R a, R b, R k, R d_f, R& d_a, R& d_b, R& d_k) {
    const R h = seam(a, b, k), less = R(0.5) * h, more = R(1) - less;
    d_a += d_f * (a < b ? more : less);
    d_b += d_f * (a < b ? less : more);
    d_k -= d_f * (R(0.25) * h * h + less * (R(1) - h));
}

/// The point in the frame of a shape that was turned by `quat` (w, x, y, z), then moved by `shift`.
template <class R>
inline Vec3<R> to_shape(const Vec3<R>& p, const R* quat, const Vec3<R>& shift) {
    R r[3][3];
    rotation_matrix(UnitQuaternion<R>::of(quat).n, r);
    const Vec3<R> q = p - shift;
    Vec3<R> out;
    for (int j = 0; j < 3; ++j) out[j] = r[0][j] * q.x + r[1][j] * q.y + r[2][j] * q.z;
    return out;
}
template <class R>
inline void to_shape_backward(const Vec3<R>& p, const R* quat, const Vec3<R>& shift,
                              const Vec3<R>& d_out, Vec3<R>& d_p, R* d_quat, Vec3<R>& d_shift) {
    const UnitQuaternion<R> unit = UnitQuaternion<R>::of(quat);
    R r[3][3], d_r[3][3];
    rotation_matrix(unit.n, r);
    for (int i = 0; i < 3; ++i) {
        R turned = R(0);
        for (int j = 0; j < 3; ++j) {
            turned += r[i][j] * d_out[j];
            d_r[i][j] = (p[i] - shift[i]) * d_out[j];
        }
        d_p[i] += turned;
        d_shift[i] -= turned;
    }
    rotation_of_quaternion_backward(unit, d_r, d_quat);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
