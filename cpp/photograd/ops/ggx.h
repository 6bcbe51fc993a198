// GGX: facets whose slopes have long tails [Walter2007, Eq. 33], with one roughness for each
// tangent axis [Heitz2014]. Equal ones are the isotropic model.
//
//   q = (h_x / alpha_x)^2 + (h_y / alpha_y)^2 + h_z^2            of the half vector wh
//   D = 1 / (pi alpha_x alpha_y q^2)      integral of D h_z over the hemisphere: 1
//
//   dD/dq = -2 D / q      dq/dh_x = 2 h_x / alpha_x^2      dq/dalpha_x = -2 h_x^2 / alpha_x^3
//   dD/dalpha_x = -D / alpha_x + dD/dq dq/dalpha_x
//
// Written with h_x and h_y it stays exact where h_z is near 1; the usual (alpha^2 - 1) h_z^2 + 1
// loses all digits of float there, just where D is largest.
//
// Masking and shadowing after Smith, correlated by height [Heitz2014, Eq. 99]: a facet deep down is
// hidden from both sides. With |w| = sqrt((alpha_x w_x)^2 + (alpha_y w_y)^2 + w_z^2), the
// microfacet model's denominator included:
//
//   V = G2 / (4 o_z i_z) = 1 / (2 (|o| i_z + |i| o_z))
//
//   L = |o| i_z + |i| o_z,    dV/dL = -2 V^2
//   dL/dalpha_x = alpha_x (o_x^2 i_z / |o| + i_x^2 o_z / |i|)
//   dL/do_x = alpha_x^2 o_x i_z / |o|      dL/do_z = o_z i_z / |o| + |i|
//   and the same with o and i exchanged
#pragma once

#include "photograd/core/vec.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// Density of facets with normal wh, per solid angle and area of the surface. wh is a unit vector
/// with z > 0.
template <class R>
inline R ggx_D(const Vec3<R>& wh, R alpha_x, R alpha_y) {
    const R x = wh.x / alpha_x, y = wh.y / alpha_y, q = x * x + y * y + wh.z * wh.z;
    return R(0.31830988618379067154) / (alpha_x * alpha_y * (q * q));
}
template <class R>
inline void ggx_D_backward(const Vec3<R>& wh, R alpha_x, R alpha_y, R d_D, Vec3<R>& d_wh,
                           R& d_alpha_x, R& d_alpha_y) {
    const R x = wh.x / alpha_x, y = wh.y / alpha_y, q = x * x + y * y + wh.z * wh.z;
    const R D = ggx_D(wh, alpha_x, alpha_y), d_q = R(-2) * d_D * D / q;
    d_wh += Vec3<R>(x / alpha_x, y / alpha_y, wh.z) * (R(2) * d_q);
    d_alpha_x -= (d_D * D + R(2) * d_q * x * x) / alpha_x;
    d_alpha_y -= (d_D * D + R(2) * d_q * y * y) / alpha_y;
}

/// |w| of the head of this file.
template <class R>
inline R ggx_stretched_length(const Vec3<R>& w, R alpha_x, R alpha_y) {
    const R x = alpha_x * w.x, y = alpha_y * w.y;
    return sqrt(x * x + y * y + w.z * w.z);
}

template <class R>
inline R ggx_V(const Vec3<R>& wo, const Vec3<R>& wi, R alpha_x, R alpha_y) {
    return R(0.5) / (ggx_stretched_length(wo, alpha_x, alpha_y) * wi.z +
                     ggx_stretched_length(wi, alpha_x, alpha_y) * wo.z);
}
template <class R>
inline void ggx_V_backward(const Vec3<R>& wo, const Vec3<R>& wi, R alpha_x, R alpha_y, R d_V,
                           Vec3<R>& d_wo, Vec3<R>& d_wi, R& d_alpha_x, R& d_alpha_y) {
    const R o = ggx_stretched_length(wo, alpha_x, alpha_y);
    const R i = ggx_stretched_length(wi, alpha_x, alpha_y), L = o * wi.z + i * wo.z;
    const R d_L = -d_V / (R(2) * L * L), to_o = d_L * wi.z / o, to_i = d_L * wo.z / i;
    const Vec3<R> squares(alpha_x * alpha_x, alpha_y * alpha_y, R(1));
    d_wo += wo * squares * to_o;
    d_wi += wi * squares * to_i;
    d_wo.z += d_L * i;
    d_wi.z += d_L * o;
    d_alpha_x += alpha_x * (to_o * wo.x * wo.x + to_i * wi.x * wi.x);
    d_alpha_y += alpha_y * (to_o * wo.y * wo.y + to_i * wi.y * wi.y);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
