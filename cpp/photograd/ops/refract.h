// Snell's refraction at a flat boundary whose normal is +Z.
//
// wo leaves the surface on either side; e is the index on the far side over that on wo's side, s
// the sign of o_z:
//
//   t2 = 1 - (1 - o_z^2) / e^2      not positive under total reflection: there is no refracted ray
//   wi = (-o_x / e, -o_y / e, -s sqrt(t2))       away from the surface, on the far side
//
//   di_x/de = o_x / e^2      di_z/de = -s (1 - o_z^2) / (e^3 t)
//   di_x/do_x = -1 / e       di_z/do_z = -s o_z / (e^2 t)
#pragma once

#include "photograd/core/vec.h"
#include "photograd/ops/fresnel_dielectric.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// Where light that leaves as wo came from. `e` must let it through (refracted_cos_squared > 0).
template <class R>
inline Vec3<R> refract(const Vec3<R>& wo, R e) {
    const R t = sqrt(refracted_cos_squared(e, wo.z));
    return {-wo.x / e, -wo.y / e, wo.z > R(0) ? -t : t};
}
template <class R>
inline void refract_backward(const Vec3<R>& wo, R e, const Vec3<R>& d_wi, Vec3<R>& d_wo, R& d_e) {
    const R t = sqrt(refracted_cos_squared(e, wo.z)), e2 = e * e;
    const R d_t = wo.z > R(0) ? -d_wi.z : d_wi.z;
    d_e += (d_wi.x * wo.x + d_wi.y * wo.y) / e2 + d_t * (R(1) - wo.z * wo.z) / (e2 * e * t);
    d_wo += Vec3<R>(-d_wi.x / e, -d_wi.y / e, d_t * wo.z / (e2 * t));
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
