// Power of the lights of a scene, in proportion to which they are sampled.
//
// All in watts of luminance. Of a light at infinity it is what enters the scene's box, whose mean
// shadow is a quarter of its surface (true of every convex body), or, for light of one direction,
// the shadow that it casts along that direction. Powers change the variance of estimates, not their
// mean.
//
//   point          4 pi I
//   spot           2 pi (1 - cos_outer) (1 - softness / 2) I
//       the fading part counts half, s(t) + s(1 - t) = 1
//   directional    E (shadow of the box along the light)
//   at infinity    (surface of the box / 4) integral of L over the sphere
//   surface        pi A L
#pragma once

#include <cmath>

#include "photograd/geometry/ray_order.h"
#include "photograd/light/any_light.h"
#include "photograd/light/luminance.h"

namespace photograd {

inline double luminance(const Vec3<double>& color) { return luminance(&color.x); }

/// Areas of the sides of a box across x, y and z, m^2.
inline Vec3<double> box_sides(const Box& box) {
    double edge[3];
    for (int k = 0; k < 3; ++k) edge[k] = double(box.hi[k]) - double(box.lo[k]);
    return {edge[1] * edge[2], edge[2] * edge[0], edge[0] * edge[1]};
}

/// Integral of the luminance over all directions, W/m^2.
inline double flux(const Sun<double>& sun) { return 2 * pi * sun.height * luminance(sun.radiance); }
inline double flux(const Sky<double>& sky) {
    return pi * luminance(sky.zenith + 2.0 * sky.horizon + sky.ground);
}
inline double flux(const ConstantLight<double>& light) {
    return 4 * pi * luminance(light.radiance);
}
inline double flux(const Environment<double>& map) { return map.sampler->flux(); }

inline double power(const PointLight<double>& light, const Vec3<double>&) {
    return 4 * pi * luminance(light.intensity);
}
inline double power(const SpotLight<double>& light, const Vec3<double>&) {
    return 2 * pi * (1 - light.cos_outer) * (1 - 0.5 * light.softness) * luminance(light.intensity);
}
inline double power(const DirectionalLight<double>& light, const Vec3<double>& sides) {
    double shadow = 0;
    for (int k = 0; k < 3; ++k) shadow += sides[k] * std::abs(light.direction[k]);
    return shadow * luminance(light.irradiance);
}
template <class L>
    requires requires(const L& light) { flux(light); }
double power(const L& light, const Vec3<double>& sides) {
    return 0.5 * (sides.x + sides.y + sides.z) * flux(light);
}

/// Power of a light in a scene with these bounds.
inline double light_power(const AnyLight<double>& any, const Box& bounds) {
    return std::visit([&](const auto& light) { return power(light, box_sides(bounds)); },
                      any.model);
}

}  // namespace photograd
