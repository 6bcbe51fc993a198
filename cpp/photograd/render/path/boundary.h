// How a path's medium stack (scene/medium_stack.h) changes at a surface.
#pragma once

#include <cmath>

#include "photograd/scene/path_scene.h"

namespace photograd {

/// Shapes that one straight line crosses; a path that crosses more is given up.
inline constexpr int max_boundaries = 1024;

/// Whether a shape is the boundary of a medium and nothing else.
inline bool is_boundary(const PathGeometry& geometry, std::int32_t shape) {
    return geometry.media.boundary[static_cast<std::size_t>(shape)];
}

/// Where a ray continues behind a surface: along the ray unless it is grazing, so that it stays on
/// its line.
template <class R>
Vec3<R> straight_through(const PathGeometry& geometry, const SurfaceHit<R>& hit,
                         const Vec3<R>& direction) {
    const R side = dot(hit.outside, direction), offset = R(geometry.offset);
    return hit.position + (std::abs(side) > R(0.05)
                               ? direction * (offset / std::abs(side))
                               : hit.outside * (side > R(0) ? offset : -offset));
}

/// A ray that crosses a surface without a change of direction.
template <class R>
void cross_straight(const PathGeometry& geometry, const SurfaceHit<R>& hit,
                    const Vec3<R>& direction, MediumStack& stack, Vec3<R>& from, Vec3<R>& origin) {
    stack.cross(geometry.media, hit.shape, dot(hit.outside, direction) < R(0));
    from = hit.position;
    origin = straight_through(geometry, hit, direction);
}

/// A path that arrives along `arrived` and continues along `direction`, maybe through the surface.
template <class R>
void cross_if_transmitted(const PathGeometry& geometry, const SurfaceHit<R>& hit,
                          const Vec3<R>& arrived, const Vec3<R>& direction, MediumStack& stack) {
    const R out = dot(hit.outside, direction);
    if (out * dot(hit.outside, arrived) > R(0)) stack.cross(geometry.media, hit.shape, out < R(0));
}

}  // namespace photograd
