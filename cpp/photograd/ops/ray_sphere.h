// Where a ray o + t d meets a sphere of center c and radius r > 0. d has any length but zero.
//
// m is where the ray passes nearest to the center, h half of its chord, both as multiples of d:
//
//   m = <c - o, d> / |d|^2      p = c - o - m d      h^2 = (r^2 - |p|^2) / |d|^2      t = m -+ h
//
// p, from the ray to the center, is subtracted before it is squared [Haines2019]. The discriminant
// of the quadratic in t is a difference of squares of the distance; in float nothing is left of
// r^2.
//
// Of the point x = o + t d and its outward unit normal n = (x - c) / r, implicit differentiation of
// |o + t d - c|^2 = r^2 gives <n, dx - dc> = dr, and so
//
//   dt = (dr - <n, do + t dd - dc>) / <n, d>
//   dx = do + t dd + dt d
//   dn = (dx - dc - n dr) / r
//
// With g = d_x + d_n / r, the cotangent of x at a fixed t, and k = (d_t + <g, d>) / <n, d>:
//
//   d_o = g - k n      d_d = t d_o      d_c = k n - d_n / r      d_r = k - <n, d_n> / r
//
// <n, d> = -+h |d|^2 / r: the derivatives grow without bound as h -> 0, and a ray that touches the
// sphere has none. x - c = -+h d - p and <n, d> come from h, which t may have rounded away. Which
// of the two points is met, and whether one is, is held constant.
#pragma once

#include <optional>

#include "photograd/core/ray.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// The normal points out of the sphere, whichever side the ray came from.
template <class R>
struct SpherePoint {
    R t;
    Vec3<R> position, normal;

    /// `from_center` is x - c to rounding. The position is taken from the center: its error does
    /// not grow with t as that of o + t d.
    static SpherePoint of(R t, const Vec3<R>& center, R radius, const Vec3<R>& from_center) {
        const Vec3<R> normal = normalize(from_center);
        return {t, center + radius * normal, normal};
    }
};

/// m, h^2 and p. h^2 is not positive for a ray that misses or touches.
template <class R>
struct SphereChord {
    R middle, half_squared;
    Vec3<R> to_center;

    /// `square` is |d|^2: exactly 1 for a direction that is known to have unit length.
    static SphereChord of(const Ray<R>& ray, const Vec3<R>& center, R radius, R square) {
        const Vec3<R> co = center - ray.origin;
        const R middle = dot(co, ray.direction) / square;
        const Vec3<R> p = co - middle * ray.direction;
        return {middle, (radius * radius - dot(p, p)) / square, p};
    }
};

/// The nearest point beyond t_min: of a ray from inside, that where it leaves. Nothing for a ray
/// that touches, which has no derivative.
template <class R>
std::optional<SpherePoint<R>> ray_sphere(const Ray<R>& ray, const Vec3<R>& center, R radius,
                                         R t_min) {
    const R square = dot(ray.direction, ray.direction);
    const SphereChord<R> chord = SphereChord<R>::of(ray, center, radius, square);
    if (!(chord.half_squared > R(0))) return {};
    const R size = sqrt(chord.half_squared);
    const R half = chord.middle - size > t_min ? -size : size, t = chord.middle + half;
    if (!(t > t_min)) return {};
    return SpherePoint<R>::of(t, center, radius, half * ray.direction - chord.to_center);
}
/// `point` is what ray_sphere found; d_point holds d_t, d_position and d_normal.
template <class R>
void ray_sphere_backward(const Ray<R>& ray, const Vec3<R>& center, R radius,
                         const SpherePoint<R>& point, const SpherePoint<R>& d_point, Ray<R>& d_ray,
                         Vec3<R>& d_center, R& d_radius) {
    const R square = dot(ray.direction, ray.direction);
    const SphereChord<R> chord = SphereChord<R>::of(ray, center, radius, square);
    const R half = sqrt(chord.half_squared);
    const R n_dot_d = (point.t > chord.middle ? half : -half) * square / radius;
    const Vec3<R>& n = point.normal;
    const Vec3<R> from_normal = d_point.normal / radius, g = d_point.position + from_normal;
    const R k = (d_point.t + dot(g, ray.direction)) / n_dot_d;
    const Vec3<R> d_origin = g - k * n;
    d_ray.origin += d_origin;
    d_ray.direction += point.t * d_origin;
    d_center += k * n - from_normal;
    d_radius += k - dot(n, from_normal);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
