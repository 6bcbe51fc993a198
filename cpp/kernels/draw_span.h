// The pixels of one row that a triangle may cover: what the kernel gets. Plain data only, because
// every instruction set's translation unit includes it. The scalar form is in
// raster/prepared_triangles.h, depth_at.
#pragma once

#include <cstdint>

namespace photograd {

/// w_i = slope[i] x + offset[i] at the center x of a pixel, which is inside where each is above
/// least[i]; its depth is det / (w_0 + w_1 + w_2), which has to lie within [near, far] and before
/// what the buffer holds. Pointers are those of the row's first pixel.
struct DrawSpan {
    double slope[3], offset[3], least[3];
    double det, near, far;
    std::int32_t number;
    int x0, x1;
    std::int32_t* face;      // null to draw depth alone
    std::int32_t* overdraw;  // null for none
    double* depth;
};

}  // namespace photograd
