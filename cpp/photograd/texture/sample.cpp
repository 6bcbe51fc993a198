#include "photograd/texture/sample.h"

#include <atomic>
#include <cmath>
#include <limits>

#include "kernels/kernels.h"
#include "photograd/texture/scatter_texels.h"

namespace photograd {
namespace {

template <Real R, int C>
bool sample_chunk(const ImageView<const R>& texture, const R* uv, std::int64_t begin,
                  std::int64_t end, R* color) {
    for (std::int64_t i = begin; i < end; ++i) {
        if (!std::isfinite(uv[2 * i]) || !std::isfinite(uv[2 * i + 1])) return false;
        bilinear<R, C>(texture.texels, texture.shape, texel_axis(uv[2 * i], texture.shape.width),
                       texel_axis(uv[2 * i + 1], texture.shape.height), color + C * i);
    }
    return true;
}

/// Pictures have a kernel; their offsets are counted in 32 bits there.
template <Real R, int C>
bool has_kernel(const TextureShape& shape) {
    return C == 3 && std::is_same_v<R, float> && shape.width > 1 &&
           3 * shape.texels() <= std::numeric_limits<std::int32_t>::max();
}

}  // namespace

template <Real R>
bool sample(const ImageView<const R>& texture, const R* uv, std::int64_t count, R* color) {
    std::atomic<bool> finite{true};
    with_channels(texture.channels, [&](auto channels) {
        constexpr int C = decltype(channels)::value;
        const bool fast = has_kernel<R, C>(texture.shape);
        for_point_chunks(count, [&](std::int64_t begin, std::int64_t end) {
            bool good = false;
            if constexpr (std::is_same_v<R, float>) {
                if (fast)
                    good = kernels().sample_rgb(
                        {texture.texels, texture.shape.height, texture.shape.width, uv, color},
                        begin, end);
            }
            if (!fast) good = sample_chunk<R, C>(texture, uv, begin, end, color);
            if (!good) finite = false;
        });
    });
    return finite;
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

template bool sample(const ImageView<const float>&, const float*, std::int64_t, float*);
template bool sample(const ImageView<const double>&, const double*, std::int64_t, double*);
template void sample_backward(const ImageView<const float>&, const float*, std::int64_t,
                              const float*, float*, float*);
template void sample_backward(const ImageView<const double>&, const double*, std::int64_t,
                              const double*, double*, double*);

}  // namespace photograd
