// Stage 3: the list of splats of each tile. A pair is a splat and a tile that its box touches.
// Pairs are listed splat by splat in depth order, then sorted by tile with a stable counting sort,
// which keeps the depth order within a tile. Slots for partial derivatives are numbered by row
// instead: those of one Gaussian are contiguous.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "photograd/core/scatter.h"
#include "photograd/splat/tiles.h"

namespace photograd {

struct TileLists {
    int columns = 0, rows = 0;              // of tiles
    std::vector<std::uint32_t> sorted;      // splats by depth
    std::vector<std::uint32_t> slots;       // first slot of each Gaussian; one more at the end
    std::vector<TilePair> pairs;            // by tile
    std::vector<std::uint32_t> pair_begin;  // first pair of each tile; one more at the end

    [[nodiscard]] TilePairs of(std::int64_t tile) const {
        const auto t = static_cast<std::size_t>(tile);
        return {pairs.data() + pair_begin[t], pairs.data() + pair_begin[t + 1]};
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
        return {s.x0 / splat_tile_size, (s.x1 + splat_tile_size - 1) / splat_tile_size,
                s.y0 / splat_tile_size, (s.y1 + splat_tile_size - 1) / splat_tile_size};
    }
    [[nodiscard]] std::int64_t count() const {
        return static_cast<std::int64_t>(x1 - x0) * (y1 - y0);
    }
};

inline constexpr std::int64_t splats_per_task = 4096;

/// Numbers the slots of `count` Gaussians; false if there are more than 32 bits can number.
template <class R>
bool number_slots(const ScreenSplat<R>* splats, std::size_t count,
                  std::vector<std::uint32_t>& slots) {
    slots.resize(count + 1);
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        slots[i] = static_cast<std::uint32_t>(sum);
        sum += TileBox::of(splats[i]).count();
        if (sum > std::int64_t{0x7fffffff}) return false;
    }
    slots[count] = static_cast<std::uint32_t>(sum);
    return true;
}

/// Fills `lists` from lists.sorted and lists.slots.
template <class R>
void bin_splats(const ScreenSplat<R>* splats, int width, int height, TileLists& lists) {
    lists.columns = (width + splat_tile_size - 1) / splat_tile_size;
    lists.rows = (height + splat_tile_size - 1) / splat_tile_size;
    const auto count = static_cast<std::int64_t>(lists.sorted.size());
    const std::size_t pairs = lists.slots.back();
    std::vector<std::uint32_t> first(lists.sorted.size() + 1, 0);
    for (std::size_t k = 0; k < lists.sorted.size(); ++k) {
        const std::uint32_t i = lists.sorted[k];
        first[k + 1] = first[k] + (lists.slots[i + 1] - lists.slots[i]);
    }
    std::vector<TilePair> listed(pairs);
    std::vector<std::uint32_t> tile_of(pairs);
    parallel_for((count + splats_per_task - 1) / splats_per_task, [&](std::int64_t task) {
        const std::int64_t end = std::min(count, (task + 1) * splats_per_task);
        for (std::int64_t k = task * splats_per_task; k < end; ++k) {
            const std::uint32_t splat = lists.sorted[static_cast<std::size_t>(k)];
            std::size_t pair = first[static_cast<std::size_t>(k)];
            std::uint32_t slot = lists.slots[splat];
            const TileBox box = TileBox::of(splats[splat]);
            for (int y = box.y0; y < box.y1; ++y)
                for (int x = box.x0; x < box.x1; ++x, ++pair) {
                    listed[pair] = {splat, slot++};
                    tile_of[pair] = static_cast<std::uint32_t>(y * lists.columns + x);
                }
        }
    });
    OwnerBins bins;
    bin_by_owner(tile_of, static_cast<int>(lists.tile_count()), bins);
    lists.pair_begin = std::move(bins.begin);
    lists.pairs.resize(pairs);
    parallel_for(lists.tile_count(), [&](std::int64_t tile) {
        const auto t = static_cast<std::size_t>(tile);
        for (std::size_t k = lists.pair_begin[t]; k < lists.pair_begin[t + 1]; ++k)
            lists.pairs[k] = listed[bins.order[k]];
    });
}

}  // namespace photograd
