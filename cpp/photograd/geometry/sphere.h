// The point where a ray meets a sphere that it is known to hit.
#pragma once

#include <cmath>

#include "photograd/core/ray.h"

namespace photograd {

/// In float, as the tracer has it: both number types then see one and the same sphere.
struct Sphere {
    float x, y, z, radius;

    template <class R>
    [[nodiscard]] Vec3<R> center() const {
        return {R(x), R(y), R(z)};
    }
};

/// The normal points out of the sphere, whichever side the ray came from.
template <class R>
struct SpherePoint {
    R t;
    Vec3<R> position, normal;
};

/// A unit direction d meets the sphere at t = m -+ sqrt(r^2 - |p|^2), where m = <c - o, d> and p = c - o - m d reaches
/// from the ray to the centre: no difference of large squares, whatever the distance. Of the two, the one nearer to
/// the tracer's answer; a ray that passes by within rounding touches at t = m.
template <class R>
SpherePoint<R> sphere_point(const Ray<R>& ray, const Sphere& sphere, R found_t) {
    const Vec3<R> center = sphere.center<R>(), co = center - ray.origin;
    const R radius = R(sphere.radius), middle = dot(co, ray.direction);
    const Vec3<R> p = co - middle * ray.direction;
    const R rest = radius * radius - dot(p, p), half = rest > R(0) ? std::sqrt(rest) : R(0);
    const R t = middle + (found_t < middle ? -half : half);
    const Vec3<R> normal = normalize(ray.at(t) - center);
    return {t, center + radius * normal, normal};
}

}  // namespace photograd
