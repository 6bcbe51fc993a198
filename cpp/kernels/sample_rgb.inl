// A block of points goes through three passes: a check that all are finite, positions, lookups. The
// texels of a block are prefetched while the block before is computed, for textures that do not fit
// into the second-level cache.
#pragma once

#include "kernels/sample_rgb.h"
#include "photograd/ops/bilinear.h"

namespace photograd::PHOTOGRAD_ISA {

inline constexpr int sample_block = 32;

struct LocatedPoints {
    int texel[sample_block];  // upper left of the four, in scalars
    float w00[sample_block], w01[sample_block], w10[sample_block], w11[sample_block];
};

// True if none of 2 n bit patterns is that of an infinity or a NaN. Compared as integers: this file
// is compiled for finite numbers only, and would hide the others.
static inline bool all_finite(const float* numbers, int n) {
    std::uint32_t found = 0;
    for (int i = 0; i < n; ++i) {
        const std::uint32_t bits = __builtin_bit_cast(std::uint32_t, numbers[i]);
        found |= (bits & 0x7f800000u) == 0x7f800000u ? 1u : 0u;
    }
    return found == 0;
}

static inline void locate_points(const SampleRgbArgs& a, const float* uv, int n,
                                 LocatedPoints& out) {
    const int width = a.width, height = a.height;
    for (int i = 0; i < n; ++i) {
        const TexelAxis<float> column = texel_axis(uv[2 * i], width);
        const TexelAxis<float> row = texel_axis(uv[2 * i + 1], height);
        const BilinearWeights<float> w = BilinearWeights<float>::of(column.fraction, row.fraction);
        out.w00[i] = w.w00;
        out.w01[i] = w.w01;
        out.w10[i] = w.w10;
        out.w11[i] = w.w11;
        out.texel[i] = 3 * (row.base * width + column.base);
    }
}

// The two texels of a row may lie on two cache lines.
static inline void prefetch_points(const SampleRgbArgs& a, long long down, int n,
                                   const LocatedPoints& at) {
    for (int i = 0; i < n; ++i) {
        const float* texel = a.texels + at.texel[i];
        __builtin_prefetch(texel);
        __builtin_prefetch(texel + 5);
        __builtin_prefetch(texel + down);
        __builtin_prefetch(texel + down + 5);
    }
}

using Rgb4 = float __attribute__((vector_size(16), aligned(4), may_alias));

// The two texels of a row are six neighboring floats: two vectors of four that overlap, the second
// one turned. The fourth lane holds no meaning.
static inline Rgb4 look_up_rgb(const float* above, const float* below, const LocatedPoints& at,
                               int i) {
    const auto load = [](const float* p) { return *reinterpret_cast<const Rgb4*>(p); };
    const auto turned = [&](const float* p) {
        const Rgb4 x = load(p);
        return __builtin_shufflevector(x, x, 1, 2, 3, 3);
    };
    const Rgb4 t00 = load(above), t01 = turned(above + 2);
    const Rgb4 t10 = load(below), t11 = turned(below + 2);
    return ((at.w00[i] * t00 + at.w01[i] * t01) + at.w10[i] * t10) + at.w11[i] * t11;
}

// Colors of points [begin, end); false, with some of them not written, if a coordinate is not
// finite.
static bool sample_rgb(const SampleRgbArgs& a, std::int64_t begin, std::int64_t end) {
    LocatedPoints blocks[2];
    const long long down = a.height > 1 ? 3LL * a.width : 0;
    const auto length = [end](std::int64_t from) {
        return static_cast<int>(smaller<std::int64_t>(sample_block, end - from));
    };
    const auto prepare = [&](std::int64_t from, LocatedPoints& block) {
        const int n = length(from);
        if (!all_finite(a.uv + 2 * from, 2 * n)) return false;
        locate_points(a, a.uv + 2 * from, n, block);
        prefetch_points(a, down, n, block);
        return true;
    };
    if (begin < end && !prepare(begin, blocks[0])) return false;
    int k = 0;
    for (std::int64_t from = begin; from < end; from += sample_block, k ^= 1) {
        const std::int64_t next = from + sample_block;
        if (next < end && !prepare(next, blocks[k ^ 1])) return false;
        const LocatedPoints& at = blocks[k];
        // The last point's fourth float is not ours to write.
        const int n = length(from), whole = next < end ? n : n - 1;
        float* out = a.color + 3 * from;
        for (int i = 0; i < whole; ++i) {
            const float* above = a.texels + at.texel[i];
            *reinterpret_cast<Rgb4*>(out + 3 * i) = look_up_rgb(above, above + down, at, i);
        }
        if (whole < n) {
            const float* above = a.texels + at.texel[whole];
            const Rgb4 color = look_up_rgb(above, above + down, at, whole);
            for (int c = 0; c < 3; ++c) out[3 * whole + c] = color[c];
        }
    }
    return true;
}

}  // namespace photograd::PHOTOGRAD_ISA
