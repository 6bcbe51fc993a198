#include "photograd/texture/sample.h"

#include "photograd/texture/scatter_texels.h"

namespace photograd {
namespace {

/// Points whose texels are asked for before the first of them is computed: a texture that does not fit
/// into the second-level cache arrives while earlier points are at work.
constexpr int ahead = 32;

/// Where a few points lie: their upper left texels, and fractions along column and row.
template <Real R>
struct Located {
    const R* corner[ahead];
    R f[ahead], g[ahead];
};

template <Real R, int C>
void locate(const ImageView<const R>& texture, const R* uv, int points, Located<R>& out) {
    const auto [height, width] = texture.shape;
    int columns[ahead], rows[ahead];
    for (int i = 0; i < points; ++i) {  // turns into lanes
        const TexelAxis<R> column = texel_axis(uv[2 * i], width);
        const TexelAxis<R> row = texel_axis(uv[2 * i + 1], height);
        out.f[i] = column.fraction;
        out.g[i] = row.fraction;
        columns[i] = column.base;
        rows[i] = row.base;
    }
    const TexelSteps<C> step = TexelSteps<C>::of(texture.shape);
    for (int i = 0; i < points; ++i) {
        const R* texel =
            texture.texels + (static_cast<long long>(rows[i]) * width + columns[i]) * C;
        out.corner[i] = texel;
        // The two texels of a row may lie on two cache lines.
        __builtin_prefetch(texel);
        __builtin_prefetch(texel + step.right + C - 1);
        __builtin_prefetch(texel + step.down);
        __builtin_prefetch(texel + step.down + step.right + C - 1);
    }
}

/// One lookup whose texels begin at `corner`; writes C scalars.
template <Real R, int C>
void look_up(const TextureShape& shape, const R* corner, R f, R g, R* color) {
    bilinear<R, C>(corner, shape, {0, f, R(0)}, {0, g, R(0)}, color);
}

using Float4 = float __attribute__((vector_size(16), aligned(4), may_alias));

/// The same in the same order for three floats, a picture's texel, and at least two columns. The two
/// texels of a row are six neighbouring floats: two vectors of four that overlap, the second one turned.
/// Writes four floats, the last of them of no meaning.
void look_up_rgb(const TextureShape& shape, const float* corner, float f, float g, float* color) {
    const auto load = [](const float* p) { return *reinterpret_cast<const Float4*>(p); };
    const auto turned = [&](const float* p) {
        const Float4 x = load(p);
        return __builtin_shufflevector(x, x, 1, 2, 3, 3);
    };
    const float* below = corner + TexelSteps<3>::of(shape).down;
    const BilinearWeights<float> w = BilinearWeights<float>::of(f, g);
    const Float4 t00 = load(corner), t01 = turned(corner + 2);
    const Float4 t10 = load(below), t11 = turned(below + 2);
    *reinterpret_cast<Float4*>(color) = ((w.w00 * t00 + w.w01 * t01) + w.w10 * t10) + w.w11 * t11;
}

template <Real R, int C>
void sample_chunk(const ImageView<const R>& texture, const R* uv, std::int64_t begin,
                  std::int64_t end, R* color) {
    constexpr bool rgb = C == 3 && std::is_same_v<R, float>;
    const bool wide = texture.shape.width > 1;
    Located<R> blocks[2];
    const auto points = [&](std::int64_t from) {
        return static_cast<int>(std::min<std::int64_t>(ahead, end - from));
    };
    locate<R, C>(texture, uv + 2 * begin, points(begin), blocks[0]);
    for (std::int64_t from = begin, k = 0; from < end; from += ahead, ++k) {
        const std::int64_t next = from + ahead;
        if (next < end) locate<R, C>(texture, uv + 2 * next, points(next), blocks[(k + 1) % 2]);
        const Located<R>& at = blocks[k % 2];
        R* out = color + C * from;
        int i = 0;
        if constexpr (rgb)  // not the chunk's last point: its fourth float is not ours to write
            for (const int last = points(from) - (next < end ? 0 : 1); wide && i < last; ++i)
                look_up_rgb(texture.shape, at.corner[i], at.f[i], at.g[i], out + 3 * i);
        for (; i < points(from); ++i)
            look_up<R, C>(texture.shape, at.corner[i], at.f[i], at.g[i], out + C * i);
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
