// Fresnel's reflectance under a thin film, as a color: light that bounced in the film interferes
// with light that did not [Belcour2017], in the form of KHR_materials_iridescence [Khronos2022].
//
// Air, a film of index n > 1 and thickness d (nm), a base that reflects f0 straight on; c1 =
// cos_theta, per channel:
//
//   c2 = sqrt(1 - (1 - c1^2) / n^2)                               Snell
//   R12 = R0 + (1 - R0) (1 - c1)^5,   R0 = ((n - 1) / (n + 1))^2  upper boundary
//   R23 = a^2 + (1 - a^2) (1 - c2)^5                              lower boundary
//   a = (P - Q) / (P + Q),   P = 1 + g,  Q = n (1 - g),  g = sqrt(f0 + 1e-4 (1 - f0))
//   psi = 4 pi n d c2                                             path difference times 2 pi (nm)
//   T = 1 - R12,  D = 1 - R12 R23,  r = sqrt(R12 R23),  Rs = T^2 R23 / D
//   F = max(R12 + Rs + 2 (Rs - T) H, 0),   H = r s S(psi) + r^2 S(2 psi)
//
// s is the sign of the phases that the boundaries turn: -1 where the base is denser than the film
// (a > 0), else 1. So F jumps where both have one index, a = 0, but for views from straight above:
// R23 is not 0 there. S(psi) is what a wave of this path contributes to red, green and blue: the
// eye's sensitivities as four Gaussians in frequency, Fourier transformed, sum_k A_k exp(-v_k
// psi^2) cos(p_k psi), and turned into Rec. 709. Of the waves that bounce more often, the third and
// later are left out. All of these are approximations: tests say how far from the spectral sum.
//
//   dF/dRs = 1 + 2 H     dF/dT = -2 H     dF/dr = 2 (Rs - T) (s S(psi) + 2 r S(2 psi))
//   dRs/dT = 2 T R23 / D     dRs/dR23 = T^2 / D     dRs/dD = -Rs / D     dr/dR12 = R23 / (2 r)
//   da/dP = 2 Q / (P + Q)^2     da/dQ = -2 P / (P + Q)^2     dR0/dn = 4 (n - 1) / (n + 1)^3
//   dc2/dn = (1 - c1^2) / (n^3 c2)     dc2/dc1 = c1 / (n^2 c2)
//   dR12/dc1 = -5 (1 - R0) (1 - c1)^4
//
// Whatever the thickness, |S| stays below B = (1.79, 0.99, 0.97), so that F is at most what
// H = -B (r + r^2) makes of it: `thin_film_bound`, with dH/dr = -B (1 + 2 r).
//
// The 1e-4 keeps dg/df0 finite for a black base. D is held at 1e-4 or more: both boundaries are
// mirrors at the horizon.
#pragma once

#include "photograd/core/exp.h"
#include "photograd/core/sincos.h"
#include "photograd/core/vec.h"
#include "photograd/ops/fresnel_schlick.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

namespace film_detail {

inline constexpr double turn = 6.28318530717958647693;

/// X, Y, Z and the second lobe of X: heights, positions and variances per nm and nm^2
/// [Belcour2017].
inline constexpr double height[4] = {0.8465900, 1.0002219, 1.0011225, 0.1538683};
inline constexpr double position[4] = {1.6810e-3, 1.7953e-3, 2.2084e-3, 2.2399e-3};
inline constexpr double variance[4] = {4.3278e-9, 9.3046e-9, 6.6121e-9, 4.5282e-9};

/// A color in X, Y, Z as red, green and blue of Rec. 709.
template <class R>
Vec3<R> rec709(R x, R y, R z) {
    return {R(3.2404542) * x - R(1.5371385) * y - R(0.4985314) * z,
            R(-0.9692660) * x + R(1.8760108) * y + R(0.0415560) * z,
            R(0.0556434) * x - R(0.2040259) * y + R(1.0572252) * z};
}

/// S(psi) and dS/dpsi.
template <class R>
struct Wave {
    Vec3<R> S{R(0)}, slope{R(0)};

    static Wave of(R psi) {
        if (!(psi < R(1.5e5))) return {};  // below 1e-38 of its height
        R value[4], slope[4];
        for (int k = 0; k < 4; ++k) {
            R angle = R(position[k]) * psi;
            while (angle > R(0.5 * turn)) angle = angle - R(turn);
            const SinCos<R> at = sin_cos(angle);
            const R envelope = R(height[k]) * exp(R(-variance[k]) * psi * psi);
            value[k] = envelope * at.cos;
            slope[k] = -envelope * (R(position[k]) * at.sin + R(2 * variance[k]) * psi * at.cos);
        }
        return {rec709(value[0] + value[3], value[1], value[2]),
                rec709(slope[0] + slope[3], slope[1], slope[2])};
    }
};

/// Of |S| over all psi, in red, green and blue.
inline constexpr double largest_S[3] = {1.79, 0.99, 0.97};

/// What base and film share: all but R23.
template <class R>
struct Film {
    R n, d, c1, c2, R0, R12, T, psi;
    Wave<R> once, twice;
    bool bound;  // H as small as any thickness makes it

    static Film bound_of(R n, R c1) {
        Film film{};
        film.bound = true;
        for (int c = 0; c < 3; ++c) film.once.S[c] = film.twice.S[c] = R(largest_S[c]);
        film.n = n;
        film.c1 = c1;
        film.c2 = sqrt(R(1) - (R(1) - c1 * c1) / (n * n));
        const R step = (n - R(1)) / (n + R(1));
        film.R0 = step * step;
        film.R12 = film.R0 + (R(1) - film.R0) * schlick_ramp(c1);
        film.T = R(1) - film.R12;
        return film;
    }
    static Film of(R n, R d, R c1) {
        Film film = bound_of(n, c1);
        film.bound = false;
        film.d = d;
        film.psi = R(2 * turn) * n * d * film.c2;
        film.once = Wave<R>::of(film.psi);
        film.twice = Wave<R>::of(R(2) * film.psi);
        return film;
    }
};

/// One channel of the sum.
template <class R>
struct Interference {
    R g, a, ramp2, R23, D, r, Rs, H, H_by_r, s, sum;

    static Interference of(const Film<R>& film, R f0, R once, R twice) {
        Interference x{};
        x.g = sqrt(f0 + R(1e-4) * (R(1) - f0));
        const R P = R(1) + x.g, Q = film.n * (R(1) - x.g);
        x.a = (P - Q) / (P + Q);
        x.ramp2 = schlick_ramp(film.c2);
        x.R23 = x.a * x.a + (R(1) - x.a * x.a) * x.ramp2;
        x.D = larger(R(1) - film.R12 * x.R23, R(1e-4));
        x.r = sqrt(larger(film.R12 * x.R23, R(1e-12)));
        x.Rs = film.T * film.T * x.R23 / x.D;
        x.s = x.a > R(0) ? R(-1) : R(1);
        x.H = film.bound ? -x.r * once - x.r * x.r * twice : x.r * x.s * once + x.r * x.r * twice;
        x.H_by_r = film.bound ? -once - R(2) * x.r * twice : x.s * once + R(2) * x.r * twice;
        x.sum = film.R12 + x.Rs + R(2) * (x.Rs - film.T) * x.H;
        return x;
    }
};

template <class R>
Vec3<R> reflectance(const Film<R>& film, const Vec3<R>& f0) {
    Vec3<R> F;
    for (int c = 0; c < 3; ++c)
        F[c] = larger(Interference<R>::of(film, f0[c], film.once.S[c], film.twice.S[c]).sum, R(0));
    return F;
}
template <class R>
void reflectance_backward(const Film<R>& film, const Vec3<R>& f0, const Vec3<R>& d_F, Vec3<R>& d_f0,
                          R& d_n, R& d_d, R& d_cos_theta) {
    const R n = film.n, d = film.d, c1 = film.c1;
    R d_R12 = R(0), d_T = R(0), d_c2 = R(0), d_psi = R(0);
    for (int c = 0; c < 3; ++c) {
        const R once = film.once.S[c], twice = film.twice.S[c];
        const Interference<R> x = Interference<R>::of(film, f0[c], once, twice);
        if (!(x.sum > R(0))) continue;
        const R rest = R(2) * (x.Rs - film.T) * d_F[c];
        const R d_Rs = d_F[c] * (R(1) + R(2) * x.H);
        const R d_r = rest * x.H_by_r;
        const R d_D = R(1) - film.R12 * x.R23 > R(1e-4) ? -d_Rs * x.Rs / x.D : R(0);
        d_psi += rest * (x.r * x.s * film.once.slope[c] + R(2) * x.r * x.r * film.twice.slope[c]);
        d_T += d_Rs * R(2) * film.T * x.R23 / x.D - R(2) * x.H * d_F[c];
        d_R12 += d_F[c] + d_r * x.R23 / (R(2) * x.r) - d_D * x.R23;
        const R d_R23 =
            d_Rs * film.T * film.T / x.D + d_r * film.R12 / (R(2) * x.r) - d_D * film.R12;
        const R m = R(1) - film.c2;
        d_c2 -= d_R23 * (R(1) - x.a * x.a) * R(5) * (m * m) * (m * m);
        const R d_a = d_R23 * R(2) * x.a * (R(1) - x.ramp2);
        const R P = R(1) + x.g, Q = n * (R(1) - x.g), scale = R(2) * d_a / ((P + Q) * (P + Q));
        // dP/dg = 1 and dQ/dg = -n
        d_f0[c] += scale * (Q + n * P) * R(1 - 1e-4) / (R(2) * x.g);
        d_n -= scale * P * (R(1) - x.g);
    }
    d_R12 -= d_T;
    d_c2 += d_psi * R(2 * turn) * n * d;
    d_n += d_R12 * (R(1) - schlick_ramp(c1)) * R(4) * (n - R(1)) /
               ((n + R(1)) * (n + R(1)) * (n + R(1))) +
           d_psi * R(2 * turn) * d * film.c2 + d_c2 * (R(1) - c1 * c1) / (n * n * n * film.c2);
    d_d += d_psi * R(2 * turn) * n * film.c2;
    const R m = R(1) - c1;
    d_cos_theta +=
        d_c2 * c1 / (n * n * film.c2) - d_R12 * (R(1) - film.R0) * R(5) * (m * m) * (m * m);
}

}  // namespace film_detail

template <class R>
Vec3<R> thin_film(const Vec3<R>& f0, R n, R d, R cos_theta) {
    return film_detail::reflectance(film_detail::Film<R>::of(n, d, cos_theta), f0);
}
template <class R>
void thin_film_backward(const Vec3<R>& f0, R n, R d, R cos_theta, const Vec3<R>& d_F, Vec3<R>& d_f0,
                        R& d_n, R& d_d, R& d_cos_theta) {
    film_detail::reflectance_backward(film_detail::Film<R>::of(n, d, cos_theta), f0, d_F, d_f0, d_n,
                                      d_d, d_cos_theta);
}

/// The most that a film of any thickness reflects.
template <class R>
Vec3<R> thin_film_bound(const Vec3<R>& f0, R n, R cos_theta) {
    return film_detail::reflectance(film_detail::Film<R>::bound_of(n, cos_theta), f0);
}
/// The angle is held constant.
template <class R>
void thin_film_bound_backward(const Vec3<R>& f0, R n, R cos_theta, const Vec3<R>& d_F,
                              Vec3<R>& d_f0, R& d_n) {
    R fixed_thickness = R(0), fixed_cosine = R(0);
    film_detail::reflectance_backward(film_detail::Film<R>::bound_of(n, cos_theta), f0, d_F, d_f0,
                                      d_n, fixed_thickness, fixed_cosine);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
