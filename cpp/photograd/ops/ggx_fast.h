// Smith's masking for GGX without roots [Guy2018, Sec. 4.4.2]: the stretched length |w| of
// ops/ggx.h, isotropic, by a straight line between its values for alpha 0 and 1.
//
//   |w| = sqrt(w_z^2 + alpha^2 (1 - w_z^2))  becomes  (1 - alpha) w_z + alpha
//   V = 1 / (2 L),    L = 2 (1 - alpha) o_z i_z + alpha (o_z + i_z)
//
//   dV/dL = -2 V^2   dL/dalpha = o_z + i_z - 2 o_z i_z   dL/do_z = 2 (1 - alpha) i_z + alpha
//   the same for i_z
//
// The line lies above the root, by 2 alpha (1 - alpha) w_z (1 - w_z) of the squares, so V is never
// above the exact one: light is lost, at grazing angles most. A mirror of alpha 0.1 seen from o_z =
// 0.1 returns 0.69 in place of 0.88.
#pragma once

#include "photograd/core/vec.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

template <class R>
inline R ggx_V_fast(R o_z, R i_z, R alpha) {
    return R(0.5) / (R(2) * (R(1) - alpha) * o_z * i_z + alpha * (o_z + i_z));
}
template <class R>
inline void ggx_V_fast_backward(R o_z, R i_z, R alpha, R d_V, R& d_o_z, R& d_i_z, R& d_alpha) {
    const R V = ggx_V_fast(o_z, i_z, alpha), d_L = R(-2) * d_V * V * V;
    d_o_z += d_L * (R(2) * (R(1) - alpha) * i_z + alpha);
    d_i_z += d_L * (R(2) * (R(1) - alpha) * o_z + alpha);
    d_alpha += d_L * (o_z + i_z - R(2) * o_z * i_z);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
