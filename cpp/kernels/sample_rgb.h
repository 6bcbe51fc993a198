// Bilinear lookups in a picture of three floats a texel: what the kernel gets. Plain data only,
// because every instruction set's translation unit includes it. The scalar form is in
// ops/bilinear.h; the two are tested to agree bit for bit.
#pragma once

#include <cstdint>

namespace photograd {

struct SampleRgbArgs {
    const float* texels;  // (H, W, 3), at least two columns
    int height, width;
    const float* uv;  // (N, 2)
    float* color;     // (N, 3)
};

}  // namespace photograd
