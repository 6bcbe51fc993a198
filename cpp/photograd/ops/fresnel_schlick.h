// Schlick's ramp from f0, the reflectance straight on, to f90 at grazing angles [Schlick1994, Eq.
// 15].
//
//   m = 1 - cos_theta
//   F = f0 + (f90 - f0) m^5
//
//   dF/df0 = 1 - m^5      dF/df90 = m^5      dF/dcos_theta = -5 (f90 - f0) m^4
//
// F is linear in f0: mixing two f0 is mixing the two F. What multiplies F may not be.
//
// Of a clear medium of index eta [Born1999, Sec. 1.5.2]:
//
//   f0 = ((eta - 1) / (eta + 1))^2                    df0/deta = 4 (eta - 1) / (eta + 1)^3
#pragma once

#include "photograd/core/vec.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

template <class R>
inline R schlick_ramp(R cos_theta) {
    const R m = R(1) - cos_theta;
    return (m * m) * (m * m) * m;
}

template <class R>
inline R schlick(R f0, R f90, R cos_theta) {
    return f0 + (f90 - f0) * schlick_ramp(cos_theta);
}
template <class R>
inline void schlick_backward(R f0, R f90, R cos_theta, R d_F, R& d_f0, R& d_f90, R& d_cos_theta) {
    const R m = R(1) - cos_theta, ramp = schlick_ramp(cos_theta);
    d_f0 += d_F * (R(1) - ramp);
    d_f90 += d_F * ramp;
    d_cos_theta -= d_F * (R(5) * (f90 - f0) * (m * m) * (m * m));
}

/// Straight on, from outside or inside alike.
template <class R>
inline R schlick_f0(R eta) {
    const R r = (eta - R(1)) / (eta + R(1));
    return r * r;
}
template <class R>
inline void schlick_f0_backward(R eta, R d_f0, R& d_eta) {
    const R sum = eta + R(1);
    d_eta += d_f0 * R(4) * (eta - R(1)) / (sum * sum * sum);
}

/// Schlick's ramp for a color that turns white at grazing angles, f90 = 1.
template <class R>
inline Vec3<R> schlick(const Vec3<R>& f0, R cos_theta) {
    return f0 + (Vec3<R>(R(1)) - f0) * schlick_ramp(cos_theta);
}
template <class R>
inline void schlick_backward(R cos_theta, const Vec3<R>& d_F, Vec3<R>& d_f0) {
    d_f0 += d_F * (R(1) - schlick_ramp(cos_theta));
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
