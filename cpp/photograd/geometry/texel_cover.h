// UV rasterization: the point of a mesh that each texel of its texture shows.
//
// The center of texel (i, j) of (H, W) lies at (u, v) = ((j + 1/2) / W, (i + 1/2) / H). With a, b,
// c the coordinates of a triangle's corners and [x, y] = x_u y_v - x_v y_u, the center q is
// a + s (b - a) + t (c - a) with
//
//   s = [q - a, c - a] / [b - a, c - a],    t = [b - a, q - a] / [b - a, c - a]
//
// and the triangle covers it where s, t and 1 - s - t are not negative. The point of the surface
// has the same barycentric weights.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photograd/ops/bilinear.h"

namespace photograd {

/// Of each texel (H, W): the face that covers its center, the first one if several do, or -1; and
/// (s, t) there.
struct TexelCover {
    std::vector<std::int32_t> face;
    std::vector<double> weights;  // (H, W, 2)
    std::int64_t contested = 0;   // texels whose centers lie well inside of more than one face
};

/// uv (V, 2) and faces (F, 3). Faces whose coordinates span no area cover nothing.
TexelCover cover_texels(std::span<const float> uv, std::span<const std::uint32_t> faces,
                        const TextureShape& shape);

}  // namespace photograd
