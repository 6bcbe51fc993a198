// View-dependent color of a Gaussian [Kerbl2023]: spherical harmonics in the unit direction from
// the eye to its mean, offset by 1/2 and clamped at 0.
//
//   o = mean - eye,  d = o / |o|
//   color_c = max(0, 1/2 + sum_k Y_k(d) sh_kc)
//
// Adjoint: where the clamp holds, everything is zero (such a splat cannot come back by itself).
// With d_d from the harmonics, d_o = (d_d - d <d, d_d>) / |o|;  d_mean = d_o,  d_eye = -d_o.
#pragma once

#include "photograd/ops/sh.h"
#include "photograd/ops/unit_direction.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// d[3] = (mean - eye) / |mean - eye|; returns 1 / |mean - eye|.
template <class R>
inline R direction_from(const R* eye, const R* mean, R* d) {
    const R o[3] = {mean[0] - eye[0], mean[1] - eye[1], mean[2] - eye[2]};
    return unit_direction(o, d);
}

/// color[3]; sh is (K, 3). The mean must not be the eye.
template <int Degree, class R>
inline void splat_color(const R* eye, const R* mean, const R* sh, R* color) {
    R d[3], Y[sh_count(Degree)];
    direction_from(eye, mean, d);
    sh_basis<Degree>(d[0], d[1], d[2], Y);
    sh_color<Degree, 3>(Y, sh, color);
    for (int c = 0; c < 3; ++c) color[c] = larger(color[c] + R(0.5), R(0));
}
/// Adds to d_eye, d_mean and d_sh; `color` is what the forward pass gave.
template <int Degree, class R>
inline void splat_color_backward(const R* eye, const R* mean, const R* sh, const R* color,
                                 const R* d_color, R* d_eye, R* d_mean, R* d_sh) {
    R d[3], Y[sh_count(Degree)], d_Y[sh_count(Degree)] = {}, d_d[3] = {R(0), R(0), R(0)}, live[3];
    for (int c = 0; c < 3; ++c) live[c] = color[c] > R(0) ? d_color[c] : R(0);
    const R inverse = direction_from(eye, mean, d);
    sh_basis<Degree>(d[0], d[1], d[2], Y);
    sh_color_backward<Degree, 3>(Y, sh, live, d_Y, d_sh);
    sh_basis_backward<Degree>(d[0], d[1], d[2], d_Y, d_d);
    R d_o[3] = {R(0), R(0), R(0)};
    unit_direction_backward(d, inverse, d_d, d_o);
    for (int i = 0; i < 3; ++i) {
        d_mean[i] += d_o[i];
        d_eye[i] -= d_o[i];
    }
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
