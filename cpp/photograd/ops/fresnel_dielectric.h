// Fresnel's reflectance of a smooth boundary of two clear media, for unpolarised light [Born1999,
// Sec. 1.5.2].
//
// eta is the index on the far side over the one on the side of the light, c its cosine, t that of
// the refracted ray:
//
//   t^2 = 1 - (1 - c^2) / eta^2                       Snell; t^2 <= 0 is total reflection, F = 1
//   r_s = (c - eta t) / (c + eta t)                   electric field across the plane of incidence
//   r_p = (eta c - t) / (eta c + t)                   and within it
//   F   = (r_s^2 + r_p^2) / 2
//
//   dt/deta = (1 - c^2) / (eta^3 t)                   dt/dc = c / (eta^2 t)
//   r = (x - y) / (x + y):   dr/dx = 2 y / (x + y)^2,   dr/dy = -2 x / (x + y)^2
//
// Under total reflection F is constant and all derivatives are 0; towards the critical angle they
// grow without bound.
#pragma once

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// Squared cosine of the refracted ray; not positive under total reflection.
template <class R>
inline R refracted_cos_squared(R eta, R cos_theta) {
    return R(1) - (R(1) - cos_theta * cos_theta) / (eta * eta);
}

template <class R>
inline R fresnel_dielectric(R eta, R cos_theta) {
    const R t2 = refracted_cos_squared(eta, cos_theta);
    if (!(t2 > R(0))) return R(1);
    const R c = cos_theta, t = sqrt(t2);
    const R r_s = (c - eta * t) / (c + eta * t), r_p = (eta * c - t) / (eta * c + t);
    return R(0.5) * (r_s * r_s + r_p * r_p);
}
template <class R>
inline void fresnel_dielectric_backward(R eta, R cos_theta, R d_F, R& d_eta, R& d_cos_theta) {
    const R t2 = refracted_cos_squared(eta, cos_theta);
    if (!(t2 > R(0))) return;
    const R c = cos_theta, t = sqrt(t2);
    const R sum_s = c + eta * t, sum_p = eta * c + t;
    // d_r = d_F r; each then goes through the quotient, with x and y as in the head of this file.
    const R q_s = d_F * ((c - eta * t) / sum_s) * R(2) / (sum_s * sum_s);
    const R q_p = d_F * ((eta * c - t) / sum_p) * R(2) / (sum_p * sum_p);
    const R d_y = -q_s * c, d_x = q_p * t;  // of eta t in r_s, of eta c in r_p
    const R d_t = d_y * eta - q_p * (eta * c);
    d_eta += d_y * t + d_x * c + d_t * (R(1) - c * c) / (eta * eta * eta * t);
    d_cos_theta += q_s * (eta * t) + d_x * eta + d_t * c / (eta * eta * t);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
