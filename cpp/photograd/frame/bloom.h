// Bloom: light of bright pixels spread over their surroundings, by a pyramid of binomial blurs.
//
//   bright = max(x - threshold, 0),  y = x + sum_l w_l (U^l D^l bright - bright)
//
// D halves a picture: each axis by [1 3 3 1] / 8. U doubles it: each axis by [1 3 3 1] / 4 of its
// columns that fall together, bilinear interpolation. Beyond the edges a picture is mirrored, or
// repeats its last pixel for U. Weights of each sum to 1: a constant stays what it is.
#pragma once

#include <cstdint>

#include "photograd/core/real.h"

namespace photograd {

inline constexpr int max_bloom_levels = 16;

struct FrameSize {
    std::int64_t height, width;
};

/// out (H, W, 3) of color (H, W, 3), with one weight a level.
template <Real R>
void bloom(FrameSize size, const R* color, R threshold, const R* weights, int levels, R* out);

/// Adds to d_color, d_weights and d_threshold.
template <Real R>
void bloom_backward(FrameSize size, const R* color, R threshold, const R* weights, int levels,
                    const R* d_out, R* d_color, R* d_weights, R* d_threshold);

}  // namespace photograd
