// View-dependent color of a Gaussian along a ray [MoenneLoccoz2024]: spherical harmonics in the
// ray's direction, offset by 1/2 and clamped at 0.
//
//   n = d / |d|,   Y_k = Y_k(n),   color_c = max(0, 1/2 + sum_k Y_k sh_kc)
//
// Splatting takes the direction from the eye to the Gaussian's mean instead (splat/splat_color.h).
// A ray has one n, so that its Y_k are computed once for all that it crosses.
//
// Adjoint: zero where the clamp holds, else d_Y_k = sum_c sh_kc d_color_c (the ray's share),
// d_sh_kc = Y_k d_color_c (the Gaussian's);  d_d from d_n by ops/unit_direction.h.
#pragma once

#include "photograd/ops/sh.h"
#include "photograd/ops/unit_direction.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// color[3] from Y[K] and sh (K, 3).
template <int Degree, class R>
inline void ray_color(const R* Y, const R* sh, R* color) {
    sh_color<Degree, 3>(Y, sh, color);
    for (int c = 0; c < 3; ++c) color[c] = larger(color[c] + R(0.5), R(0));
}
/// The ray's share: adds to d_Y[K].
template <int Degree, class R>
inline void ray_color_backward_ray(const R* sh, const R* color, const R* d_color, R* d_Y) {
    for (int c = 0; c < 3; ++c) {
        const R live = color[c] > R(0) ? d_color[c] : R(0);
        for (int k = 0; k < sh_count(Degree); ++k) d_Y[k] += sh[3 * k + c] * live;
    }
}
/// The Gaussian's share: adds to d_sh (K, 3). `Sum` may be wider than R.
template <int Degree, class R, class Sum>
inline void ray_color_backward_gaussian(const R* Y, const R* color, const R* d_color, Sum* d_sh) {
    for (int c = 0; c < 3; ++c) {
        const R live = color[c] > R(0) ? d_color[c] : R(0);
        for (int k = 0; k < sh_count(Degree); ++k) d_sh[3 * k + c] += Sum(Y[k] * live);
    }
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
