// From one medium to the next: what a surface does to the surroundings of a path (scene/media.h).
#pragma once

#include <cmath>

#include "photograd/scene/path_scene.h"

namespace photograd {

/// Whether a shape is the boundary of a medium and nothing else.
inline bool is_boundary(const PathGeometry& geometry, std::int32_t shape) {
    return geometry.media.boundary[static_cast<std::size_t>(shape)];
}

/// Straight to the other side of a surface: along the ray where it passes steeply, so that it stays on its line.
template <class R>
void cross_straight(const PathGeometry& geometry, const SurfaceHit<R>& hit,
                    const Vec3<R>& direction, Surroundings& around, Vec3<R>& from,
                    Vec3<R>& origin) {
    const R side = dot(hit.outside, direction), offset = R(geometry.offset);
    around.cross(geometry.media, hit.shape, side < R(0));
    from = hit.position;
    origin =
        hit.position + (std::abs(side) > R(0.05) ? direction * (offset / std::abs(side))
                                                 : hit.outside * (side > R(0) ? offset : -offset));
}

/// The surroundings of a path that goes on along `direction`, which may lead through the surface where it `arrived`.
template <class R>
void cross_if_through(const PathGeometry& geometry, const SurfaceHit<R>& hit,
                      const Vec3<R>& arrived, const Vec3<R>& direction, Surroundings& around) {
    const R out = dot(hit.outside, direction);
    if (out * dot(hit.outside, arrived) > R(0)) around.cross(geometry.media, hit.shape, out < R(0));
}

}  // namespace photograd
