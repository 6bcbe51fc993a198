// Normalized diffusion: light that leaves a surface at a distance r from where it enters, as a sum
// of two exponentials that was fitted to random walks [Christensen2015].
//
//   R(r) = A / (8 pi D r) (exp(-r / D) + exp(-r / (3 D))),    D = mean_free_path / s(A)
//   C(r) = 1 - exp(-r / D) / 4 - (3/4) exp(-r / (3 D))        part of the light within r
//
// A is the albedo of the surface: R integrates to A over the plane, whatever D is. There are three
// fits of s, for light that enters and for the length that is given:
//
//   searchlight         a thin beam along the normal; free path in the volume, 1 / sigma_t
//                         s = 1.85 - A + 7 |A - 0.8|^3                                     [Eq. 5]
//   diffuse             light from all sides; free path in the volume
//                         s = 1.9 - A + 3.5 (A - 0.8)^2                                    [Eq. 6]
//   diffuse_free_path   light from all sides; diffuse free path along the surface
//                         s = 3.5 + 100 (A - 0.33)^4
//
// With y = r / D and d_D = dL/dD,
//
//   dR/dr = -R / r - A / (8 pi D^2 r) (exp(-y) + exp(-y / 3) / 3)        dR/dA = R / A at fixed D
//   dR/dD = -R / D + A y / (8 pi D^2 r) (exp(-y) + exp(-y / 3) / 3)
//   dC/dr = (exp(-y) + exp(-y / 3)) / (4 D)                              dC/dD = -y dC/dr
//   dD/dmean_free_path = 1 / s           dD/dA = -D s'(A) / s
//
// C has an inverse in closed form: x = exp(-r / (3 D)) solves x^3 + 3 x = 4 v, v = 1 - u, a cubic
// with one real root. Four steps of Newton from 4 v / (3 + v^2) find it to rounding, also as
// v -> 0, where the root as a difference of cube roots has no digits left. r = -3 D ln x has none
// as u -> 0; there one more step, for C = u, brings them. By implicit differentiation,
//
//   dr/du = 4 D / (x + x^3)              dr/dD = r / D
#pragma once

#include "photograd/core/log.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

enum class DiffusionFit : int { searchlight, diffuse, diffuse_free_path };

/// s of the surface's albedo.
template <class R>
inline R diffusion_scaling(DiffusionFit fit, R A) {
    if (fit == DiffusionFit::diffuse_free_path) {
        const R c = (A - R(0.33)) * (A - R(0.33));
        return R(3.5) + R(100) * c * c;
    }
    const R c = A - R(0.8);
    if (fit == DiffusionFit::diffuse) return R(1.9) - A + R(3.5) * c * c;
    return R(1.85) - A + R(7) * c * c * (c < R(0) ? -c : c);
}
template <class R>
inline void diffusion_scaling_backward(DiffusionFit fit, R A, R d_s, R& d_A) {
    if (fit == DiffusionFit::diffuse_free_path) {
        const R c = A - R(0.33);
        d_A += d_s * R(400) * c * c * c;
        return;
    }
    const R c = A - R(0.8);
    if (fit == DiffusionFit::diffuse)
        d_A += d_s * (R(7) * c - R(1));
    else
        d_A += d_s * (R(21) * c * (c < R(0) ? -c : c) - R(1));
}

template <class R>
struct NormalizedDiffusion {
    R albedo, mean_free_path;

    [[nodiscard]] R length(DiffusionFit fit) const {
        return mean_free_path / diffusion_scaling(fit, albedo);
    }
};

/// Adds what dL/dD is of the parameters.
template <class R>
inline void diffusion_length_backward(DiffusionFit fit, const NormalizedDiffusion<R>& m, R d_D,
                                      NormalizedDiffusion<R>& d_m) {
    const R s = diffusion_scaling(fit, m.albedo), per_s = d_D / s;
    d_m.mean_free_path += per_s;
    diffusion_scaling_backward(fit, m.albedo, -per_s * m.mean_free_path / s, d_m.albedo);
}

/// R in 1/m^2 for r > 0; it grows as 1 / r towards the point of entry.
template <class R>
inline R normalized_diffusion(DiffusionFit fit, const NormalizedDiffusion<R>& m, R r) {
    const R D = m.length(fit), y = r / D;
    return m.albedo * R(0.039788735772973834) * (exp(-y) + exp(-y / R(3))) / (D * r);
}
template <class R>
inline void normalized_diffusion_backward(DiffusionFit fit, const NormalizedDiffusion<R>& m, R r,
                                          R d_R, NormalizedDiffusion<R>& d_m, R& d_r) {
    const R D = m.length(fit), y = r / D, near = exp(-y), far = exp(-y / R(3));
    const R scale = d_R * R(0.039788735772973834) / (D * r), whole = scale * (near + far);
    const R fall = scale * (near + far / R(3)) * m.albedo;
    d_m.albedo += whole;
    d_r -= whole * m.albedo / r + fall / D;
    diffusion_length_backward(fit, m, (fall * y - whole * m.albedo) / D, d_m);
}

/// The part of the light that leaves within r, of what leaves at all.
template <class R>
inline R diffusion_cdf(DiffusionFit fit, const NormalizedDiffusion<R>& m, R r) {
    const R y = r / m.length(fit);
    return R(-0.25) * (expm1(-y) + R(3) * expm1(-y / R(3)));
}
template <class R>
inline void diffusion_cdf_backward(DiffusionFit fit, const NormalizedDiffusion<R>& m, R r, R d_C,
                                   NormalizedDiffusion<R>& d_m, R& d_r) {
    const R D = m.length(fit), y = r / D;
    const R slope = d_C * (exp(-y) + exp(-y / R(3))) / (R(4) * D);
    d_r += slope;
    diffusion_length_backward(fit, m, -slope * y, d_m);
}

/// r / D where the cdf is u, 0 <= u < 1.
template <class R>
inline R diffusion_quantile(R u) {
    const R v = R(1) - u;
    R x = R(4) * v / (R(3) + v * v);
    for (int step = 0; step < 4; ++step)
        x -= (x * (x * x + R(3)) - R(4) * v) / (R(3) * (x * x + R(1)));
    const R y = R(-3) * log(x);
    if (!(u < R(0.5))) return y;
    return y + (R(4) * u + expm1(-y) + R(3) * expm1(-y / R(3))) / (exp(-y) + exp(-y / R(3)));
}

/// The distance within which a part u of the light leaves: the inverse of diffusion_cdf.
template <class R>
inline R sample_diffusion_radius(DiffusionFit fit, const NormalizedDiffusion<R>& m, R u) {
    return m.length(fit) * diffusion_quantile(u);
}
template <class R>
inline void sample_diffusion_radius_backward(DiffusionFit fit, const NormalizedDiffusion<R>& m, R u,
                                             R d_r, NormalizedDiffusion<R>& d_m, R& d_u) {
    const R y = diffusion_quantile(u);
    d_u += d_r * R(4) * m.length(fit) / (exp(-y) + exp(-y / R(3)));
    diffusion_length_backward(fit, m, y * d_r, d_m);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
