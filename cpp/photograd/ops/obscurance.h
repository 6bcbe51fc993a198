// One sample of ambient obscurance in screen space: how much a point of the frame hides of the sky
// above another [McGuire2011; McGuire2012].
//
//   v = q - p,  e = max(v.n / |v| - bias, 0),  fall = max(1 - |v|^2 / radius^2, 0)^k,  a = e fall
//
// A point in the plane of p hides nothing. Derivatives:
//   de/dv = n / |v| - (v.n) v / |v|^3,  dfall/dv = -2 k t^(k-1) v / r^2,  t = 1 - |v|^2 / r^2,
//   dfall/dr = 2 k t^(k-1) |v|^2 / r^3,  dfall/dk = fall ln t
#pragma once

#include "photograd/core/vec.h"
#include "photograd/ops/obscurance_terms.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// Numbers that a frame may be tuned by.
template <class R>
struct Obscurance {
    R radius;   // meters
    R falloff;  // k
    R bias;     // sine of the elevation from which points hide anything
};

template <class R>
inline R obscurance(const Vec3<R>& v, const Vec3<R>& n, const Obscurance<R>& by) {
    return obscurance_terms(dot(v, v), dot(v, n), by.radius, by.falloff, by.bias);
}
/// Adds to d_v and d_by; n is held.
template <class R>
inline void obscurance_backward(const Vec3<R>& v, const Vec3<R>& n, const Obscurance<R>& by, R d_a,
                                Vec3<R>& d_v, Obscurance<R>& d_by) {
    const R squared = dot(v, v), over = R(1) / (by.radius * by.radius), t = R(1) - squared * over;
    if (!(t > R(0)) || !(squared > R(0))) return;
    const R size = sqrt(squared), sine = dot(v, n) / size, e = sine - by.bias;
    if (!(e > R(0))) return;
    const R fall = pow(t, by.falloff);
    const R d_e = d_a * fall, d_t = d_a * e * by.falloff * fall / t;
    d_v += (n - v * (sine / size)) * (d_e / size) - v * (R(2) * over * d_t);
    d_by.bias -= d_e;
    d_by.falloff += d_a * e * fall * log(t);
    d_by.radius += d_t * R(2) * squared * over / by.radius;
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
