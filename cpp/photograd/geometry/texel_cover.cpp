#include "photograd/geometry/texel_cover.h"

#include <algorithm>
#include <cmath>

#include "photograd/core/vec.h"

namespace photograd {
namespace {

// A center on the edge between two triangles belongs to both, whatever rounding says; one this far
// inside of two, in parts of a triangle, means that the mesh lies on itself.
constexpr double on_the_edge = 1e-9, well_inside = 1e-6;

double area(const Vec2<double>& x, const Vec2<double>& y) { return x.x * y.y - x.y * y.x; }

double margin(double s, double t) { return std::min({s, t, 1 - s - t}); }

/// Texels of an axis of n whose centers lie between two coordinates, [first, last].
struct CenterRange {
    int first, last;
    CenterRange(double low, double high, int n)
        : first(static_cast<int>(std::clamp(std::ceil(low * n - 0.5 - 1e-6), 0.0, double(n)))),
          last(static_cast<int>(
              std::clamp(std::floor(high * n - 0.5 + 1e-6), -1.0, double(n - 1)))) {}
};

void cover_face(const Vec2<double> (&corner)[3], std::int32_t number, const TextureShape& shape,
                TexelCover& cover) {
    const Vec2<double> b = corner[1] - corner[0], c = corner[2] - corner[0];
    const double whole = area(b, c);
    if (whole == 0) return;
    const auto [u_low, u_high] = std::minmax({corner[0].x, corner[1].x, corner[2].x});
    const auto [v_low, v_high] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
    const CenterRange rows(v_low, v_high, shape.height), columns(u_low, u_high, shape.width);
    for (int i = rows.first; i <= rows.last; ++i)
        for (int j = columns.first; j <= columns.last; ++j) {
            const Vec2<double> q =
                Vec2<double>((j + 0.5) / shape.width, (i + 0.5) / shape.height) - corner[0];
            const double s = area(q, c) / whole, t = area(b, q) / whole;
            if (margin(s, t) < -on_the_edge) continue;
            const auto texel = static_cast<std::size_t>(i) * static_cast<std::size_t>(shape.width) +
                               static_cast<std::size_t>(j);
            double* weights = &cover.weights[2 * texel];
            if (cover.face[texel] < 0) {
                cover.face[texel] = number;
                weights[0] = s;
                weights[1] = t;
            } else if (margin(s, t) > well_inside && margin(weights[0], weights[1]) > well_inside) {
                ++cover.contested;
            }
        }
}

}  // namespace

TexelCover cover_texels(std::span<const float> uv, std::span<const std::uint32_t> faces,
                        const TextureShape& shape) {
    const auto texels = static_cast<std::size_t>(shape.texels());
    TexelCover cover{std::vector<std::int32_t>(texels, -1), std::vector<double>(2 * texels, 0.0)};
    for (std::size_t f = 0; 3 * f < faces.size(); ++f) {
        Vec2<double> corner[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t at = 2 * static_cast<std::size_t>(faces[3 * f + k]);
            corner[k] = {static_cast<double>(uv[at]), static_cast<double>(uv[at + 1])};
        }
        cover_face(corner, static_cast<std::int32_t>(f), shape, cover);
    }
    return cover;
}

}  // namespace photograd
