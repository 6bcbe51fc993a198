// The quantity that a path transports: radiance, traced from the camera, or the power of particles,
// traced from the emitters [Veach1997, Sec. 4.4]. The two use separate random-number dimensions.
#pragma once

#include "photograd/sampling/dimensions.h"

namespace photograd {

enum class Transport { radiance, importance };

/// Block and word of one random number.
struct Dimension {
    std::uint32_t block;
    std::size_t word;
};

/// Of vertex k.
template <Transport Mode>
struct PathDimensions {
    static constexpr bool camera = Mode == Transport::radiance;
    static constexpr std::uint32_t scatter(std::uint32_t k) {
        return camera ? dimensions::scatter_block(k) : dimensions::particle_scatter_block(k);
    }
    static constexpr Dimension opacity(std::uint32_t k) {
        if (camera) return {dimensions::light_block(k), dimensions::opacity};
        return {dimensions::particle_opacity_block(k), dimensions::particle_opacity};
    }
    static constexpr Dimension channel() {
        if (camera) return {dimensions::channel_block, dimensions::channel};
        return {dimensions::particle_direction_block, dimensions::particle_channel};
    }
    static constexpr std::uint32_t segment_step(std::uint32_t k) {
        return camera ? dimensions::segment_step(k) : dimensions::particle_segment_step(k);
    }
};

}  // namespace photograd
