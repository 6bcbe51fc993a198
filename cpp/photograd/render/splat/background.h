// The adjoint of what lies behind the Gaussians: color = sum w c + T_end background, T_end = 1 -
// opacity.
#pragma once

#include <algorithm>
#include <span>

#include "photograd/core/scatter.h"
#include "photograd/splat/rendered_image.h"

namespace photograd {

/// Adds to d_background[3]; the sum is taken in pieces of `chunk` pixels.
template <class R>
void background_backward(const RenderedImage<R>& image, const R* d_color, std::int64_t pixels,
                         std::int64_t chunk, R* d_background) {
    sum_partials((pixels + chunk - 1) / chunk, std::span<R>(d_background, 3),
                 [&](std::int64_t task, std::span<double> partial) {
                     const std::int64_t end = std::min(pixels, (task + 1) * chunk);
                     for (std::int64_t p = task * chunk; p < end; ++p)
                         for (std::size_t c = 0; c < 3; ++c)
                             partial[c] += static_cast<double>(d_color[3 * p + std::int64_t(c)] *
                                                               (R(1) - image.opacity[p]));
                 });
}

}  // namespace photograd
