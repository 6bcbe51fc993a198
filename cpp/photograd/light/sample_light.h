// One interface for lights of all kinds (light.h): `sample_light` for next event estimation, and
// `light_radiance` and `light_pdf` for rays of BSDF sampling that hit a light or escape.
//
//   reflected += f(wo, s.direction) cos s.radiance / s.pdf
//       if nothing stands between the point and s.distance
//
// Samples are detached: only the radiance is differentiated, not the direction.
#pragma once

#include "photograd/light/light.h"

namespace photograd {

template <class R, class L>
LightSample<R> sample_light(const L& light, const Vec3<R>& point, const Vec2<R>& u2) {
    if constexpr (is_delta(L::kind)) {
        return light.at(point);
    } else if constexpr (L::kind == LightKind::area) {
        return light.sample(point, u2);
    } else if constexpr (L::kind == LightKind::environment) {
        return light.sample_with_radiance(u2);
    } else {
        const Vec3<R> w = light.sample(u2);
        return {w, infinitely_far<R>(), light.L(w), light.pdf(w), false};
    }
}

/// Adds dL/dparameter for dL/d(radiance of the sample). `d_light` is what the light's own adjoint
/// adds to: a light of the same type, or the texels' derivatives.
template <class R, class L, class D>
void sample_light_backward(const L& light, const Vec3<R>& point, const Vec3<R>& direction,
                           const Vec3<R>& d_radiance, D&& d_light) {
    if constexpr (is_delta(L::kind))
        light.at_backward(point, d_radiance, d_light);
    else if constexpr (L::kind == LightKind::area)
        d_light.radiance += d_radiance;  // the sample lies on the light, whatever rounding says
    else
        light.L_backward(direction, d_radiance, d_light);
}

/// Radiance that arrives from w; 0 from delta lights, which no direction meets.
template <class R, class L>
Vec3<R> light_radiance(const L& light, const Vec3<R>& point, const Vec3<R>& w) {
    if constexpr (is_delta(L::kind))
        return Vec3<R>(R(0));
    else if constexpr (L::kind == LightKind::area)
        return light.L(point, w);
    else
        return light.L(w);
}
template <class R, class L, class D>
void light_radiance_backward(const L& light, const Vec3<R>& point, const Vec3<R>& w,
                             const Vec3<R>& d_radiance, D&& d_light) {
    if constexpr (is_delta(L::kind))
        return;
    else if constexpr (L::kind == LightKind::area)
        light.L_backward(point, w, d_radiance, d_light);
    else
        light.L_backward(w, d_radiance, d_light);
}

/// Density over solid angle with which `sample_light` samples w; 0 for delta lights.
template <class R, class L>
R light_pdf(const L& light, const Vec3<R>& point, const Vec3<R>& w) {
    if constexpr (is_delta(L::kind))
        return R(0);
    else if constexpr (L::kind == LightKind::area)
        return light.pdf(point, w);
    else
        return light.pdf(w);
}

}  // namespace photograd
