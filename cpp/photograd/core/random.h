// Counter-based random numbers: Philox4x32-10 [Salmon2011].
//
// A random number is a function of (seed, step, pixel, sample, dimension). There is no state: a
// replayed path, a resumed fit and a run on another number of threads all see the same numbers.
// photograd_course.random is the same definition in NumPy; a test compares the two.
#pragma once

#include <array>
#include <cstdint>

namespace photograd {

using Philox4 = std::array<std::uint32_t, 4>;

/// Ten rounds of Philox on a 128-bit counter with a 64-bit key.
constexpr Philox4 philox4x32(Philox4 c, std::uint32_t key0, std::uint32_t key1) {
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t a = 0xD2511F53ull * c[0];
        const std::uint64_t b = 0xCD9E8D57ull * c[2];
        c = {static_cast<std::uint32_t>(b >> 32) ^ c[1] ^ key0, static_cast<std::uint32_t>(b),
             static_cast<std::uint32_t>(a >> 32) ^ c[3] ^ key1, static_cast<std::uint32_t>(a)};
        key0 += 0x9E3779B9u;
        key1 += 0xBB67AE85u;
    }
    return c;
}

/// What a random number depends on, except its dimension.
struct RandomKey {
    std::uint64_t seed = 0;
    std::uint32_t step = 0;
    std::uint32_t pixel = 0;
    std::uint32_t sample = 0;
};

/// The words of dimensions 4 block .. 4 block + 3.
constexpr Philox4 random_block(const RandomKey& key, std::uint32_t block) {
    return philox4x32({key.pixel, key.sample, key.step, block},
                      static_cast<std::uint32_t>(key.seed),
                      static_cast<std::uint32_t>(key.seed >> 32));
}

/// Uniform in [0, 1), a multiple of 2^-24: the same number in float and in double.
template <class R>
constexpr R uniform_from(std::uint32_t word) {
    return static_cast<R>(word >> 8) * R(1.0 / 16777216.0);
}

template <class R>
constexpr R uniform(const RandomKey& key, std::uint32_t dimension) {
    return uniform_from<R>(random_block(key, dimension / 4)[dimension % 4]);
}

}  // namespace photograd
