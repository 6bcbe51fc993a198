#include "photograd/render/camera_surroundings.h"

#include <limits>

#include "photograd/render/path_samples.h"

namespace photograd {
namespace {

Vec3<double> position_of(const Pinhole& camera) {
    const auto& m = camera.world_from_camera;
    return {m[0][3], m[1][3], m[2][3]};
}

/// Whether the straight way of a camera, and a little more at both ends, meets anything.
bool meets_surfaces(const PathGeometry& geometry, const ThinLens& camera) {
    const Vec3<double>& shift = camera.motion.shift;
    if (!camera.motion.moves || !(dot(shift, shift) > 0)) return false;
    RayPacket packet{};
    set_lane(packet, 0, position_of(camera) - shift * 0.01, shift * 1.02, 1.0f);
    bool blocked[RayPacket::width];
    geometry.bvh.occluded(packet, false, blocked);
    return blocked[0];
}

}  // namespace

Surroundings surroundings_of(const PathGeometry& geometry, const Vec3<double>& point, float time) {
    constexpr int most_surfaces = 100000;
    const Vec3<double> direction = normalize(Vec3<double>(0.1234, 0.9432, 0.2718));
    std::vector<int> entered(geometry.shape_count(), 0);
    std::vector<std::int32_t> left;  // the innermost is left first
    Vec3<double> origin = point;
    for (int i = 0; i < most_surfaces; ++i) {
        RayPacket packet{};
        set_lane(packet, 0, origin, direction, std::numeric_limits<float>::infinity(), time);
        PacketHits found;
        geometry.bvh.trace(packet, false, found);
        if (found.primitive[0] < 0) break;
        const auto hit = surface_hit(geometry, Ray<double>{origin, direction}, found.instance[0],
                                     found.primitive[0], found.t[0], time);
        const bool leaves = dot(hit.outside, direction) > 0;
        int& count = entered[static_cast<std::size_t>(hit.shape)];
        if (leaves && count == 0)
            left.push_back(hit.shape);
        else
            count += leaves ? -1 : 1;
        origin = hit.position + hit.outside * (leaves ? geometry.offset : -geometry.offset);
    }
    Surroundings around;
    for (auto shape = left.rbegin(); shape != left.rend(); ++shape)
        around.cross(geometry.media, *shape, true);
    return around;
}

CameraSurroundings::CameraSurroundings(const PathGeometry& geometry, const ThinLens& camera,
                                       Sampler sampler)
    : geometry_(geometry),
      camera_(camera),
      numbers_(sampler),
      changes_(geometry.bvh.moves() || meets_surfaces(geometry, camera)),
      opening_(surroundings_of(geometry, position_of(camera))) {}

Surroundings CameraSurroundings::of(const RandomKey& key) {
    if (!changes_) return opening_;
    const double time = sample_time(key, numbers_);
    const Vec3<double> point = position_of(camera_.motion.moves ? camera_.at(time) : camera_);
    return surroundings_of(geometry_, point, static_cast<float>(time));
}

}  // namespace photograd
