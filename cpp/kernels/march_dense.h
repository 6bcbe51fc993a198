// The fused march through a dense grid (float): what the kernel gets and gives.
//
// The staged form, for any field and any Real, is photograd/render/march/march.h; the two are
// tested to agree bit for bit.
#pragma once

#include "kernels/march_args.h"
#include "photograd/grid/brick.h"

namespace photograd {

struct MarchDenseArgs : MarchArgs {
    const float* values;  // (X, Y, Z, 4): raw color, raw density
    int shape[3];
    int border;
};

struct MarchDenseBackward {
    MarchAdjoint<float> adjoint;
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
