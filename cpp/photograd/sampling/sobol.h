// Owen-scrambled Sobol' points [Sobol1967; Owen1995]: random, and of low discrepancy.
//
// Sobol' points are digits in base 2. Coordinate d of point i is the exclusive or of direction
// numbers v^d_k over the bits k of i that are set. The first 2^m points have one point in each of
// many sets of 2^m boxes of equal volume, for every m, so samples may be added at any time; a mean
// of smooth integrands then errs by about N^(-3/2), and one of edges by N^(-3/4), instead of
// N^(-1/2). v^d = m_k 2^(31-k) follows from a primitive polynomial over the bits [Joe2008, Sec. 1];
// the four used here are x, x + 1, x^2 + x + 1 and x^3 + x + 1.
//
// Scrambling makes them random: each digit is flipped or not, by chance, for each choice of the
// digits before it. Every coordinate of every point is then uniform, means are unbiased, and the
// boxes keep their one point each. The flips of all 32 digits are one hash that carries from low to
// high bits only, on the number with its bits reversed [Laine2011, Burley2020, Sec. 4]. The same
// hash on the index shuffles the order of the points, so that sets of four coordinates with keys of
// their own may be put side by side [Burley2020, Sec. 5].
//
// The keys are Philox words of (seed, step, pixel, block): a pixel has its own scrambling in each
// block of dimensions.
#pragma once

#include "photograd/core/random.h"

namespace photograd {

constexpr std::uint32_t reversed_bits(std::uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x & 0x0F0F0F0Fu) << 4) | ((x >> 4) & 0x0F0F0F0Fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

/// Flips each bit of x by what the bits below it and the key say. Sums, odd factors and exclusive
/// ors with even multiples carry upwards only; these constants flip with less bias than those first
/// proposed [Vegdahl2021].
constexpr std::uint32_t flip_upwards(std::uint32_t x, std::uint32_t key) {
    x ^= x * 0x3D20ADEAu;
    x += key;
    x *= (key >> 16) | 1u;
    x ^= x * 0x05526C56u;
    return x ^ (x * 0x53A22864u);
}

namespace sobol_detail {

/// Direction numbers of one coordinate: of a polynomial of degree s whose inner coefficients are
/// the bits of a.
struct Directions {
    std::uint32_t v[32] = {};

    constexpr Directions(int s, std::uint32_t a, Philox4 m) {
        for (int k = 0; k < 32; ++k) {
            if (k < s || s == 0) {
                v[k] = (s == 0 ? 1u : m[static_cast<std::size_t>(k)]) << (31 - k);
                continue;
            }
            v[k] = v[k - s] ^ (v[k - s] >> s);
            for (int j = 1; j < s; ++j)
                if ((a >> (s - 1 - j)) & 1u) v[k] ^= v[k - j];
        }
    }
};

/// Sums over the four bytes of an index whose bits are reversed, of points whose bits are reversed.
struct ByteTables {
    Philox4 entry[4][256] = {};

    constexpr ByteTables() {
        constexpr Directions d[4] = {{1, 0, {1}}, {0, 0, {}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}};
        for (std::size_t byte = 0; byte < 4; ++byte)
            for (std::uint32_t value = 0; value < 256; ++value)
                for (std::size_t bit = 0; bit < 8; ++bit)
                    if ((value >> bit) & 1u)
                        for (std::size_t c = 0; c < 4; ++c)
                            entry[byte][value][c] ^= reversed_bits(d[c].v[31 - (8 * byte + bit)]);
    }
};
inline constexpr ByteTables byte_tables;

}  // namespace sobol_detail

/// The points of one pixel in one block of four dimensions.
class SobolSampler {
public:
    SobolSampler() = default;
    SobolSampler(RandomKey key, std::uint32_t block) {
        key.sample = 0xFFFFFFFFu;  // the pixel's own numbers; samples are counted from 0
        digits_ = random_block(key, 2 * block);
        order_ = random_block(key, 2 * block + 1)[0];
    }

    /// Words of point `sample`. Words 0 and 1 are the pair of least discrepancy, 1 and 2 the next.
    [[nodiscard]] Philox4 words(std::uint32_t sample) const {
        const auto& entry = sobol_detail::byte_tables.entry;
        const std::uint32_t i = flip_upwards(reversed_bits(sample), order_);
        Philox4 out{};
        for (std::size_t c = 0; c < 4; ++c) {
            const std::uint32_t x = entry[0][i & 255u][c] ^ entry[1][(i >> 8) & 255u][c] ^
                                    entry[2][(i >> 16) & 255u][c] ^ entry[3][i >> 24][c];
            out[c] = reversed_bits(flip_upwards(x, digits_[c]));
        }
        return out;
    }

private:
    Philox4 digits_{};
    std::uint32_t order_ = 0;
};

}  // namespace photograd
