// Stage 4: a tile of pixels, its splats front to back, and the same loop for the adjoint.
//
// The forward pass keeps five numbers per pixel. The backward pass starts from the finished image
// and runs in the same order (splat/row_blend.h), so it stores no list of contributions. What a
// splat gets from a tile goes to the slot of that pair; stage 5 sums the slots of a splat in their
// order.
#pragma once

#include "photograd/splat/row_blend.h"
#include "photograd/splat/tiles.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// Number of splats between two checks of which rows still have a live pixel.
inline constexpr int rows_checked_every = 8;

template <class R>
struct TileRows {
    PixelRow<R> row[splat_tile_size];
    bool alive[splat_tile_size];
    int rows;  // inside of the picture

    void start(int x, int y, int width, int height) {
        rows = smaller(splat_tile_size, height - y);
        for (int r = 0; r < rows; ++r) {
            alive[r] = true;
            row[r].T = Lanes<R>::filled(R(1));
            for (int i = 0; i < lane_count; ++i) row[r].live[i] = x + i < width ? R(1) : R(0);
        }
    }
    /// False once no pixel is left.
    bool check() {
        bool any = false;
        for (int r = 0; r < rows; ++r) {
            R live = R(0);
            for (int i = 0; i < lane_count; ++i) live = larger(live, row[r].live[i]);
            alive[r] = live > R(0);
            any = any || alive[r];
        }
        return any;
    }
};

/// visit(pair, splat, first row, end of rows) for the tile's splats until no pixel is left; returns
/// where it ended.
template <class R, class Visit>
inline const TilePair* walk_tile(const BlendArgs<R>& a, const TilePairs& pairs, int y,
                                 TileRows<R>& tile, Visit&& visit) {
    for (const TilePair* pair = pairs.begin; pair != pairs.end; ++pair) {
        if ((pair - pairs.begin) % rows_checked_every == 0 && !tile.check()) return pair;
        if (pairs.end - pair > 4) __builtin_prefetch(a.splats + pair[4].splat);
        const ScreenSplat<R>& s = a.splats[pair->splat];
        visit(*pair, s, larger(s.y0 - y, 0), smaller(s.y1 - y, tile.rows));
    }
    return pairs.end;
}

/// Pixels (x .. x + splat_tile_size, y .. y + splat_tile_size) of the picture, written once.
template <class R>
inline void blend_tile(const BlendArgs<R>& a, const TilePairs& pairs, int x, int y) {
    TileRows<R> tile;
    RowSums<R> sums[splat_tile_size] = {};
    tile.start(x, y, a.width, a.height);
    walk_tile(a, pairs, y, tile, [&](const TilePair&, const ScreenSplat<R>& s, int first, int end) {
        for (int r = first; r < end; ++r)
            if (tile.alive[r] && row_may_contribute(s, x, y + r))
                blend_row(s, a.cut, x, y + r, tile.row[r], sums[r]);
    });
    const int columns = smaller(splat_tile_size, a.width - x);
    for (int r = 0; r < tile.rows; ++r) {
        const std::int64_t first = static_cast<std::int64_t>(y + r) * a.width + x;
        for (int i = 0; i < columns; ++i) {
            const R T = tile.row[r].T[i];
            for (int c = 0; c < 3; ++c)
                a.image.color[3 * (first + i) + c] = sums[r].color[c][i] + T * a.background[c];
            a.image.opacity[first + i] = R(1) - T;
            a.image.depth[first + i] = sums[r].depth[i];
        }
    }
}

template <class R>
inline void start_row(const BlendArgs<R>& a, const ImageCotangents<R>& d, int columns,
                      std::int64_t first, RowCotangents<R>& row) {
    row = RowCotangents<R>{};
    for (int i = 0; i < columns; ++i) {
        const std::int64_t pixel = first + i;
        for (int c = 0; c < 3; ++c) row.d_color[c][i] = d.d_color[3 * pixel + c];
        row.d_depth[i] = d.d_depth[pixel];
        row.remainder[i] = start_remainder(a.image, d, pixel);
    }
}

/// Writes the partials of the tile's pairs. `a` holds the picture that blend_tile wrote.
template <class R>
inline void blend_tile_backward(const BlendArgs<R>& a, const BlendBackward<R>& b,
                                const TilePairs& pairs, int x, int y) {
    TileRows<R> tile;
    RowCotangents<R> back[splat_tile_size];
    tile.start(x, y, a.width, a.height);
    for (int r = 0; r < tile.rows; ++r)
        start_row(a, b.d_image, smaller(splat_tile_size, a.width - x),
                  static_cast<std::int64_t>(y + r) * a.width + x, back[r]);
    const TilePair* end = walk_tile(
        a, pairs, y, tile, [&](const TilePair& pair, const ScreenSplat<R>& s, int first, int last) {
            SplatSums<R> sums;
            sums.clear();
            for (int r = first; r < last; ++r)
                if (tile.alive[r] && row_may_contribute(s, x, y + r))
                    blend_row_backward(s, a.cut, x, y + r, tile.row[r], back[r], sums);
            splat_partials(s, sums,
                           b.partials + partial_count * static_cast<std::int64_t>(pair.slot));
        });
    for (const TilePair* pair = end; pair != pairs.end; ++pair)
        for (int j = 0; j < partial_count; ++j)
            b.partials[partial_count * static_cast<std::int64_t>(pair->slot) + j] = R(0);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
