// Trilinear lookups in a mip map, and the level of a footprint [Williams1983; Heckbert1989].
//
// A pixel's footprint in the texture is, to first order, the parallelogram of the derivatives of
// (u, v) along the picture's x and y. Its level is that of the longer side, in texels of level 0:
//
//   rho = max(|(W du/dx, H dv/dx)|, |(W du/dy, H dv/dy)|),   level = max(log2 rho, 0)
//
// so the footprint is about one texel wide there; across its shorter side the picture is blurred
// more than it would have to be (isotropic filtering). Between the levels the lookup is linear:
//
//   l = clamp(level, 0, last),  k = floor(l),  t = l - k
//   value = (1 - t) B_k(uv) + t B_k+1(uv)        B_k: bilinear lookup in level k
//
//   dvalue/dB_k = 1 - t,  dvalue/dB_k+1 = t,  dvalue/dlevel = B_k+1 - B_k, 0 where it is clamped
//
// The level is held constant in what derives it from a footprint.
#pragma once

#include <cstdint>
#include <span>

#include "photograd/texture/image.h"

namespace photograd {

/// The levels from fine to coarse, of one number of channels.
template <class T>
using MipView = std::span<const ImageView<T>>;

/// level (N,) of footprints (N, 2, 2): du/dx, dv/dx, du/dy, dv/dy.
template <Real R>
void mip_level(const TextureShape& shape, const R* footprint, std::int64_t count, R* level);

/// color (N, C) at the points uv (N, 2) and level (N,).
template <Real R>
void sample_mips(MipView<const R> mips, const R* uv, const R* level, std::int64_t count, R* color);

/// The levels of d_mips, d_uv (N, 2) and d_level (N,) are added to; the latter two may both be
/// null.
template <Real R>
void sample_mips_backward(MipView<const R> mips, const R* uv, const R* level, std::int64_t count,
                          const R* d_color, MipView<R> d_mips, R* d_uv, R* d_level);

}  // namespace photograd
