// Fresnel's reflectance of a metal with complex index eta + i k, for unpolarised light [Born1999,
// Sec. 14.2].
//
// With c = cos_theta, s2 = 1 - c^2 and (a + i b)^2 = (eta + i k)^2 - s2, that is a^2 - b^2 = t =
// eta^2 - k^2 - s2 and a b = eta k:
//
//   Q(x, y, z) = ((x - y)^2 + z^2) / ((x + y)^2 + z^2)
//   R_s = Q(a, c, b)            electric field across the plane of incidence
//   R_p = R_s P,  P = Q(a c, s2, b c)
//   F   = R_s (1 + P) / 2
//
// With m = a^2 + b^2 = sqrt(t^2 + 4 eta^2 k^2), differentiating the two equations for a and b gives
//
//   da = (a dt/2 + b d(eta k)) / m            db = (a d(eta k) - b dt/2) / m
//   dQ/dx = 2 ((x - y) - Q (x + y)) / D       D = (x + y)^2 + z^2
//   dQ/dy = -2 ((x - y) + Q (x + y)) / D      dQ/dz = 2 z (1 - Q) / D
#pragma once

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// The square root a + i b of (eta + i k)^2 - s2.
template <class R>
struct ConductorRoot {
    R a, b;

    static ConductorRoot of(R eta, R k, R s2) {
        const R t = eta * eta - k * k - s2, q = eta * k;
        const R m = sqrt(t * t + R(4) * q * q);
        // The smaller of the two would come from a difference; it comes from a b = eta k instead.
        const R large = sqrt(R(0.5) * (m + (t < R(0) ? -t : t)));
        return t < R(0) ? ConductorRoot{q / large, large} : ConductorRoot{large, q / large};
    }
};

namespace conductor_detail {

template <class R>
inline R quotient(R x, R y, R z) {
    return ((x - y) * (x - y) + z * z) / ((x + y) * (x + y) + z * z);
}
template <class R>
inline void quotient_backward(R x, R y, R z, R d_Q, R& d_x, R& d_y, R& d_z) {
    const R D = (x + y) * (x + y) + z * z, Q = quotient(x, y, z), scale = R(2) * d_Q / D;
    d_x += scale * ((x - y) - Q * (x + y));
    d_y -= scale * ((x - y) + Q * (x + y));
    d_z += scale * (z * (R(1) - Q));
}

}  // namespace conductor_detail

/// k > 0; clear media have fresnel_dielectric.h.
template <class R>
inline R fresnel_conductor(R eta, R k, R cos_theta) {
    const R c = cos_theta, s2 = R(1) - c * c;
    const ConductorRoot<R> w = ConductorRoot<R>::of(eta, k, s2);
    const R R_s = conductor_detail::quotient(w.a, c, w.b);
    return R(0.5) * R_s * (R(1) + conductor_detail::quotient(w.a * c, s2, w.b * c));
}
template <class R>
inline void fresnel_conductor_backward(R eta, R k, R cos_theta, R d_F, R& d_eta, R& d_k,
                                       R& d_cos_theta) {
    const R c = cos_theta, s2 = R(1) - c * c;
    const ConductorRoot<R> w = ConductorRoot<R>::of(eta, k, s2);
    const R R_s = conductor_detail::quotient(w.a, c, w.b);
    const R P = conductor_detail::quotient(w.a * c, s2, w.b * c);
    R d_a = R(0), d_b = R(0), d_c = R(0), d_s2 = R(0), d_ac = R(0), d_bc = R(0);
    conductor_detail::quotient_backward(w.a, c, w.b, R(0.5) * d_F * (R(1) + P), d_a, d_c, d_b);
    conductor_detail::quotient_backward(w.a * c, s2, w.b * c, R(0.5) * d_F * R_s, d_ac, d_s2, d_bc);
    d_a += d_ac * c;
    d_b += d_bc * c;
    const R m = w.a * w.a + w.b * w.b;
    const R d_t = R(0.5) * (d_a * w.a - d_b * w.b) / m, d_q = (d_a * w.b + d_b * w.a) / m;
    d_eta += R(2) * eta * d_t + k * d_q;
    d_k += eta * d_q - R(2) * k * d_t;
    d_s2 -= d_t;
    d_cos_theta += d_c + d_ac * w.a + d_bc * w.b - R(2) * c * d_s2;
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
