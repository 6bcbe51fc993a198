// Signed distances from a point to the surfaces of simple shapes, negative inside [Hart1996].
//
// Each shape stands at the origin of its own frame. A distance has a gradient of length 1, straight
// away from the nearest point of the surface, except where two points are equally near; there, one
// of their gradients, or zero, is returned.
//
//   sphere   f = |p| - r                              df/dp = p / |p|      df/dr = -1
//   plane    f = <n, p> - h,  n = N / |N|             df/dp = n            df/dh = -1
//                                                     df/dN = (p - n <n, p>) / |N|
//   torus    q = (|(x, z)| - R, y),  f = |q| - r      df/dq = q / |q|      df/dR = -q_0 / |q|
//   box      q_i = |p_i| - h_i
//            outside  f = |max(q, 0)|                 df/dq = max(q, 0) / f
//            inside   f = max_i q_i                   df/dq = 1 for the largest;  df/dh = -df/dq
//   capsule  q = p - (0, clamp(y, -h, h), 0),         df/dp = q / |q|      df/dh = -|q_y| / |q|
//            f = |q| - r                              df/dr = -1
//            (p - q is the nearest point of the axis: moving it along the axis changes nothing)
#pragma once

#include "photograd/core/vec.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// v / |v|; zero for the zero vector.
template <class R>
inline Vec3<R> unit_or_zero(const Vec3<R>& v) {
    const R size = length(v);
    return size > R(0) ? v * (R(1) / size) : Vec3<R>(R(0));
}

template <class R>
inline R sdf_sphere(const Vec3<R>& p, R radius) {
    return length(p) - radius;
}
template <class R>
inline void sdf_sphere_backward(const Vec3<R>& p, R d_f, Vec3<R>& d_p, R& d_radius) {
    d_p += d_f * unit_or_zero(p);
    d_radius -= d_f;
}

/// The half space below: `normal` of any length but zero points out of it.
template <class R>
inline R sdf_plane(const Vec3<R>& p, const Vec3<R>& normal, R height) {
    return dot(normal, p) / length(normal) - height;
}
template <class R>
inline void sdf_plane_backward(const Vec3<R>& p, const Vec3<R>& normal, R d_f, Vec3<R>& d_p,
                               Vec3<R>& d_normal, R& d_height) {
    const Vec3<R> n = unit_or_zero(normal);
    d_p += d_f * n;
    d_normal += (d_f / length(normal)) * (p - n * dot(n, p));
    d_height -= d_f;
}

/// A ring around the Y axis: a tube of radius `tube` whose middle runs at the distance `ring`.
template <class R>
inline R sdf_torus(const Vec3<R>& p, R ring, R tube) {
    const R across = sqrt(p.x * p.x + p.z * p.z) - ring;
    return sqrt(across * across + p.y * p.y) - tube;
}
template <class R>
inline void sdf_torus_backward(const Vec3<R>& p, R ring, R d_f, Vec3<R>& d_p, R& d_ring,
                               R& d_tube) {
    const Vec3<R> outwards = unit_or_zero(Vec3<R>(p.x, R(0), p.z));
    const R across = sqrt(p.x * p.x + p.z * p.z) - ring;
    const Vec3<R> q = unit_or_zero(Vec3<R>(across, p.y, R(0)));
    d_p += d_f * (q.x * outwards + Vec3<R>(R(0), q.y, R(0)));
    d_ring -= d_f * q.x;
    d_tube -= d_f;
}

/// df/dq of the box, and with it the value.
template <class R>
inline R sdf_box_slope(const Vec3<R>& p, const Vec3<R>& half, Vec3<R>& slope) {
    Vec3<R> q, beyond;
    int largest = 0;
    for (int k = 0; k < 3; ++k) {
        q[k] = (p[k] < R(0) ? -p[k] : p[k]) - half[k];
        beyond[k] = q[k] > R(0) ? q[k] : R(0);
        if (q[k] > q[largest]) largest = k;
    }
    if (q[largest] > R(0)) {
        slope = unit_or_zero(beyond);
        return length(beyond);
    }
    slope = Vec3<R>(R(0));
    slope[largest] = R(1);
    return q[largest];
}

/// Half sizes along X, Y, Z.
template <class R>
inline R sdf_box(const Vec3<R>& p, const Vec3<R>& half) {
    Vec3<R> slope;
    return sdf_box_slope(p, half, slope);
}
template <class R>
inline void sdf_box_backward(const Vec3<R>& p, const Vec3<R>& half, R d_f, Vec3<R>& d_p,
                             Vec3<R>& d_half) {
    Vec3<R> slope;
    sdf_box_slope(p, half, slope);
    for (int k = 0; k < 3; ++k) d_p[k] += d_f * (p[k] < R(0) ? -slope[k] : slope[k]);
    d_half -= d_f * slope;
}

/// From p to the middle line of a capsule: all points within `half` of the origin on the Y axis.
template <class R>
inline Vec3<R> beside_capsule(const Vec3<R>& p, R half) {
    const R beyond = (p.y < R(0) ? -p.y : p.y) - half;
    const R y = beyond > R(0) ? beyond : R(0);
    return {p.x, p.y < R(0) ? -y : y, p.z};
}

/// A rod along the Y axis with round ends: everything within `radius` of its middle line.
template <class R>
inline R sdf_capsule(const Vec3<R>& p, R half, R radius) {
    return length(beside_capsule(p, half)) - radius;
}
template <class R>
inline void sdf_capsule_backward(const Vec3<R>& p, R half, R d_f, Vec3<R>& d_p, R& d_half,
                                 R& d_radius) {
    const Vec3<R> q = unit_or_zero(beside_capsule(p, half));
    d_p += d_f * q;
    d_half -= d_f * (q.y < R(0) ? -q.y : q.y);
    d_radius -= d_f;
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
