// Blending in float: the loops of photograd/splat/tile_blend.h, one row of a tile a set of lanes,
// compiled for this instruction set. The double twin of the same loops is compiled in
// photograd/render/splat/splat.cpp.
#pragma once

#include "photograd/splat/tile_blend.h"

namespace photograd::PHOTOGRAD_ISA {

static void blend_tile_float(const BlendArgs<float>& args, const TilePairs& pairs, int x, int y) {
    blend_tile(args, pairs, x, y);
}

static void blend_tile_backward_float(const BlendArgs<float>& args,
                                      const BlendBackward<float>& back, const TilePairs& pairs,
                                      int x, int y) {
    blend_tile_backward(args, back, pairs, x, y);
}

}  // namespace photograd::PHOTOGRAD_ISA
