// Ambient occlusion in screen space: samples of obscurance (ops/obscurance.h) on a disk around each
// pixel.
//
//   s_i = pixel + radius w alpha_i (f_x cos theta_i, f_y sin theta_i),  alpha_i = ((i + 1/2) / N)^d
//   occlusion = 1 - strength / N sum_i a(q(s_i) - p, n)
//
// w = 1 / depth at the pixel; q(s) is the point of the frame at s, from 1 / depth interpolated
// bilinearly, which is exact on planes: a flat wall is not occluded by itself. theta_i follows a
// spiral [McGuire2012], turned by one of sixteen angles in each square of 4 x 4 pixels. The result
// is not limited from below. It is continuous in all numbers, and so has whole derivatives.
#pragma once

#include "photograd/frame/screen.h"

namespace photograd {

inline constexpr int max_ssao_samples = 256;

template <class R>
struct SsaoSettings {
    R radius, falloff, bias, distribution, strength;
};

/// out (H, W), 1 where nothing is seen.
template <Real R>
void ssao(const ScreenFrame<R>& frame, const SsaoSettings<R>& settings, int samples, R* out);

/// Adds to d_settings, in the order of SsaoSettings.
template <Real R>
void ssao_backward(const ScreenFrame<R>& frame, const SsaoSettings<R>& settings, int samples,
                   const R* d_out, R* d_settings);

}  // namespace photograd
