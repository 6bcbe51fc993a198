// Blending the Gaussians along a ray, nearest first [Kerbl2023, Eq. 3; MoenneLoccoz2024].
//
//   raw   = opacity exp(-q / 2),   alpha = min(raw, alpha_max)
//   T     = product of 1 - alpha_j over the crossings in front (exclusive!),   w = T alpha
//   color = sum w c + T_end background,   opacity = 1 - T_end,   depth = sum w t
//
// A ray ends before the crossing that would leave T below `stop`. The adjoint is that of
// splat/row_blend.h for one ray instead of a row of pixels: with v = <d_color, c> + d_depth t and
// d_end = <d_color, background> - d_opacity,
//
//   d_c = w d_color,   d_t = w d_depth
//   d_alpha_k = T_k v_k - (sum_{j>k} w_j v_j + d_end T_end) / (1 - alpha_k)
//   d_raw     = d_alpha, or 0 where alpha_max clamps
//
// The bracket needs no list: it starts as <d_color, color> + d_depth depth - d_opacity T_end, from
// the finished ray, and a second walk from the front subtracts w v of each crossing.
#pragma once

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// Discontinuities of a ray; each can be switched off, or finite differences would mean nothing.
template <class R>
struct RayCutoffs {
    R alpha_min;  // fainter crossings are dropped; 0: off
    R alpha_max;  // 1: off
    R stop;       // 0: off
};

/// A ray so far: its sums are without background.
template <class R>
struct RaySums {
    R T = R(1);
    R color[3] = {R(0), R(0), R(0)};
    R depth = R(0);
};

/// False, and nothing done, if the ray ends before this crossing.
template <class R>
inline bool blend_crossing(const RayCutoffs<R>& cut, R raw, const R* color, R t, RaySums<R>& ray) {
    const R alpha = smaller(raw, cut.alpha_max);
    const R next = ray.T * (R(1) - alpha);
    if (next < cut.stop) return false;
    const R w = ray.T * alpha;
    for (int c = 0; c < 3; ++c) ray.color[c] += w * color[c];
    ray.depth += w * t;
    ray.T = next;
    return true;
}

/// Cotangents of a ray, and where its second walk stands.
template <class R>
struct RayBack {
    R d_color[3], d_depth;
    R remainder;  // sum of w_j v_j over the crossings not yet passed, + d_end T_end
    R T = R(1);
};

/// Derivatives of one crossing; that of its color is w d_color.
template <class R>
struct CrossingAdjoint {
    R w, d_raw, d_t;
};

/// False if the ray ended before this crossing.
template <class R>
inline bool blend_crossing_backward(const RayCutoffs<R>& cut, R raw, const R* color, R t,
                                    RayBack<R>& ray, CrossingAdjoint<R>& out) {
    const R alpha = smaller(raw, cut.alpha_max);
    const R next = ray.T * (R(1) - alpha);
    if (next < cut.stop) return false;
    out.w = ray.T * alpha;
    const R v =
        ((ray.d_color[0] * color[0] + ray.d_color[1] * color[1]) + ray.d_color[2] * color[2]) +
        ray.d_depth * t;
    ray.remainder -= out.w * v;
    // An opacity of exactly 1 is possible where alpha_max is off; nothing behind it counts.
    const R d_alpha = ray.T * v - ray.remainder / larger(R(1) - alpha, R(1e-6));
    out.d_raw = raw > cut.alpha_max ? R(0) : d_alpha;
    out.d_t = out.w * ray.d_depth;
    ray.T = next;
    return true;
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
