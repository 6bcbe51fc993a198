#include "photograd/texture/texture_plan.h"

#include "photograd/texture/scatter_texels.h"

namespace photograd {

template <Real R>
TexturePlan<R>::TexturePlan(const TextureShape& shape, int channels, const R* uv, const R* target,
                            std::int64_t count)
    : shape_(shape), channels_(channels), count_(count) {
    bins_ = bin_points(TextureTiles::of(shape), uv, count, [](std::int64_t) { return true; });
    with_channels(channels, [&](auto fixed) { sort<decltype(fixed)::value>(bins_, uv, target); });
    bins_.order = {};
}

template <Real R>
template <int C>
void TexturePlan<R>::sort(const OwnerBins& bins, const R* uv, const R* target) {
    points_ = std::make_unique_for_overwrite<std::byte[]>(static_cast<std::size_t>(count_) *
                                                          sizeof(Point<C>));
    auto* points = reinterpret_cast<Point<C>*>(points_.get());
    for_point_chunks(count_, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t n = begin; n < end; ++n) {
            if (n + 16 < end) {  // points of a tile come from far apart
                const std::int64_t soon = bins.order[static_cast<std::size_t>(n + 16)];
                __builtin_prefetch(uv + 2 * soon);
                __builtin_prefetch(target + C * soon);
            }
            const std::int64_t i = bins.order[static_cast<std::size_t>(n)];
            const TexelAxis<R> column = texel_axis(uv[2 * i], shape_.width);
            const TexelAxis<R> row = texel_axis(uv[2 * i + 1], shape_.height);
            Point<C>& point = *new (points + n) Point<C>{column.fraction, row.fraction, {}, 0};
            for (int c = 0; c < C; ++c) point.target[c] = target[C * i + c];
            point.texel = row.base % texel_tile_cells * texel_tile_shape.width +
                          column.base % texel_tile_cells;
        }
    });
}

template <Real R>
template <int C>
double TexturePlan<R>::tile_loss(int tile, const R* texels, R* d_texels) const {
    constexpr int stride = texel_tile_stride<C>;
    const TextureTiles tiles = TextureTiles::of(shape_);
    const auto* points = reinterpret_cast<const Point<C>*>(points_.get());
    const auto k = static_cast<std::size_t>(tile);
    const R scale = static_cast<R>(2.0 / (static_cast<double>(count_) * C));
    TexelTile<R, C> value = {}, sum = {};
    load_texel_tile(tiles, tile, texels, value);
    double squares[stride] = {};
    for (std::size_t n = bins_.begin[k]; n < bins_.begin[k + 1]; ++n) {
        const Point<C>& point = points[n];
        // The four texels lie in the tile at `texel` whatever their row and column.
        const TexelAxis<R> column{point.texel, point.f, R(0)}, row{0, point.g, R(0)};
        R color[stride], d_color[stride];
        bilinear<R, stride>(value.texels, texel_tile_shape, column, row, color);
        for (int c = 0; c < stride; ++c) {  // the padding, where all is zero, fills the lanes
            const R error = color[c] - point.target[c];
            squares[c] += static_cast<double>(error) * static_cast<double>(error);
            d_color[c] = scale * error;
        }
        bilinear_backward<R, stride>(texel_tile_shape, column, row, d_color, sum.texels);
    }
    flush_texel_tile(tiles, tile, sum, d_texels);
    double total = 0;
    for (const double sum_of_channel : squares) total += sum_of_channel;
    return total;
}

template <Real R>
double TexturePlan<R>::loss_and_gradient(const R* texels, R* d_texels) const {
    const TextureTiles tiles = TextureTiles::of(shape_);
    std::vector<double> losses(static_cast<std::size_t>(tiles.count()), 0.0);
    with_channels(channels_, [&](auto fixed) {
        for_each_owner(tiles, bins_, [&](int tile) {
            losses[static_cast<std::size_t>(tile)] =
                tile_loss<decltype(fixed)::value>(tile, texels, d_texels);
        });
    });
    double loss = 0;
    for (const double part : losses) loss += part;
    return loss / (static_cast<double>(count_) * channels_);
}

template class TexturePlan<float>;
template class TexturePlan<double>;

}  // namespace photograd
