// Blending one splat over a row of pixels, front to back [Kerbl2023, Eq. 3].
//
// For the pixel with center (px, py), and d = mean - center:
//
//   sigma = (A dx^2 + C dy^2) / 2 + B dx dy,   G = exp(-sigma),   raw = opacity G
//   alpha = min(raw, alpha_max), dropped below alpha_min and outside of the splat's box
//   T     = product of 1 - alpha_j over the splats in front (exclusive!),   w = T alpha
//   color = sum w c + T_end background,   opacity = 1 - T_end,   depth = sum w z
//
// A pixel ends before the splat that would leave T below `stop`. Adjoint, with v = <d_color, c> +
// d_depth z and d_end = <d_color, background> - d_opacity:
//
//   d_c = w d_color,   d_z = w d_depth
//   d_alpha_k   = T_k v_k - (sum_{j>k} w_j v_j + d_end T_end) / (1 - alpha_k)
//   d_raw       = d_alpha, or 0 where alpha_max clamps
//   d_opacity   = G d_raw = -d_sigma / opacity,   d_sigma = -raw d_raw
//   d_A = dx^2 d_sigma / 2,   d_B = dx dy d_sigma,   d_C = dy^2 d_sigma / 2
//   d_mean = (A dx + B dy, B dx + C dy) d_sigma
//
// The bracket needs no list: it starts as <d_color, color> + d_depth depth - d_opacity T_end, from
// the forward result, and the backward loop, front to back again, subtracts w v of each splat.
// 1 - alpha_max bounds the division.
//
// d_B is the full derivative with respect to B, not half of it for each of two matrix entries.
// Both passes call `splat_weights`, so they drop the same pixels and end at the same splat.
#pragma once

#include "photograd/core/dual.h"
#include "photograd/core/lanes.h"
#include "photograd/splat/screen_splat.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// State of a row of lane_count pixels between two splats.
template <class R>
struct PixelRow {
    Lanes<R> T;     // behind the splats so far
    Lanes<R> live;  // 1; 0 for pixels that have ended
};

/// False where the splat is fainter than alpha_min in all pixels of the row: `splat_weights` would
/// drop it there. The exponent is a parabola in dx, smallest at dx = -B dy / A or at an end of the
/// row.
template <class R>
inline bool row_may_contribute(const ScreenSplat<R>& s, int x, int y) {
    const R right = s.x - (R(x) + R(0.5)), left = right - R(lane_count - 1);
    const R dy = s.y - (R(y) + R(0.5)), a = s.conic[0], b_dy = s.conic[1] * dy;
    // a dx at the minimum, without a division.
    const R a_dx = clamped(-b_dy, a * left, a * right);
    const R twice_a_sigma = a_dx * a_dx + R(2) * b_dy * a_dx + a * (s.conic[2] * (dy * dy));
    return !(twice_a_sigma > R(2) * a * s.sigma_max);
}

template <class R>
struct SplatWeights {
    Lanes<R> dx;
    Lanes<R> raw;    // opacity G
    Lanes<R> alpha;  // 0 where dropped
    Lanes<R> front;  // T in front of the splat
    Lanes<R> w;
    Lanes<R> visible;  // 1 where the splat contributes
    R dy;
};

/// Weights of splat s in the pixels with centers (x + i + 1/2, y + 1/2); moves `row` behind it.
template <class R>
inline void splat_weights(const ScreenSplat<R>& s, const SplatCutoffs<R>& cut, int x, int y,
                          PixelRow<R>& row, SplatWeights<R>& out) {
    const R left = s.x - (R(x) + R(0.5)), dy = s.y - (R(y) + R(0.5));
    const R half_a = R(0.5) * s.conic[0], b_dy = s.conic[1] * dy,
            c_dy = R(0.5) * s.conic[2] * (dy * dy);
    const R opacity = s.opacity;
    const R alpha_min = cut.alpha_min, alpha_max = cut.alpha_max, stop = cut.stop;
    const int first = s.x0 - x, end = s.x1 - x;
    out.dy = dy;
    for (int i = 0; i < lane_count; ++i) {
        const R dx = left - R(i);
        // Positive but for rounding, in needles thinner than numbers can hold.
        const R sigma = larger((half_a * dx + b_dy) * dx + c_dy, R(0));
        out.dx[i] = dx;
        out.raw[i] = opacity * exp(-sigma);
    }
    for (int i = 0; i < lane_count; ++i) {
        const R alpha = smaller(out.raw[i], alpha_max);
        const R inside = (i >= first) & (i < end) & (alpha >= alpha_min) ? row.live[i] : R(0);
        const R visible_alpha = alpha * inside;
        const R T = row.T[i], next = T * (R(1) - visible_alpha);
        const R continues = next < stop ? R(0) : R(1);
        out.alpha[i] = visible_alpha;
        out.front[i] = T;
        out.visible[i] = inside * continues;
        out.w[i] = T * (visible_alpha * continues);
        row.T[i] = next < stop ? T : next;
        row.live[i] = row.live[i] * continues;
    }
}

/// Color and depth of a row so far, without background.
template <class R>
struct RowSums {
    Lanes<R> color[3];
    Lanes<R> depth;
};

template <class R>
inline void blend_row(const ScreenSplat<R>& s, const SplatCutoffs<R>& cut, int x, int y,
                      PixelRow<R>& row, RowSums<R>& sums) {
    SplatWeights<R> k;
    splat_weights(s, cut, x, y, row, k);
    for (int c = 0; c < 3; ++c) {
        const R color = s.color[c];
        for (int i = 0; i < lane_count; ++i) sums.color[c][i] = sums.color[c][i] + k.w[i] * color;
    }
    for (int i = 0; i < lane_count; ++i) sums.depth[i] = sums.depth[i] + k.w[i] * s.depth;
}

/// Cotangents of a row, and the remainder of its sum.
template <class R>
struct RowCotangents {
    Lanes<R> d_color[3];
    Lanes<R> d_depth;
    Lanes<R> remainder;  // sum of w_j v_j over the splats not yet passed, + d_end T_end
};

/// Sums of one splat over rows, lane by lane; `splat_partials` turns them into derivatives.
template <class R>
struct SplatSums {
    Lanes<R> s, sx, sy, sxx, sxy, syy;  // of d_sigma, times powers of dx and dy
    Lanes<R> color[3], depth;

    // One set of lanes at a time: zeroed as a whole, this would be a call of memset for every pair.
    void clear() {
        s = sx = sy = sxx = sxy = syy = Lanes<R>::filled(R(0));
        color[0] = color[1] = color[2] = depth = Lanes<R>::filled(R(0));
    }
};

/// `sum` of core/lanes.h, in its order. gcc makes sixteen scalars of that one; these are vectors.
template <class R>
inline R sum_of(const Lanes<R>& x) {
    return sum(x);
}
inline float sum_of(const Lanes<float>& x) {
    using Four = float __attribute__((vector_size(16), may_alias));
    const Four* part = reinterpret_cast<const Four*>(x.v);
    const Four a = (part[0] + part[2]) + (part[1] + part[3]);
    return (a[0] + a[2]) + (a[1] + a[3]);
}

template <class R>
inline void blend_row_backward(const ScreenSplat<R>& s, const SplatCutoffs<R>& cut, int x, int y,
                               PixelRow<R>& row, RowCotangents<R>& back, SplatSums<R>& sums) {
    SplatWeights<R> k;
    splat_weights(s, cut, x, y, row, k);
    const R red = s.color[0], green = s.color[1], blue = s.color[2], depth = s.depth;
    const R held_slope = cut.pass_clamped ? R(1) : R(0), alpha_max = cut.alpha_max;
    Lanes<R> d_raw, d_sigma;
    for (int i = 0; i < lane_count; ++i) {
        const R v =
            ((back.d_color[0][i] * red + back.d_color[1][i] * green) + back.d_color[2][i] * blue) +
            back.d_depth[i] * depth;
        const R behind = back.remainder[i] - k.w[i] * v;
        // An opacity of exactly 1 is possible where alpha_max is off; nothing behind it counts.
        const R through = larger(R(1) - k.alpha[i], R(1e-6));
        const R d_alpha = k.front[i] * v - behind / through;
        const R slope = k.raw[i] > alpha_max ? held_slope : R(1);
        back.remainder[i] = behind;
        d_raw[i] = d_alpha * (k.visible[i] * slope);
    }
    for (int i = 0; i < lane_count; ++i) {
        d_sigma[i] = -(k.raw[i] * d_raw[i]);
        sums.s[i] = sums.s[i] + d_sigma[i];
    }
    const R dy = k.dy;
    for (int i = 0; i < lane_count; ++i) {
        const R sx = d_sigma[i] * k.dx[i], sy = d_sigma[i] * dy;
        sums.sx[i] = sums.sx[i] + sx;
        sums.sy[i] = sums.sy[i] + sy;
        sums.sxx[i] = sums.sxx[i] + sx * k.dx[i];
        sums.sxy[i] = sums.sxy[i] + sx * dy;
        sums.syy[i] = sums.syy[i] + sy * dy;
    }
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < lane_count; ++i)
            sums.color[c][i] = sums.color[c][i] + k.w[i] * back.d_color[c][i];
    for (int i = 0; i < lane_count; ++i) sums.depth[i] = sums.depth[i] + k.w[i] * back.d_depth[i];
}

/// d_splat[partial_count] = the derivatives that the sums stand for.
template <class R>
inline void splat_partials(const ScreenSplat<R>& s, const SplatSums<R>& sums, R* d_splat) {
    const R sx = sum_of(sums.sx), sy = sum_of(sums.sy);
    d_splat[partial_x] = s.conic[0] * sx + s.conic[1] * sy;
    d_splat[partial_y] = s.conic[1] * sx + s.conic[2] * sy;
    d_splat[partial_a] = R(0.5) * sum_of(sums.sxx);
    d_splat[partial_b] = sum_of(sums.sxy);
    d_splat[partial_c] = R(0.5) * sum_of(sums.syy);
    // G d_raw = -d_sigma / opacity; an opacity of 0 gives nothing to divide.
    d_splat[partial_opacity] = s.opacity > R(0) ? -(sum_of(sums.s) / s.opacity) : R(0);
    for (int c = 0; c < 3; ++c) d_splat[partial_red + c] = sum_of(sums.color[c]);
    d_splat[partial_depth] = sum_of(sums.depth);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
