// Many bilinear lookups at once, and their adjoint. The mathematics of one is in ops/bilinear.h.
#pragma once

#include <cstdint>

#include "photograd/texture/image.h"

namespace photograd {

/// color (N, C) = texture at the points uv (N, 2). False, with some colors not written, if a
/// coordinate is not finite: a NaN has no texels.
template <Real R>
[[nodiscard]] bool sample(const ImageView<const R>& texture, const R* uv, std::int64_t count,
                          R* color);

/// d_texels (H, W, C) and d_uv (N, 2) are added to; null leaves one out.
template <Real R>
void sample_backward(const ImageView<const R>& texture, const R* uv, std::int64_t count,
                     const R* d_color, R* d_texels, R* d_uv);

}  // namespace photograd
