// A triangle's depth test along rows of pixels, with lanes for neighbors.
#include <limits>

#include "kernels/draw_span.h"
#include "photograd/core/isa.h"

namespace photograd::PHOTOGRAD_ISA {

// A row of a triangle: w_i = slope[i] x + offset[i], of the pixels [x0, x1).
struct TriangleRow {
    double slope[3], offset[3], least[3], det, near, far;
    int x0, x1;
};

// The depth at the center of pixel x; the largest number where the triangle is not seen.
static inline double span_depth(const TriangleRow& s, int x) {
    const double center = x + 0.5;
    const double w0 = s.slope[0] * center + s.offset[0];
    const double w1 = s.slope[1] * center + s.offset[1];
    const double w2 = s.slope[2] * center + s.offset[2];
    const double z = s.det / (w0 + w1 + w2);
    const bool inside = (w0 > s.least[0]) & (w1 > s.least[1]) & (w2 > s.least[2]);
    return inside & (z >= s.near) & (z <= s.far) ? z : std::numeric_limits<double>::max();
}

// Pixels outside of which an edge leaves nothing of the row; one more on either side than rounding
// could ask for. Of a few pixels the lanes ask all.
static inline void narrow_row(TriangleRow& row) {
    constexpr int few = 8;
    if (row.x1 - row.x0 <= few) return;
    for (int i = 0; i < 3; ++i) {
        if (row.slope[i] == 0) continue;
        const double at = -row.offset[i] / row.slope[i];  // where the edge crosses the row
        const int whole = at > row.x0 ? (at < row.x1 ? static_cast<int>(at) : row.x1) : row.x0;
        if (row.slope[i] > 0) row.x0 = larger(row.x0, whole - 2);
        if (row.slope[i] < 0) row.x1 = smaller(row.x1, whole + 3);
    }
}

static inline void draw_row(const TriangleRow& s, std::int32_t number, double* __restrict depth,
                            std::int32_t* __restrict face, std::int32_t* __restrict overdraw) {
    constexpr double nothing = std::numeric_limits<double>::max();
    if (!face) {
        for (int x = s.x0; x < s.x1; ++x) {
            const double z = span_depth(s, x), held = depth[x];
            depth[x] = z < held ? (z < nothing ? z : held) : held;
        }
        return;
    }
    if (!overdraw) {
        for (int x = s.x0; x < s.x1; ++x) {
            const double z = span_depth(s, x), held = depth[x];
            const bool visible = (z < held) & (z < nothing);
            depth[x] = visible ? z : held;
            face[x] = visible ? number : face[x];
        }
        return;
    }
    for (int x = s.x0; x < s.x1; ++x) {
        const double z = span_depth(s, x), held = depth[x];
        const bool visible = (z < held) & (z < nothing);
        depth[x] = visible ? z : held;
        face[x] = visible ? number : face[x];
        overdraw[x] += z < nothing ? 1 : 0;
    }
}

void draw_span(const DrawSpan& given) {
    const DrawSpan s = given;  // a copy, of which nothing else writes
    TriangleRow row;
    for (int i = 0; i < 3; ++i) {
        row.slope[i] = s.line[i][0];
        row.least[i] = s.least[i];
    }
    row.det = s.det;
    row.near = s.near, row.far = s.far;
    for (int y = s.y0; y < s.y1; ++y) {
        const double center = y + 0.5;
        for (int i = 0; i < 3; ++i) row.offset[i] = s.line[i][1] * center + s.line[i][2];
        row.x0 = s.x0, row.x1 = s.x1;
        narrow_row(row);
        const std::int64_t first = y * s.width;
        draw_row(row, s.number, s.depth + first, s.face ? s.face + first : nullptr,
                 s.overdraw ? s.overdraw + first : nullptr);
    }
}

}  // namespace photograd::PHOTOGRAD_ISA
