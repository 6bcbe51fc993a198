#include "photograd/texture/mip_sample.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "photograd/texture/scatter_texels.h"

namespace photograd {
namespace {

/// log2 x for x >= 1, by our own logarithm: a library's may differ between processors in the last bit.
double log2_above_one(double x) {
    int exponent = 0;
    const double mantissa =
        std::frexp(smaller(x, std::numeric_limits<double>::max()), &exponent);  // in [1/2, 1)
    return exponent - 1 + log1p_unit(2 * mantissa - 1) / std::numbers::ln2;
}

/// Two neighbouring levels, `first` and `second`, the same one where there is but one.
template <class R>
struct LevelPair {
    int first, second;
    R t;
    bool clamped;

    static LevelPair of(R level, int levels) {
        const R last = R(levels - 1);
        const R inside = smaller(last, larger(R(0), level));
        const int first = larger(smaller(to_int(inside), levels - 2), 0);
        return {first, smaller(first + 1, levels - 1), inside - R(first),
                !(level >= R(0) && level < last)};
    }
    /// Weight of level k in the value.
    [[nodiscard]] R weight(int k) const {
        return (k == first ? R(1) - t : R(0)) + (k == second ? t : R(0));
    }
    [[nodiscard]] bool holds(int k) const { return k == first || k == second; }
};

template <Real R, int C>
void look_up(const ImageView<const R>& texture, const R* uv, R* color) {
    bilinear<R, C>(texture.texels, texture.shape, texel_axis(uv[0], texture.shape.width),
                   texel_axis(uv[1], texture.shape.height), color);
}

/// Derivatives of one lookup by its point and level.
template <Real R, int C>
void point_backward(MipView<const R> mips, const R* uv, R level, const R* d_color, R* d_uv,
                    R* d_level) {
    const LevelPair<R> pair = LevelPair<R>::of(level, static_cast<int>(mips.size()));
    R color[2][C];
    for (int end = 0; end < 2; ++end) {
        const int k = end == 0 ? pair.first : pair.second;
        const ImageView<const R>& texture = mips[static_cast<std::size_t>(k)];
        look_up<R, C>(texture, uv, color[end]);
        R share[C];
        for (int c = 0; c < C; ++c) share[c] = (end == 0 ? R(1) - pair.t : pair.t) * d_color[c];
        bilinear_uv_backward<R, C>(texture.texels, texture.shape,
                                   texel_axis(uv[0], texture.shape.width),
                                   texel_axis(uv[1], texture.shape.height), share, d_uv);
    }
    if (!pair.clamped)
        for (int c = 0; c < C; ++c) *d_level += d_color[c] * (color[1][c] - color[0][c]);
}

}  // namespace

template <Real R>
void mip_level(const TextureShape& shape, const R* footprint, std::int64_t count, R* level) {
    const double width = shape.width, height = shape.height;
    const auto squared_length = [&](const R* d) {
        const double x = width * static_cast<double>(d[0]), y = height * static_cast<double>(d[1]);
        return x * x + y * y;
    };
    for_point_chunks(count, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            const R* d = footprint + 4 * i;
            const double longest = larger(squared_length(d), squared_length(d + 2));
            // Of a footprint of at most a texel, a point for example, level 0 is wanted.
            level[i] = longest > 1 ? static_cast<R>(0.5 * log2_above_one(longest)) : R(0);
        }
    });
}

template <Real R>
void sample_mips(MipView<const R> mips, const R* uv, const R* level, std::int64_t count, R* color) {
    with_channels(mips[0].channels, [&](auto channels) {
        constexpr int C = decltype(channels)::value;
        for_point_chunks(count, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) {
                const LevelPair<R> pair = LevelPair<R>::of(level[i], static_cast<int>(mips.size()));
                R fine[C], coarse[C];
                look_up<R, C>(mips[static_cast<std::size_t>(pair.first)], uv + 2 * i, fine);
                look_up<R, C>(mips[static_cast<std::size_t>(pair.second)], uv + 2 * i, coarse);
                for (int c = 0; c < C; ++c)
                    color[C * i + c] = (R(1) - pair.t) * fine[c] + pair.t * coarse[c];
            }
        });
    });
}

template <Real R>
void sample_mips_backward(MipView<const R> mips, const R* uv, const R* level, std::int64_t count,
                          const R* d_color, MipView<R> d_mips, R* d_uv, R* d_level) {
    const int levels = static_cast<int>(mips.size());
    const auto pair = [&](std::int64_t i) { return LevelPair<R>::of(level[i], levels); };
    with_channels(mips[0].channels, [&](auto channels) {
        constexpr int C = decltype(channels)::value;
        for (int k = 0; k < levels; ++k) {
            const ImageView<R>& d_level_k = d_mips[static_cast<std::size_t>(k)];
            const TextureTiles tiles = TextureTiles::of(d_level_k.shape);
            const OwnerBins bins =
                bin_points(tiles, uv, count, [&](std::int64_t i) { return pair(i).holds(k); });
            scatter_texels<R, C>(
                tiles, bins, uv, d_color, [&](std::int64_t i) { return pair(i).weight(k); },
                d_level_k.texels);
        }
        for_point_chunks(count, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i)
                point_backward<R, C>(mips, uv + 2 * i, level[i], d_color + C * i, d_uv + 2 * i,
                                     d_level + i);
        });
    });
}

template void mip_level(const TextureShape&, const float*, std::int64_t, float*);
template void mip_level(const TextureShape&, const double*, std::int64_t, double*);
template void sample_mips(MipView<const float>, const float*, const float*, std::int64_t, float*);
template void sample_mips(MipView<const double>, const double*, const double*, std::int64_t,
                          double*);
template void sample_mips_backward(MipView<const float>, const float*, const float*, std::int64_t,
                                   const float*, MipView<float>, float*, float*);
template void sample_mips_backward(MipView<const double>, const double*, const double*,
                                   std::int64_t, const double*, MipView<double>, double*, double*);

}  // namespace photograd
