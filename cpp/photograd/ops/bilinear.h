// Bilinear interpolation in a texture T[row, column] with texels as values at their centers.
//
// Texture coordinates (u, v) lie in [0, 1], v points down, and the center of texel i of n lies at
// (i + 0.5) / n. Along one axis, x = u for columns and v for rows:
//
//   q = clamp(x n - 0.5, 0, n - 1),  base = floor(q),  f = q - base
//   df/dx = n, 0 where q is clamped
//
// so that outside of the outermost centers the border value continues. With f along the columns and
// g along the rows, the four texels and their weights are
//
//   value = w00 T00 + w01 T01 + w10 T10 + w11 T11
//   w00 = (1 - f)(1 - g),  w01 = f (1 - g),  w10 = (1 - f) g,  w11 = f g
//
//   dvalue/dT00 = w00, ...
//   dvalue/du = W ((1 - g)(T01 - T00) + g (T11 - T10))
//   dvalue/dv = H ((1 - f)(T10 - T00) + f (T11 - T01))
//
// The value is linear in T. As a function of the point it has kinks at the centers; there the side
// of growing x counts. `base` is at most n - 2, so that its right neighbor exists; an axis with a
// single texel is constant.
#pragma once

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

struct TextureShape {
    int height, width;

    [[nodiscard]] long long texels() const { return static_cast<long long>(height) * width; }
};

/// Two neighboring texels along one axis, `base` and `base + 1`.
template <class R>
struct TexelAxis {
    int base;
    R fraction;  // of the way from the first to the second
    R slope;     // d fraction / dx: texels along the axis, or 0 where the point is clamped
};

template <class R>
inline TexelAxis<R> texel_axis(R x, int n) {
    const R last = R(n - 1);
    const R q = x * R(n) - R(0.5);
    // In this order of arguments a NaN becomes 0: whatever comes in, `base` names a texel.
    const R inside = smaller(last, larger(R(0), q));
    const int base = larger(smaller(to_int(inside), n - 2), 0);
    return {base, inside - R(base), q >= R(0) && q < last ? R(n) : R(0)};
}

/// Offsets in scalars from the upper left of the four texels; 0 along an axis that has but one.
template <int C>
struct TexelSteps {
    long long right, down;

    static TexelSteps of(const TextureShape& shape) {
        return {shape.width > 1 ? C : 0,
                shape.height > 1 ? static_cast<long long>(shape.width) * C : 0};
    }
};

template <class R>
struct BilinearWeights {
    R w00, w01, w10, w11;

    static BilinearWeights of(R f, R g) {
        const R left = R(1) - f, above = R(1) - g;
        return {left * above, f * above, left * g, f * g};
    }
};

/// out[c] = interpolated value of channel c; texels (H, W, C).
template <class R, int C>
inline void bilinear(const R* texels, const TextureShape& shape, const TexelAxis<R>& column,
                     const TexelAxis<R>& row, R* out) {
    const TexelSteps<C> step = TexelSteps<C>::of(shape);
    const BilinearWeights<R> w = BilinearWeights<R>::of(column.fraction, row.fraction);
    const R* t = texels + (static_cast<long long>(row.base) * shape.width + column.base) * C;
    for (int c = 0; c < C; ++c)
        out[c] = ((w.w00 * t[c] + w.w01 * t[step.right + c]) + w.w10 * t[step.down + c]) +
                 w.w11 * t[step.down + step.right + c];
}

/// d_texels (H, W, C) += d_out weighted like the texels.
template <class R, int C>
inline void bilinear_backward(const TextureShape& shape, const TexelAxis<R>& column,
                              const TexelAxis<R>& row, const R* d_out, R* d_texels) {
    const TexelSteps<C> step = TexelSteps<C>::of(shape);
    const BilinearWeights<R> w = BilinearWeights<R>::of(column.fraction, row.fraction);
    R* d = d_texels + (static_cast<long long>(row.base) * shape.width + column.base) * C;
    // Texel by texel: the channels of one are neighbors in memory and turn into lanes.
    for (int c = 0; c < C; ++c) d[c] += w.w00 * d_out[c];
    for (int c = 0; c < C; ++c) d[step.right + c] += w.w01 * d_out[c];
    for (int c = 0; c < C; ++c) d[step.down + c] += w.w10 * d_out[c];
    for (int c = 0; c < C; ++c) d[step.down + step.right + c] += w.w11 * d_out[c];
}

/// d_uv (2,) += <d_out, dvalue/du> and <d_out, dvalue/dv>.
template <class R, int C>
inline void bilinear_uv_backward(const R* texels, const TextureShape& shape,
                                 const TexelAxis<R>& column, const TexelAxis<R>& row,
                                 const R* d_out, R* d_uv) {
    const TexelSteps<C> step = TexelSteps<C>::of(shape);
    const R f = column.fraction, g = row.fraction;
    const R* t = texels + (static_cast<long long>(row.base) * shape.width + column.base) * C;
    R along_u = R(0), along_v = R(0);
    for (int c = 0; c < C; ++c) {
        const R t00 = t[c], t01 = t[step.right + c];
        const R t10 = t[step.down + c], t11 = t[step.down + step.right + c];
        along_u += d_out[c] * ((R(1) - g) * (t01 - t00) + g * (t11 - t10));
        along_v += d_out[c] * ((R(1) - f) * (t10 - t00) + f * (t11 - t01));
    }
    d_uv[0] += column.slope * along_u;
    d_uv[1] += row.slope * along_v;
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
