// The principled surface at many pairs of directions, float: what the kernel gets. Plain data only,
// because every instruction set's translation unit includes it. The scalar form is
// bsdf/principled.h; both agree bit for bit.
#pragma once

#include <cstdint>

namespace photograd {

/// Evaluation n takes row n mod rows: one row serves all, or a picture's texels serve in turn.
struct PrincipledArgs {
    std::int64_t count, rows;  // N, T
    const float* parameters;   // (T, 5): base color, metalness, roughness
    const float *wo, *wi;      // (N, 3)
    bool cosine;               // whether values are times the cosine of wi
};

inline constexpr int principled_parameters = 5;

}  // namespace photograd
