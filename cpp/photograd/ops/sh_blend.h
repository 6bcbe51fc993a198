// Color of a point in a sparse cell: what each of the eight corners shows in the ray's direction,
// blended.
//
//   p_nc = sum_k Y_k v_nkc,   color_c = sum_n w_n p_nc     v_n: K x 3 coefficients of corner n
//
//   d_v_nkc = Y_k (w_n d_color_c)
//
// A ray has one direction, so p_n is the same for all of its samples around a voxel, and so is Y in
// the derivative: both are sums over (ray, voxel) instead of (sample, corner), of which there are
// three times as many.
//
// Coefficients lie as [k][c], so that the 3 K numbers of a corner are one run of memory. The sum
// over k is kept apart for 12 neighboring numbers (four k, three channels) and folded at the end:
// the order in which a vector kernel adds, and this scalar form with it, bit for bit.
#pragma once

#include "photograd/ops/sh.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

inline constexpr int sh_fold = 12;  // numbers whose sums are kept apart

/// Y of a direction, each value three times (3 K): the layout of the coefficients.
template <int Degree, class R>
inline void sh_basis_by_channel(const R* direction, R* Y3) {
    R Y[sh_count(Degree)];
    sh_basis<Degree>(direction[0], direction[1], direction[2], Y);
    for (int k = 0; k < sh_count(Degree); ++k)
        for (int c = 0; c < 3; ++c) Y3[3 * k + c] = Y[k];
}

/// color[c] = sum_k Y_k v_kc, folded as described above; `count` is 3 K.
template <class R>
inline void fold_color(const R* v, const R* Y3, int count, R* color) {
    R part[sh_fold] = {};
    const int whole = count / sh_fold * sh_fold;
    for (int j = 0; j < whole; ++j) {
        R& p = part[j % sh_fold];
        p = p + Y3[j] * v[j];
    }
    for (int c = 0; c < 3; ++c) {
        color[c] = ((part[c] + part[3 + c]) + part[6 + c]) + part[9 + c];
        if (whole < count) color[c] = color[c] + Y3[whole + c] * v[whole + c];
    }
}

/// b[0 .. count) = sum over corners of w_n corner[n], in the order of n.
template <class R>
inline void blend_corners(const R* const* corner, const R* w, int count, R* b) {
    for (int j = 0; j < count; ++j) {
        R total = w[0] * corner[0][j];
        for (int n = 1; n < 8; ++n) total = total + w[n] * corner[n][j];
        b[j] = total;
    }
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
