// Beckmann: facets whose slopes are distributed normally, with no tails to speak of [Walter2007,
// Eq. 25].
//
//   u = (h_x^2 + h_y^2) / h_z^2                       squared tangent of the half vector's angle
//   D = exp(-u / alpha^2) / (pi alpha^2 h_z^4)        integral of D h_z over the hemisphere: 1
//   dD/dalpha = 2 D (u / alpha^2 - 1) / alpha
//
// Smith's masking, exact, not by the usual fit [Heitz2014], for a = w_z / (alpha sqrt(w_x^2 +
// w_y^2)):
//
//   Lambda = (exp(-a^2) / (a sqrt(pi)) - erfc(a)) / 2    dLambda/da = -exp(-a^2) / (2 sqrt(pi) a^2)
//   da/dalpha = -a / alpha
//   V = G2 / (4 o_z i_z),  G2 = 1 / (1 + Lambda_o + Lambda_i)      height-correlated
//                                                                  [Heitz2014, Eq. 99]
//   dV/dLambda = -V G2
//
// Directions are held constant.
#pragma once

#include "photograd/core/vec.h"
#include "photograd/ops/erf.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// Density of facets with normal wh, per solid angle and area of the surface. wh is a unit vector
/// with z > 0.
template <class R>
inline R beckmann_D(const Vec3<R>& wh, R alpha) {
    const R z2 = wh.z * wh.z, a2 = alpha * alpha, u = (wh.x * wh.x + wh.y * wh.y) / z2;
    return exp(-u / a2) * R(0.31830988618379067154) / (a2 * (z2 * z2));
}
template <class R>
inline void beckmann_D_backward(const Vec3<R>& wh, R alpha, R d_D, R& d_alpha) {
    const R u = (wh.x * wh.x + wh.y * wh.y) / (wh.z * wh.z);
    d_alpha += d_D * R(2) * beckmann_D(wh, alpha) * (u / (alpha * alpha) - R(1)) / alpha;
}

namespace beckmann_detail {

/// a of the head of this file; straight up, where it is infinite, 6 serves as well (Lambda =
/// 1e-18).
template <class R>
inline R steepness(const Vec3<R>& w, R alpha) {
    const R s2 = w.x * w.x + w.y * w.y, most = R(6) * alpha;
    return w.z * w.z < most * most * s2 ? w.z / (alpha * sqrt(s2)) : R(6);
}

}  // namespace beckmann_detail

template <class R>
inline R beckmann_lambda(const Vec3<R>& w, R alpha) {
    const R a = beckmann_detail::steepness(w, alpha);
    return R(0.5) * (R(0.5 * two_over_sqrt_pi) * exp(-a * a) / a - (R(1) - erf(a)));
}
template <class R>
inline void beckmann_lambda_backward(const Vec3<R>& w, R alpha, R d_lambda, R& d_alpha) {
    const R a = beckmann_detail::steepness(w, alpha);
    d_alpha += d_lambda * R(0.25 * two_over_sqrt_pi) * exp(-a * a) / (a * alpha);
}

template <class R>
inline R beckmann_V(const Vec3<R>& wo, const Vec3<R>& wi, R alpha) {
    return R(1) / ((R(1) + beckmann_lambda(wo, alpha) + beckmann_lambda(wi, alpha)) *
                   (R(4) * wo.z * wi.z));
}
template <class R>
inline void beckmann_V_backward(const Vec3<R>& wo, const Vec3<R>& wi, R alpha, R d_V, R& d_alpha) {
    const R V = beckmann_V(wo, wi, alpha);
    const R d_lambda = -d_V * V * V * (R(4) * wo.z * wi.z);
    beckmann_lambda_backward(wo, alpha, d_lambda, d_alpha);
    beckmann_lambda_backward(wi, alpha, d_lambda, d_alpha);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
