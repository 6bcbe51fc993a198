// Single rays as lanes of a packet, for renderers that trace sixteen samples side by side.
#pragma once

#include "photograd/camera/thin_lens.h"
#include "photograd/core/random.h"
#include "photograd/geometry/bvh.h"
#include "photograd/sampling/warp.h"

namespace photograd {

template <class R>
void set_lane(RayPacket& packet, int k, const Vec3<R>& origin, const Vec3<R>& direction,
              float t_max, float time = 0) {
    for (int axis = 0; axis < 3; ++axis) {
        packet.origin[axis][k] = static_cast<float>(origin[axis]);
        packet.direction[axis][k] = static_cast<float>(direction[axis]);
    }
    packet.t_min[k] = 0;
    packet.t_max[k] = t_max;
    packet.time[k] = time;
    packet.active[k] = true;
}

/// The ray of one sample: uniform over the pixel, by dimensions 0 and 1, words of block 0.
template <class R>
Ray<R> camera_ray(const Pinhole& camera, const RandomKey& key, const Philox4& words) {
    const std::int64_t column = key.pixel % static_cast<std::uint32_t>(camera.width),
                       row = key.pixel / static_cast<std::uint32_t>(camera.width);
    return camera.ray(R(column) + uniform_from<R>(words[0]), R(row) + uniform_from<R>(words[1]));
}

/// The same through a lens, whose point comes from dimensions 2 and 3.
template <class R>
Ray<R> camera_ray(const ThinLens& camera, const RandomKey& key, const Philox4& words) {
    if (!(camera.radius > 0)) return camera_ray<R>(static_cast<const Pinhole&>(camera), key, words);
    const std::int64_t column = key.pixel % static_cast<std::uint32_t>(camera.width),
                       row = key.pixel / static_cast<std::uint32_t>(camera.width);
    const Vec2<R> u2(uniform_from<R>(words[2]), uniform_from<R>(words[3]));
    return camera.ray(R(column) + uniform_from<R>(words[0]), R(row) + uniform_from<R>(words[1]),
                      square_to_disk(u2));
}

}  // namespace photograd
