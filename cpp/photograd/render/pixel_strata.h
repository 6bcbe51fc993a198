// Stratified random points for the samples of a pixel.
//
// The unit square is cut into as many cells as there are samples, as square as their number allows; every
// sample draws its point inside of a cell of its own. Position in the pixel, direction to the sun and
// direction to the sky each use such a set. A random affine permutation of the sample numbers for the
// second and third keeps the sets from moving in step [Cook1986].
#pragma once

#include <numeric>

#include "photograd/core/random.h"
#include "photograd/core/vec.h"

namespace photograd {

template <class R>
struct SamplePoints {
    Vec2<R> pixel, sun, sky;
};

class PixelStrata {
public:
    PixelStrata(std::uint64_t seed, std::uint32_t pixel, std::uint32_t samples)
        : key_{seed, 0, pixel, 0}, samples_(samples), columns_(widest_divisor(samples)) {
        RandomKey own = key_;
        own.sample = 0xffffffffu;  // the pixel's own numbers; samples are counted from 0
        const Philox4 words = random_block(own, 0);
        sun_ = {coprime(words[0]), words[1] % samples};
        sky_ = {coprime(words[2]), words[3] % samples};
    }

    template <class R>
    [[nodiscard]] SamplePoints<R> draw(std::uint32_t sample) const {
        RandomKey key = key_;
        key.sample = sample;
        const Philox4 a = random_block(key, 0), b = random_block(key, 1);
        return {in_cell<R>(sample, a[0], a[1]), in_cell<R>(sun_.of(sample, samples_), a[2], a[3]),
                in_cell<R>(sky_.of(sample, samples_), b[0], b[1])};
    }

private:
    struct Permutation {
        std::uint32_t factor = 1, shift = 0;
        [[nodiscard]] std::uint32_t of(std::uint32_t i, std::uint32_t n) const {
            return static_cast<std::uint32_t>((static_cast<std::uint64_t>(i) * factor + shift) % n);
        }
    };

    static std::uint32_t widest_divisor(std::uint32_t n) {
        std::uint32_t best = 1;
        for (std::uint32_t d = 1; d * d <= n; ++d)
            if (n % d == 0) best = d;
        return best;
    }
    [[nodiscard]] std::uint32_t coprime(std::uint32_t word) const {
        std::uint32_t a = 1 + word % samples_;
        while (std::gcd(a, samples_) != 1) ++a;
        return a;
    }
    template <class R>
    [[nodiscard]] Vec2<R> in_cell(std::uint32_t cell, std::uint32_t x, std::uint32_t y) const {
        const std::uint32_t rows = samples_ / columns_;
        const std::uint32_t column = cell % columns_, row = cell / columns_;
        return {(R(column) + uniform_from<R>(x)) / R(columns_),
                (R(row) + uniform_from<R>(y)) / R(rows)};
    }

    RandomKey key_;
    std::uint32_t samples_, columns_;
    Permutation sun_, sky_;
};

}  // namespace photograd
