// The random numbers of a path: independent ones, or points that are stratified over the samples of
// a pixel.
#pragma once

#include "photograd/sampling/sobol.h"

namespace photograd {

/// `independent`: words of Philox. `sobol`: Owen-scrambled Sobol' points (sampling/sobol.h):
/// every number is uniform as well, but the samples of a pixel are no longer independent of one
/// another, and their mean has a lower variance than their spread suggests.
enum class Sampler : int { independent = 0, sobol = 1 };

/// Words of a block of four dimensions. Caches the scrambling of the last pixel and block: paths
/// that are traced side by side are mostly of one pixel. Seed and step must not change between
/// calls.
class PathSampler {
public:
    PathSampler() = default;
    explicit PathSampler(Sampler sampler) : sampler_(sampler) {}

    Philox4 operator()(const RandomKey& key, std::uint32_t block) {
        if (sampler_ == Sampler::independent) return random_block(key, block);
        if (!known_ || key.pixel != pixel_ || block != block_) {
            points_ = SobolSampler(key, block);
            pixel_ = key.pixel;
            block_ = block;
            known_ = true;
        }
        return points_.words(key.sample);
    }

private:
    Sampler sampler_ = Sampler::independent;
    bool known_ = false;
    std::uint32_t pixel_ = 0, block_ = 0;
    SobolSampler points_;
};

}  // namespace photograd
