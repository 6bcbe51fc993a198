// Facets with tails that fall as slowly as may be: Burley's clear coat [Burley2012, App. B.2, Eq.
// 4].
//
//   D = (q - 1) / (pi ln(q) t),   q = alpha^2,   t = h_x^2 + h_y^2 + q h_z^2   integral of D h_z: 1
//
//   dD/dq = D (1 / (q - 1) - 1 / (q ln q) - h_z^2 / t),   dq/dalpha = 2 alpha
#pragma once

#include "photograd/core/log.h"
#include "photograd/core/vec.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// 0 < alpha < 1; wh is a unit vector with z > 0, held constant.
template <class R>
inline R gtr1_D(const Vec3<R>& wh, R alpha) {
    const R q = alpha * alpha, t = wh.x * wh.x + wh.y * wh.y + q * wh.z * wh.z;
    return (q - R(1)) * R(0.31830988618379067154) / (log(q) * t);
}
template <class R>
inline void gtr1_D_backward(const Vec3<R>& wh, R alpha, R d_D, R& d_alpha) {
    const R q = alpha * alpha, z2 = wh.z * wh.z, t = wh.x * wh.x + wh.y * wh.y + q * z2;
    const R by_q = R(1) / (q - R(1)) - R(1) / (q * log(q)) - z2 / t;
    d_alpha += d_D * gtr1_D(wh, alpha) * by_q * R(2) * alpha;
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
