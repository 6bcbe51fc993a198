// Russian roulette [Arvo1990]: a path of low throughput ends by chance, and what survives with
// probability q is divided by q, so that the estimate stays unbiased.
#pragma once

#include <algorithm>

#include "photograd/core/vec.h"

namespace photograd {

/// q of a path with throughput beta: its largest channel, between 0.05 and 0.95.
template <class R>
R survival_probability(const Vec3<R>& beta) {
    return std::clamp(std::max({beta.x, beta.y, beta.z}), R(0.05), R(0.95));
}

}  // namespace photograd
