// The dipole: diffuse light that leaves a half space at a distance r from where a thin beam enters
// it along the normal [Jensen2001, Sec. 2.1 to 2.3].
//
// sigma_s is the reduced coefficient, (1 - g) times that of the medium (similarity theory). Two
// point sources, one a mean free path below the surface and a negative one above it, make diffuse
// light vanish a little above the surface, by B what the boundary reflects back inside:
//
//   sigma_t = sigma_s + sigma_a     albedo = sigma_s / sigma_t     k = 3 sigma_a sigma_t
//   F = -1.440 / eta^2 + 0.710 / eta + 0.668 + 0.0636 eta       diffuse reflectance, from inside
//   B = 1 + (4/3) (1 + F) / (1 - F)      z_1 = 1 / sigma_t      z_2 = B / sigma_t
//   q = sqrt(k)      d_i^2 = r^2 + z_i^2
//   R_d = albedo / (4 pi) sum_i z_i G(d_i),   G(d) = (1 + q d) exp(-q d) / d^3          [Eq. 4]
//   integral of R_d over the plane = albedo / 2 sum_i exp(-q z_i)
//
//   dG/dd = -(k d^2 + 3 (1 + q d)) exp(-q d) / d^4         dG/dk = -exp(-q d) / (2 d)
//   dalbedo/dsigma_s = sigma_a / sigma_t^2                 dalbedo/dsigma_a = -sigma_s / sigma_t^2
//   dz_i/dsigma_t = -z_i / sigma_t                         dz_2/dB = 1 / sigma_t
//   dk/dsigma_s = 3 sigma_a                                dk/dsigma_a = 3 (sigma_t + sigma_a)
//   dB/dF = (8/3) / (1 - F)^2          dF/deta = 2.880 / eta^3 - 0.710 / eta^2 + 0.0636
//
// R_d is smooth in k, also where nothing is absorbed. The integral is smooth in q alone: its
// derivative with respect to sigma_a grows without bound as sigma_a -> 0. F is a fit, for eta >= 1;
// it leaves 0.0016 of a boundary that is none (eta = 1).
#pragma once

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

template <class R>
struct Dipole {
    R sigma_s, sigma_a, eta;
};

/// What all distances share.
template <class R>
struct DipoleTerms {
    R sigma_t, albedo, k, q, F, B;

    static DipoleTerms of(const Dipole<R>& m) {
        DipoleTerms w;
        w.sigma_t = m.sigma_s + m.sigma_a;
        w.albedo = m.sigma_s / w.sigma_t;
        w.k = R(3) * m.sigma_a * w.sigma_t;
        w.q = w.k > R(0) ? sqrt(w.k) : R(0);
        w.F = R(-1.440) / (m.eta * m.eta) + R(0.710) / m.eta + R(0.668) + R(0.0636) * m.eta;
        w.B = R(1) + R(4.0 / 3) * (R(1) + w.F) / (R(1) - w.F);
        return w;
    }
    /// The part of a source z mean free paths below or above the surface.
    R source(R r, R z_mean_free_paths) const {
        const R z = z_mean_free_paths / sigma_t, d2 = r * r + z * z, d = sqrt(d2);
        return z * (R(1) + q * d) * exp(-q * d) / (d2 * d);
    }
};

/// Adjoints of the same, and their way to the parameters.
template <class R>
struct DipoleTermsAdjoint {
    R d_sigma_t{R(0)}, d_albedo{R(0)}, d_k{R(0)}, d_B{R(0)};
};

template <class R>
inline void dipole_terms_backward(const Dipole<R>& m, const DipoleTerms<R>& w,
                                  const DipoleTermsAdjoint<R>& d, Dipole<R>& d_m) {
    const R square = w.sigma_t * w.sigma_t, eta2 = m.eta * m.eta, rest = R(1) - w.F;
    d_m.sigma_s += d.d_sigma_t + d.d_albedo * m.sigma_a / square + d.d_k * R(3) * m.sigma_a;
    d_m.sigma_a +=
        d.d_sigma_t - d.d_albedo * m.sigma_s / square + d.d_k * R(3) * (w.sigma_t + m.sigma_a);
    d_m.eta += d.d_B * R(8.0 / 3) / (rest * rest) *
               (R(2.880) / (eta2 * m.eta) - R(0.710) / eta2 + R(0.0636));
}

/// R_d in 1/m^2.
template <class R>
inline R dipole(const Dipole<R>& m, R r) {
    const auto w = DipoleTerms<R>::of(m);
    return R(0.079577471545947668) * w.albedo * (w.source(r, R(1)) + w.source(r, w.B));
}
template <class R>
inline void dipole_backward(const Dipole<R>& m, R r, R d_R, Dipole<R>& d_m, R& d_r) {
    const auto w = DipoleTerms<R>::of(m);
    const R scale = R(0.079577471545947668) * d_R;
    const R d_sum = scale * w.albedo;
    DipoleTermsAdjoint<R> d{};
    d.d_albedo = scale * (w.source(r, R(1)) + w.source(r, w.B));
    for (int i = 0; i < 2; ++i) {
        const R z = (i == 0 ? R(1) : w.B) / w.sigma_t;
        const R d2 = r * r + z * z, distance = sqrt(d2), faint = exp(-w.q * distance);
        const R near = R(1) + w.q * distance;
        // Of z G with respect to r, z and k; dd/dr = r / d, dd/dz = z / d.
        const R slope = -(w.k * d2 + R(3) * near) * faint / (d2 * d2 * distance) * z;
        const R d_z = d_sum * (near * faint / (d2 * distance) + slope * z);
        d_r += d_sum * slope * r;
        d.d_k -= d_sum * z * faint / (R(2) * distance);
        d.d_sigma_t -= d_z * z / w.sigma_t;
        if (i == 1) d.d_B += d_z / w.sigma_t;
    }
    dipole_terms_backward(m, w, d, d_m);
}

/// The integral of R_d over the plane: the part of the light that comes back.
template <class R>
inline R dipole_albedo(const Dipole<R>& m) {
    const auto w = DipoleTerms<R>::of(m);
    const R z = w.q / w.sigma_t;
    return R(0.5) * w.albedo * (exp(-z) + exp(-z * w.B));
}
/// For sigma_a > 0.
template <class R>
inline void dipole_albedo_backward(const Dipole<R>& m, R d_A, Dipole<R>& d_m) {
    const auto w = DipoleTerms<R>::of(m);
    const R z = w.q / w.sigma_t, first = exp(-z), second = exp(-z * w.B);
    const R half = R(0.5) * d_A, d_z = -half * w.albedo * (first + w.B * second);
    DipoleTermsAdjoint<R> d{};
    d.d_albedo = half * (first + second);
    d.d_k = d_z / (R(2) * w.q * w.sigma_t);
    d.d_sigma_t = -d_z * z / w.sigma_t;
    d.d_B = -half * w.albedo * second * z;
    dipole_terms_backward(m, w, d, d_m);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
