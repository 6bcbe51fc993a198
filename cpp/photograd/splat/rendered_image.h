// The output of a renderer of Gaussians for each pixel or ray, and its cotangents. The data are
// the same in every instruction set.
#pragma once

#include <cstdint>

#include "photograd/core/isa.h"

namespace photograd {

template <class R>
struct RenderedImage {
    R* color;    // (P, 3), with the background
    R* opacity;  // (P,)
    R* depth;    // (P,) sum of weight times distance, in meters
};

template <class R>
struct ImageCotangents {
    const R *d_color, *d_opacity, *d_depth;
};

inline namespace PHOTOGRAD_ISA {

/// <d_color, color> + d_depth depth - d_opacity T_end: the remainder with which the backward walk
/// of pixel p starts (row_blend.h, ray_blend.h).
template <class R>
inline R start_remainder(const RenderedImage<R>& image, const ImageCotangents<R>& d,
                         std::int64_t p) {
    R whole = d.d_depth[p] * image.depth[p] - d.d_opacity[p] * (R(1) - image.opacity[p]);
    for (int c = 0; c < 3; ++c) whole = whole + d.d_color[3 * p + c] * image.color[3 * p + c];
    return whole;
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
