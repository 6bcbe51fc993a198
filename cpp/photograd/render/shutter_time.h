// The moment at which a path sees the world: from 0, when the shutter opens, to 1, when it closes
// [Cook1984].
#pragma once

#include "photograd/render/sample_numbers.h"

namespace photograd {

/// By the first number of a block that no vertex has. The camera, surfaces and media that move agree on it, since it is
/// a function of the path's key.
inline double sample_time(const RandomKey& key, SampleNumbers& numbers) {
    constexpr std::uint32_t shutter_block = 1u << 16;
    return uniform_from<double>(numbers(key, shutter_block)[0]);
}

}  // namespace photograd
