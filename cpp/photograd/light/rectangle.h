// Detects pairs of triangles that form a rectangle, which can be sampled by solid angle.
#pragma once

#include <optional>

#include "photograd/light/quad_light.h"

namespace photograd {

/// The rectangle that two triangles make, corners first (3) and second (3) counterclockwise seen
/// from the same side; nothing if they make none. Corners are compared exactly: they come from the
/// same list of vertices.
inline std::optional<QuadLight<double>> rectangle_of(const Vec3<double>* first,
                                                     const Vec3<double>* second) {
    // Some corner p of the first lies off the common edge, whose ends are q and r; s is the corner
    // across.
    for (int i = 0; i < 3; ++i) {
        const Vec3<double>&p = first[i], &q = first[(i + 1) % 3], &r = first[(i + 2) % 3];
        for (int j = 0; j < 3; ++j) {
            if (second[(j + 1) % 3] != r || second[(j + 2) % 3] != q) continue;
            const Vec3<double> x = q - p, y = r - p, gap = second[j] - (p + x + y);
            const double x2 = dot(x, x), y2 = dot(y, y), xy = dot(x, y);
            constexpr double rounding = 1e-12;  // of vertices in float, squared
            const bool square = xy * xy <= rounding * x2 * y2;
            if (square && dot(gap, gap) <= rounding * (x2 + y2))
                return QuadLight<double>{Vec3<double>(1), p, x, y};
        }
    }
    return {};
}

}  // namespace photograd
