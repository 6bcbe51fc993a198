// How a path tracer estimates: which directions it samples, how it weights them, when it stops.
#pragma once

#include <cstdint>

#include "photograd/render/path/sampler.h"
#include "photograd/sampling/mis.h"

namespace photograd {

/// How light is found. `light`: next event estimation; emission that a path hits counts only where
/// no emitter could be sampled (seen by the camera or after a specular bounce). `bsdf`: emission
/// that a path hits; only delta lights, which no ray hits, are sampled. `mis`: both, with weights.
enum class Strategy : int { light = 0, bsdf = 1, mis = 2 };

struct PathOptions {
    Strategy strategy = Strategy::mis;
    Heuristic heuristic = Heuristic::power;
    int max_depth = 64;     // segments of the longest path; 1: emission alone, 2: direct light
    int roulette_from = 4;  // first vertex with Russian roulette; max_depth: none
    std::uint64_t seed = 0;
    Sampler sampler = Sampler::independent;
    bool background = true;  // otherwise camera rays that escape leave no vertex
};

}  // namespace photograd
