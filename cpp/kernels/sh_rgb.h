// Spherical-harmonic colors of many points, three channels of float: what the kernel gets. Plain
// data only, because every instruction set's translation unit includes it. The scalar form is in
// ops/sh_batch.h; the two are tested to agree bit for bit.
#pragma once

#include <cstdint>

namespace photograd {

struct ShRgbArgs {
    int degree;                 // 1 to 4, K = (degree + 1)^2
    const float* directions;    // (N, 3)
    const float* coefficients;  // (N, K, 3)
};

struct ShRgbBackward {
    const float* d_colors;  // (N, 3)
    float* d_directions;    // (N, 3)
    float* d_coefficients;  // (N, K, 3)
    bool add;               // to what stands there; else it is overwritten, and never read
};

}  // namespace photograd
