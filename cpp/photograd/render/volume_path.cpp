#include "photograd/render/volume_path.h"

#include <limits>

#include "photograd/render/path_samples.h"
#include "photograd/render/volume_walk.h"

namespace photograd {

Surroundings surroundings_of(const PathGeometry& geometry, const Vec3<double>& point) {
    constexpr int most_surfaces = 100000;
    const Vec3<double> direction = normalize(Vec3<double>(0.1234, 0.9432, 0.2718));
    std::vector<int> entered(geometry.shape_count(), 0);
    std::vector<std::int32_t> left;  // the innermost is left first
    Vec3<double> origin = point;
    for (int i = 0; i < most_surfaces; ++i) {
        RayPacket packet{};
        set_lane(packet, 0, origin, direction, std::numeric_limits<float>::infinity());
        PacketHits found;
        geometry.bvh.trace(packet, false, found);
        if (found.primitive[0] < 0) break;
        const auto hit = surface_hit(geometry, Ray<double>{origin, direction}, found.instance[0],
                                     found.primitive[0], found.t[0]);
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

namespace {
Vec3<double> position_of(const Pinhole& camera) {
    const auto& m = camera.world_from_camera;
    return {m[0][3], m[1][3], m[2][3]};
}
}  // namespace

template <Real R>
void for_each_volume_path(const PathScene<R>& scene, const ThinLens& camera,
                          const PathOptions& options, const SampleRange& samples,
                          const SampleCounts& counts, bool stop_when_black, std::int64_t begin,
                          std::int64_t end, const VisitVolumePath<R>& visit) {
    VolumeWalk<R> walk(scene, options, stop_when_black,
                       surroundings_of(*scene.geometry, position_of(camera)));
    walk.open_cones(camera);
    walk_samples<R>(walk, camera, options, samples, counts, begin, end,
                    [&](std::int64_t pixel, int k) { visit(pixel, walk.path(k), walk.media(k)); });
}

template <Real R>
VolumePath<R> trace_volume_path(const PathScene<R>& scene, const ThinLens& camera,
                                const PathOptions& options, std::uint32_t pixel,
                                std::uint32_t sample) {
    const RandomKey key = key_of(options, pixel, sample);
    const Ray<R> ray = camera_ray<R>(camera, key, SampleNumbers(options.sampler)(key, 0));
    VolumeWalk<R> walk(scene, options, false,
                       surroundings_of(*scene.geometry, position_of(camera)));
    walk.open_cones(camera);
    walk.trace(&ray, &key, 1);
    return {walk.path(0), walk.media(0)};
}

template void for_each_volume_path(const PathScene<float>&, const ThinLens&, const PathOptions&,
                                   const SampleRange&, const SampleCounts&, bool, std::int64_t,
                                   std::int64_t, const VisitVolumePath<float>&);
template void for_each_volume_path(const PathScene<double>&, const ThinLens&, const PathOptions&,
                                   const SampleRange&, const SampleCounts&, bool, std::int64_t,
                                   std::int64_t, const VisitVolumePath<double>&);
template VolumePath<double> trace_volume_path(const PathScene<double>&, const ThinLens&,
                                              const PathOptions&, std::uint32_t, std::uint32_t);

}  // namespace photograd
