// Common to area lights: radiance `radiance` on the side of the normal, nothing on the other.
#pragma once

#include "photograd/light/light.h"
#include "photograd/sampling/triangle_warp.h"

namespace photograd {

/// The sample at `to` = (point on the light) - (lit point), of density `area_pdf` over area
/// (1/m^2).
template <class R>
LightSample<R> sample_area_light(const Vec3<R>& to, const Vec3<R>& normal, R area_pdf,
                                 const Vec3<R>& radiance) {
    const R r2 = dot(to, to);
    if (!(r2 > R(0))) return {};
    const R r = sqrt(r2);
    const Vec3<R> w = to * (R(1) / r);
    const R cosine = -dot(w, normal);
    if (!(cosine > R(0))) return {};
    return {w, r, radiance, solid_angle_density(area_pdf, r2, cosine), false};
}

}  // namespace photograd
