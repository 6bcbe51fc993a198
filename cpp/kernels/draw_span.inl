// A triangle's depth test along a row of pixels, with lanes for neighbors.
#include <limits>

#include "kernels/draw_span.h"

namespace photograd::PHOTOGRAD_ISA {

/// The depth at the center of pixel x; infinite where the triangle is not seen.
inline double span_depth(const DrawSpan& s, int x) {
    const double center = x + 0.5;
    const double w0 = s.slope[0] * center + s.offset[0];
    const double w1 = s.slope[1] * center + s.offset[1];
    const double w2 = s.slope[2] * center + s.offset[2];
    const double z = s.det / (w0 + w1 + w2);
    const bool inside = (w0 > s.least[0]) & (w1 > s.least[1]) & (w2 > s.least[2]);
    return inside & (z >= s.near) & (z <= s.far) ? z : std::numeric_limits<double>::max();
}

void draw_span(const DrawSpan& given) {
    const DrawSpan s = given;  // a copy, of which nothing else writes
    double* __restrict depth = s.depth;
    std::int32_t* __restrict face = s.face;
    std::int32_t* __restrict overdraw = s.overdraw;
    if (!face) {
        for (int x = s.x0; x < s.x1; ++x) {
            const double z = span_depth(s, x), held = depth[x];
            depth[x] = z < held ? (z < std::numeric_limits<double>::max() ? z : held) : held;
        }
        return;
    }
    for (int x = s.x0; x < s.x1; ++x) {
        const double z = span_depth(s, x), held = depth[x];
        const bool visible = (z < held) & (z < std::numeric_limits<double>::max());
        depth[x] = visible ? z : held;
        face[x] = visible ? s.number : face[x];
    }
    if (overdraw)
        for (int x = s.x0; x < s.x1; ++x)
            overdraw[x] += span_depth(s, x) < std::numeric_limits<double>::max();
}

}  // namespace photograd::PHOTOGRAD_ISA
