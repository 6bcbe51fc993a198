// Inputs and outputs of a march, ray by ray. Plain data, the same in every instruction set.
#pragma once

#include <cstdint>

namespace photograd {

/// Rays that advance together through a march; a kernel takes at most this many.
inline constexpr std::int64_t march_chunk = 32;

template <class R>
struct RayBatch {
    std::int64_t count;
    const R* origins;             // (R, 3)
    const R* directions;          // (R, 3) unit
    const R* t0;                  // (R,) sample k lies at t0 + (k + 1/2) dt
    const std::int32_t* samples;  // (R,)
};

/// color excludes the background: image = color + transmittance background.
template <class R>
struct MarchOutputs {
    R* color;          // (R, 3) sum of w_k c_k
    R* transmittance;  // (R,) behind the last sample; opacity = 1 - transmittance
    R* depth;          // (R,) sum of w_k t_k
};

/// Cotangents of the outputs; d_transmittance includes what reaches it through opacity and
/// background.
template <class R>
struct MarchAdjoint {
    const R* d_color;          // (R, 3)
    const R* d_transmittance;  // (R,)
    const R* d_depth;          // (R,)
    // (R, 3), added to; or null. The interior term: t0 and the number of samples are held fixed.
    R* d_origins = nullptr;
    R* d_directions = nullptr;
};

}  // namespace photograd
