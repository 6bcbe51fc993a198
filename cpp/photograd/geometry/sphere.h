// The point where a ray meets a sphere that it is known to hit.
#pragma once

#include "photograd/ops/ray_sphere.h"

namespace photograd {

/// In float, as the tracer has it: both number types then see one and the same sphere.
struct Sphere {
    float x, y, z, radius;

    template <class R>
    [[nodiscard]] Vec3<R> center() const {
        return {R(x), R(y), R(z)};
    }
};

/// For a unit direction. Of the two points, the one nearer to the tracer's answer; a ray that
/// passes by within rounding touches at t = m.
template <class R>
SpherePoint<R> sphere_point(const Ray<R>& ray, const Sphere& sphere, R found_t) {
    const Vec3<R> center = sphere.center<R>();
    const R radius = R(sphere.radius);
    const SphereChord<R> chord = SphereChord<R>::of(ray, center, radius, R(1));
    const R half = chord.half_squared > R(0) ? sqrt(chord.half_squared) : R(0);
    const R t = chord.middle + (found_t < chord.middle ? -half : half);
    return SpherePoint<R>::of(t, center, radius, ray.at(t) - center);
}

}  // namespace photograd
