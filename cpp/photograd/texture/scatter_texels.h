// Scattering the contributions of many points to the four texels around each: the adjoint of a
// batch of lookups.
#pragma once

#include "photograd/texture/texel_tile.h"

namespace photograd {

/// Points are handled in pieces of this many, whatever the number of threads.
inline constexpr std::int64_t point_chunk = 4096;

/// Calls visit(begin, end) for pieces of [0, count).
template <class Visit>
void for_point_chunks(std::int64_t count, Visit&& visit) {
    parallel_for((count + point_chunk - 1) / point_chunk, [&](std::int64_t chunk) {
        visit(chunk * point_chunk, std::min(count, (chunk + 1) * point_chunk));
    });
}

/// Points uv (N, 2) by the tile that owns them, each tile's in their order. Points with keep(i)
/// false stand behind the last tile.
template <Real R, class Keep>
OwnerBins bin_points(const TextureTiles& tiles, const R* uv, std::int64_t count, Keep&& keep) {
    std::vector<std::uint32_t> owner(static_cast<std::size_t>(count));
    for_point_chunks(count, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            const int column = texel_axis(uv[2 * i], tiles.shape.width).base;
            const int row = texel_axis(uv[2 * i + 1], tiles.shape.height).base;
            owner[static_cast<std::size_t>(i)] =
                static_cast<std::uint32_t>(keep(i) ? tiles.owner(row, column) : tiles.count());
        }
    });
    OwnerBins bins;
    bin_by_owner(owner, tiles.count() + 1, bins);
    return bins;
}

/// The axis of a point, counted from the first texel of its tile.
template <class R>
TexelAxis<R> in_tile(TexelAxis<R> axis, int first) {
    axis.base -= first;
    return axis;
}

/// d_texels (H, W, C) += for each binned point i: weight(i) d_color[i], spread over its texels.
template <Real R, int C, class Weight>
void scatter_texels(const TextureTiles& tiles, const OwnerBins& bins, const R* uv, const R* d_color,
                    Weight&& weight, R* d_texels) {
    constexpr int stride = texel_tile_stride<C>;
    for_each_owner(tiles, bins, [&](int tile) {
        TexelTile<R, C> sum = {};
        const auto k = static_cast<std::size_t>(tile);
        for (std::size_t n = bins.begin[k]; n < bins.begin[k + 1]; ++n) {
            const std::int64_t i = bins.order[n];
            R d_out[stride] = {};
            for (int c = 0; c < C; ++c) d_out[c] = weight(i) * d_color[C * i + c];
            bilinear_backward<R, stride>(
                texel_tile_shape,
                in_tile(texel_axis(uv[2 * i], tiles.shape.width), tiles.first_column(tile)),
                in_tile(texel_axis(uv[2 * i + 1], tiles.shape.height), tiles.first_row(tile)),
                d_out, sum.texels);
        }
        flush_texel_tile(tiles, tile, sum, d_texels);
    });
}

}  // namespace photograd
