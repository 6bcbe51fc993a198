// What blending a tile needs and gives. Plain data, because every instruction set's translation unit
// includes it.
#pragma once

#include <cstdint>

#include "photograd/ops/screen_splat.h"

namespace photograd {

/// A tile is tile_size x tile_size pixels: a row of it is one set of lanes.
inline constexpr int tile_size = 16;

/// One tile's splats, nearest first: splat_of[order[k]] for k in [begin, end). order[k] numbers a pair
/// of splat and tile.
struct TilePairs {
    const std::uint32_t* order;
    const std::uint32_t* splat_of;
    std::int64_t begin, end;
};

template <class R>
struct BlendArgs {
    const ScreenSplat<R>* splats;
    SplatCutoffs<R> cut;
    R background[3];
    int width, height;
    R* color;    // (H, W, 3)
    R* opacity;  // (H, W)
    R* depth;    // (H, W)
};

template <class R>
struct BlendBackward {
    const R* d_color;    // (H, W, 3)
    const R* d_opacity;  // (H, W)
    const R* d_depth;    // (H, W)
    R* partials;         // (pairs, partial_count): each pair is written once
};

}  // namespace photograd
