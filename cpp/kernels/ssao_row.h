// Ambient occlusion in screen space, float: what the kernel gets. Plain data only, because every
// instruction set's translation unit includes it. The scalar form is in frame/ssao.cpp; both agree
// bit for bit.
#pragma once

#include <cstdint>

namespace photograd {

struct SsaoRows {
    std::int64_t height, width;
    float fx, fy, cx, cy;                   // pixels
    const float *inverse_depth, *normals;   // (H, W), (H, W, 3)
    float radius, falloff, bias, strength;  // of SsaoSettings
    int samples;                            // N
    const float *cosine, *sine, *alpha;     // (N,) of the spiral
    const float *turn_cosine, *turn_sine;   // (4, 4) by row and column of the pixel, mod 4
    float* out;                             // (H, W)
};

}  // namespace photograd
