// How a path tracer estimates: which directions it tries, how it weighs them, and when it stops.
#pragma once

#include <cstdint>

#include "photograd/render/sample_numbers.h"
#include "photograd/sampling/mis.h"

namespace photograd {

/// Both ways to find a light, alone and together. `light` asks a light, and counts what a path meets by chance only
/// where no light can be asked (seen by the camera, or through a smooth surface); `bsdf` counts what it meets, and
/// asks only delta lights, which cannot be met; `mis` does both and shares out the weight [Veach1995].
enum class Strategy : int { light = 0, bsdf = 1, mis = 2 };

struct PathOptions {
    Strategy strategy = Strategy::mis;
    Heuristic heuristic = Heuristic::power;
    int max_depth = 64;  // segments of the longest path; 1 sees lights alone, 2 is direct light
    int roulette_from =
        4;  // the first vertex at which a path may end by chance; max_depth: none does
    std::uint64_t seed = 0;
    Sampler sampler = Sampler::independent;
};

}  // namespace photograd
