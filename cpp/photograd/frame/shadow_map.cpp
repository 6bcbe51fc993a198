#include "photograd/frame/shadow_map.h"

#include <cmath>

#include "photograd/frame/chunk_sums.h"

namespace photograd {
namespace {

Vec3<double> pixels_of(const ShadowView& view, const Vec3<double>& p) {
    const auto& m = view.pixels_from_world;
    return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3],
            m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
            m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}
bool is_inside(const Vec3<double>& q, int size) {
    return q.z > 0 && q.x >= 0 && q.y >= 0 && q.x < size * q.z && q.y < size * q.z;
}

/// Part of the texels around the point that the light sees behind it, or at it.
double lit_part(const ShadowView& view, const ShadowFilter& filter, const Vec3<double>& q) {
    const int column = static_cast<int>(q.x / q.z), row = static_cast<int>(q.y / q.z);
    const double depth = q.z - filter.depth_bias;
    int lit = 0, taps = 0;
    if (const int r = filter.radius, inner = filter.size - r;
        column >= r && row >= r && column < inner && row < inner) {
        const double* first = view.depth + std::int64_t{row - r} * filter.size + column - r;
        for (int y = 0; y <= 2 * r; ++y, first += filter.size)
            for (int x = 0; x <= 2 * r; ++x) lit += depth <= first[x];
        return double(lit) / ((2 * r + 1) * (2 * r + 1));
    }
    for (int y = row - filter.radius; y <= row + filter.radius; ++y)
        for (int x = column - filter.radius; x <= column + filter.radius; ++x) {
            if (x < 0 || y < 0 || x >= filter.size || y >= filter.size) continue;
            ++taps;
            lit += depth <= view.depth[std::int64_t{y} * filter.size + x];
        }
    return double(lit) / taps;
}

}  // namespace

template <Real R>
void shadow_lookup(std::span<const ShadowView> views, const ShadowFilter& filter,
                   std::int64_t count, const R* points, const R* normals, R* visibility) {
    for_chunks(count, [&](std::int64_t, std::int64_t first, std::int64_t last) {
        for (std::int64_t i = first; i < last; ++i) {
            const Vec3<double> point(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
            const Vec3<double> normal(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
            visibility[i] = R(1);
            if (normal == Vec3<double>(0.0)) continue;  // no surface
            for (const ShadowView& view : views) {
                const Vec3<double> q = pixels_of(view, point);
                if (!is_inside(q, filter.size)) continue;
                const double moved = filter.normal_bias * filter.texel * q.z;
                const Vec3<double> beside = pixels_of(view, point + normal * moved);
                visibility[i] =
                    R(lit_part(view, filter, is_inside(beside, filter.size) ? beside : q));
                break;
            }
        }
    });
}

template void shadow_lookup(std::span<const ShadowView>, const ShadowFilter&, std::int64_t,
                            const float*, const float*, float*);
template void shadow_lookup(std::span<const ShadowView>, const ShadowFilter&, std::int64_t,
                            const double*, const double*, double*);

}  // namespace photograd
