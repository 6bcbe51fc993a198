// The pixels of a tile that a triangle may cover: what the kernel gets. Plain data only, because
// every instruction set's translation unit includes it. The scalar form is in
// raster/prepared_triangles.h, depth_at.
#pragma once

#include <cstdint>

namespace photograd {

/// w_i = line[i][0] x + (line[i][1] y + line[i][2]) at the center of a pixel, which is inside where
/// each is above least[i]; its depth is det / (w_0 + w_1 + w_2), which has to lie within
/// [near, far] and before what the buffer holds. Buffers have rows of `width` pixels.
struct DrawSpan {
    double line[3][3], least[3];
    double det, near, far;
    std::int32_t number;
    int x0, x1, y0, y1;  // pixels [x0, x1) x [y0, y1)
    std::int64_t width;
    std::int32_t* face;      // null to draw depth alone
    std::int32_t* overdraw;  // null for none
    double* depth;
};

}  // namespace photograd
