// The point where a ray meets a triangle that it is known to hit.
//
// The tracer decides in float *which* triangle was hit. This recomputes *where*, in the caller's
// number type, so that everything downstream (positions, texture coordinates, derivatives) has its
// accuracy.
#pragma once

#include "photograd/core/ray.h"

namespace photograd {

/// Corner weights are (1 - u - v, u, v); the normal has unit length and follows the winding a, b, c
/// (counter-clockwise seen from outside), whichever side the ray came from.
template <class R>
struct TrianglePoint {
    R t, u, v;
    Vec3<R> position, normal;
};

/// Solves o + t d = a + u (b - a) + v (c - a) by Cramer's rule [Moeller1997, Eq. 4-6].
///
/// The position is taken from the corners: its error does not grow with the ray's length as that of
/// o + t d does. A ray within the plane (determinant 0) gives non-finite numbers; the tracer
/// reports none.
template <class R>
TrianglePoint<R> triangle_point(const Ray<R>& ray, const Vec3<R>& a, const Vec3<R>& b,
                                const Vec3<R>& c) {
    const Vec3<R> ab = b - a, ac = c - a, ao = ray.origin - a;
    const Vec3<R> p = cross(ray.direction, ac), q = cross(ao, ab);
    const R scale = R(1) / dot(ab, p);
    const R u = dot(ao, p) * scale, v = dot(ray.direction, q) * scale;
    return {dot(ac, q) * scale, u, v, a + u * ab + v * ac, normalize(cross(ab, ac))};
}

}  // namespace photograd
