#include "photograd/texture/sample.h"

#include "photograd/texture/scatter_texels.h"

namespace photograd {
namespace {

/// Points whose texels are asked for before the first of them is computed: a texture that does not fit
/// into the second-level cache arrives while earlier points are at work.
constexpr int ahead = 32;

template <Real R, int C>
struct Located {
    TexelAxis<R> column[ahead], row[ahead];

    void locate(const ImageView<const R>& texture, const R* uv, int points) {
        const auto [height, width] = texture.shape;
        const TexelSteps<C> step = TexelSteps<C>::of(texture.shape);
        for (int i = 0; i < points; ++i) column[i] = texel_axis(uv[2 * i], width);
        for (int i = 0; i < points; ++i) row[i] = texel_axis(uv[2 * i + 1], height);
        for (int i = 0; i < points; ++i) {
            const R* texel =
                texture.texels + (static_cast<long long>(row[i].base) * width + column[i].base) * C;
            __builtin_prefetch(texel);
            __builtin_prefetch(texel + step.right + C - 1);
            __builtin_prefetch(texel + step.down);
            __builtin_prefetch(texel + step.down + step.right + C - 1);
        }
    }
};

template <Real R, int C>
void sample_chunk(const ImageView<const R>& texture, const R* uv, std::int64_t begin,
                  std::int64_t end, R* color) {
    Located<R, C> blocks[2];
    const auto locate = [&](std::int64_t from, Located<R, C>& block) {
        block.locate(texture, uv + 2 * from,
                     static_cast<int>(std::min<std::int64_t>(ahead, end - from)));
    };
    locate(begin, blocks[0]);
    for (std::int64_t from = begin, k = 0; from < end; from += ahead, ++k) {
        const Located<R, C>& here = blocks[k % 2];
        if (from + ahead < end) locate(from + ahead, blocks[(k + 1) % 2]);
        for (int i = 0; i < ahead && from + i < end; ++i)
            bilinear<R, C>(texture.texels, texture.shape, here.column[i], here.row[i],
                           color + C * (from + i));
    }
}

}  // namespace

template <Real R>
void sample(const ImageView<const R>& texture, const R* uv, std::int64_t count, R* color) {
    with_channels(texture.channels, [&](auto channels) {
        for_point_chunks(count, [&](std::int64_t begin, std::int64_t end) {
            sample_chunk<R, decltype(channels)::value>(texture, uv, begin, end, color);
        });
    });
}

template <Real R>
void sample_backward(const ImageView<const R>& texture, const R* uv, std::int64_t count,
                     const R* d_color, R* d_texels, R* d_uv) {
    with_channels(texture.channels, [&](auto channels) {
        constexpr int C = decltype(channels)::value;
        if (d_texels) {
            const TextureTiles tiles = TextureTiles::of(texture.shape);
            const OwnerBins bins = bin_points(tiles, uv, count, [](std::int64_t) { return true; });
            scatter_texels<R, C>(
                tiles, bins, uv, d_color, [](std::int64_t) { return R(1); }, d_texels);
        }
        if (d_uv)
            for_point_chunks(count, [&](std::int64_t begin, std::int64_t end) {
                for (std::int64_t i = begin; i < end; ++i)
                    bilinear_uv_backward<R, C>(texture.texels, texture.shape,
                                               texel_axis(uv[2 * i], texture.shape.width),
                                               texel_axis(uv[2 * i + 1], texture.shape.height),
                                               d_color + C * i, d_uv + 2 * i);
            });
    });
}

template void sample(const ImageView<const float>&, const float*, std::int64_t, float*);
template void sample(const ImageView<const double>&, const double*, std::int64_t, double*);
template void sample_backward(const ImageView<const float>&, const float*, std::int64_t,
                              const float*, float*, float*);
template void sample_backward(const ImageView<const double>&, const double*, std::int64_t,
                              const double*, double*, double*);

}  // namespace photograd
