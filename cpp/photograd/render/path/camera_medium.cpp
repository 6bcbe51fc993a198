#include "photograd/render/path/camera_medium.h"

#include "photograd/render/path/camera_sample.h"
#include "photograd/render/path/trace16.h"

namespace photograd {
namespace {

Vec3<double> position_of(const Pinhole& camera) {
    const auto& m = camera.world_from_camera;
    return {m[0][3], m[1][3], m[2][3]};
}

/// Whether the straight way of a camera, and a little more at both ends, hits anything.
bool crosses_surfaces(const PathGeometry& geometry, const ThinLens& camera) {
    const Vec3<double>& shift = camera.motion.shift;
    if (!camera.motion.moves || !(dot(shift, shift) > 0)) return false;
    PacketHits found;
    return closest1<double>(geometry.bvh,
                            {position_of(camera) - shift * 0.01, shift * 1.02, 0, 1.0f}, found);
}

}  // namespace

MediumStack medium_stack_at(const PathGeometry& geometry, const Vec3<double>& point, float time) {
    constexpr int max_surfaces = 100000;
    const Vec3<double> direction = normalize(Vec3<double>(0.1234, 0.9432, 0.2718));
    std::vector<int> entered(geometry.shape_count(), 0);
    std::vector<std::int32_t> left;  // the innermost is left first
    RayQuery<double> ray{point, direction, time};
    for (int i = 0; i < max_surfaces; ++i) {
        PacketHits found;
        if (!closest1<double>(geometry.bvh, ray, found)) break;
        const auto hit = surface_hit(geometry, Ray<double>{ray.origin, direction},
                                     found.instance[0], found.primitive[0], found.t[0], time);
        const bool leaves = dot(hit.outside, direction) > 0;
        int& count = entered[static_cast<std::size_t>(hit.shape)];
        if (leaves && count == 0)
            left.push_back(hit.shape);
        else
            count += leaves ? -1 : 1;
        ray.origin = hit.position + hit.outside * (leaves ? geometry.offset : -geometry.offset);
    }
    MediumStack stack;
    for (auto shape = left.rbegin(); shape != left.rend(); ++shape)
        stack.cross(geometry.media, *shape, true);
    return stack;
}

CameraMedium::CameraMedium(const PathGeometry& geometry, const ThinLens& camera, Sampler sampler,
                           bool media)
    : geometry_(geometry),
      camera_(camera),
      sampler_(sampler),
      changes_(media && (geometry.bvh.moves() || crosses_surfaces(geometry, camera))),
      opening_(media ? medium_stack_at(geometry, position_of(camera)) : MediumStack{}) {}

MediumStack CameraMedium::of(const RandomKey& key) {
    if (!changes_) return opening_;
    const double time = sample_time(key, sampler_);
    const Vec3<double> point = position_of(camera_.motion.moves ? camera_.at(time) : camera_);
    return medium_stack_at(geometry_, point, static_cast<float>(time));
}

}  // namespace photograd
