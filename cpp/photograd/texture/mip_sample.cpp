#include "photograd/texture/mip_sample.h"

#include "photograd/texture/mip_lookup.h"
#include "photograd/texture/scatter_texels.h"

namespace photograd {
namespace {

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
            level[i] =
                static_cast<R>(level_of_squared(larger(squared_length(d), squared_length(d + 2))));
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
        if (!d_uv) return;
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
