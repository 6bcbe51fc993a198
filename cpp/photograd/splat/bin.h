// Stage 3: which splats each tile must look at. A splat and a tile that its box touches are a pair; pairs
// are numbered splat by splat in depth order, and sorted by tile with a stable counting sort, so each
// tile's list is in depth order too.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "photograd/core/scatter.h"
#include "photograd/splat/tiles.h"

namespace photograd {

struct TileLists {
    int columns = 0, rows = 0;              // of tiles
    std::vector<std::uint32_t> sorted;      // splats by depth
    std::vector<std::uint32_t> pair_begin;  // first pair of sorted[k]; one more at the end
    std::vector<std::uint32_t> splat_of;    // of each pair
    OwnerBins bins;                         // pairs by tile

    [[nodiscard]] TilePairs pairs(std::int64_t tile) const {
        const auto t = static_cast<std::size_t>(tile);
        return {bins.order.data(), splat_of.data(), bins.begin[t], bins.begin[t + 1]};
    }
    [[nodiscard]] std::int64_t tile_count() const {
        return static_cast<std::int64_t>(columns) * rows;
    }
};

/// The tiles [x0, x1) x [y0, y1) that a box of pixels touches.
struct TileBox {
    int x0, x1, y0, y1;

    template <class R>
    static TileBox of(const ScreenSplat<R>& s) {
        return {s.x0 / tile_size, (s.x1 + tile_size - 1) / tile_size, s.y0 / tile_size,
                (s.y1 + tile_size - 1) / tile_size};
    }
    [[nodiscard]] std::int64_t count() const {
        return static_cast<std::int64_t>(x1 - x0) * (y1 - y0);
    }
};

inline constexpr std::int64_t splats_per_task = 4096;

/// Fills `lists` from lists.sorted; false if there are more pairs than 32 bits can number.
template <class R>
bool bin_splats(const ScreenSplat<R>* splats, int width, int height, TileLists& lists) {
    lists.columns = (width + tile_size - 1) / tile_size;
    lists.rows = (height + tile_size - 1) / tile_size;
    const auto count = static_cast<std::int64_t>(lists.sorted.size());
    lists.pair_begin.resize(lists.sorted.size() + 1);
    std::int64_t pairs = 0;
    for (std::size_t k = 0; k < lists.sorted.size(); ++k) {
        lists.pair_begin[k] = static_cast<std::uint32_t>(pairs);
        pairs += TileBox::of(splats[lists.sorted[k]]).count();
        if (pairs > std::int64_t{0x7fffffff}) return false;
    }
    lists.pair_begin.back() = static_cast<std::uint32_t>(pairs);
    lists.splat_of.resize(static_cast<std::size_t>(pairs));
    std::vector<std::uint32_t> tile_of(static_cast<std::size_t>(pairs));
    parallel_for((count + splats_per_task - 1) / splats_per_task, [&](std::int64_t task) {
        const std::int64_t end = std::min(count, (task + 1) * splats_per_task);
        for (std::int64_t k = task * splats_per_task; k < end; ++k) {
            const std::uint32_t splat = lists.sorted[static_cast<std::size_t>(k)];
            std::size_t pair = lists.pair_begin[static_cast<std::size_t>(k)];
            const TileBox box = TileBox::of(splats[splat]);
            for (int y = box.y0; y < box.y1; ++y)
                for (int x = box.x0; x < box.x1; ++x, ++pair) {
                    lists.splat_of[pair] = splat;
                    tile_of[pair] = static_cast<std::uint32_t>(y * lists.columns + x);
                }
        }
    });
    bin_by_owner(tile_of, static_cast<int>(lists.tile_count()), lists.bins);
    return true;
}

}  // namespace photograd
