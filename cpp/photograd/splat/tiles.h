// Input and output of blending a tile. Plain data, because every instruction set's translation unit
// includes it.
#pragma once

#include <cstdint>

#include "photograd/splat/rendered_image.h"
#include "photograd/splat/screen_splat.h"

namespace photograd {

/// A tile is splat_tile_size x splat_tile_size pixels: a row of it is one set of lanes.
inline constexpr int splat_tile_size = 16;

/// A splat whose box touches a tile, and the slot for its partial derivatives from that tile.
struct TilePair {
    std::uint32_t splat, slot;
};

/// One tile's pairs, nearest splat first.
struct TilePairs {
    const TilePair *begin, *end;
};

template <class R>
struct BlendArgs {
    const ScreenSplat<R>* splats;
    SplatCutoffs<R> cut;
    R background[3];
    int width, height;
    RenderedImage<R> image;  // (H, W)
};

template <class R>
struct BlendBackward {
    ImageCotangents<R> d_image;  // (H, W)
    R* partials;                 // (pairs, partial_count), by slot: each is written once
};

}  // namespace photograd
