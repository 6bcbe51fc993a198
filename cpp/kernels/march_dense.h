// The fused march through a dense grid (float): what the kernel gets and gives. Plain data only, because
// every instruction set's translation unit includes it.
//
// The staged form, for any field and any Real, is photograd/render/march/march.h; the two are tested to agree
// bit for bit.
#pragma once

#include <cstdint>

#include "photograd/grid/brick.h"

namespace photograd {

/// Rays that advance together through a march; kernels take at most this many.
inline constexpr std::int64_t march_chunk = 32;

struct MarchDenseArgs {
    const float* values;  // (X, Y, Z, 4): raw colour, raw density
    int shape[3];
    float lo[3], scale[3];  // voxel coordinate q = (p - lo) * scale - 0.5
    int border, density_activation, color_activation, quadrature;
    float density_scale;
    float dt;
    float tau_stop;  // a ray ends behind the sub-block in which its optical depth exceeds this
    const float* origins;       // (R, 3)
    const float* directions;    // (R, 3)
    const float* t0;            // (R,) sample k lies at t0 + (k + 1/2) dt
    const std::int32_t* count;  // (R,)
    float* color;               // (R, 3) without background
    float* transmittance;       // (R,) behind the last sample
    float* depth;               // (R,)
};

struct MarchDenseBackward {
    const float* d_color;               // (R, 3)
    const float* d_depth;               // (R,)
    const float* d_transmittance;       // (R,)
    const std::int64_t* sample_offset;  // (rays of the slab + 1,) first sample of each ray in d_raw
    std::int64_t first_ray;             // the ray that sample_offset[0] belongs to
    float* d_raw;                       // (samples of the slab, 4)
};

/// Consecutive samples of one ray whose cells lie in one brick.
struct BrickRun {
    std::uint32_t brick, ray, k, count;
    std::uint32_t sample;  // of sample k, in d_raw
};

}  // namespace photograd
