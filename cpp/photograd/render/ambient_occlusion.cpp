#include "photograd/render/ambient_occlusion.h"

#include "photograd/core/parallel.h"
#include "photograd/render/path/camera_sample.h"
#include "photograd/render/path/trace16.h"
#include "photograd/sampling/sobol.h"
#include "photograd/sampling/warp.h"

namespace photograd {
namespace {

/// Up to sixteen samples of one pixel: how many of them are free.
template <class R>
int free_samples(const PathGeometry& scene, const Pinhole& camera, double radius, RandomKey key,
                 int count) {
    Ray<R> rays[trace_width];
    RandomKey keys[trace_width];
    for (int k = 0; k < count; ++k) {
        keys[k] = key;
        keys[k].sample += static_cast<std::uint32_t>(k);
        rays[k] = camera_ray<R>(camera, keys[k], random_block(keys[k], dimensions::camera_block));
    }
    PacketHits found;
    closest16<R>(
        scene.bvh, true,
        [&](int k, RayQuery<R>& ray) {
            if (k < count) ray = {rays[k].origin, rays[k].direction};
            return k < count;
        },
        found);
    bool blocked[trace_width];
    const auto to_sky = [&](int k, RayQuery<R>& ray) {
        if (k >= count || found.primitive[k] < 0) return false;
        const SurfaceHit<R> hit =
            surface_hit(scene, rays[k], found.instance[k], found.primitive[k], found.t[k]);
        const SurfaceSide<R> side(hit, -rays[k].direction, false);
        const Philox4 words = random_block(keys[k], dimensions::occlusion_block);
        const Vec3<R> w = Frame<R>::from_normal(side.normal)
                              .to_world(square_to_cosine_hemisphere(
                                  Vec2<R>(uniform_from<R>(words[0]), uniform_from<R>(words[1]))));
        ray = {side.start(hit.position, w, scene.offset), w, 0, static_cast<float>(radius)};
        return true;
    };
    occluded16<R>(scene.bvh, to_sky, blocked);
    int open = count;
    for (int k = 0; k < count; ++k) open -= blocked[k] ? 1 : 0;
    return open;
}

constexpr std::int64_t chunk_points = 64;  // of one task

Vec3<double> row(const double* rows, std::int64_t i) {
    return {rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]};
}

int free_directions(const PathGeometry& scene, const Vec3<double>& position,
                    const Vec3<double>& normal, float radius, const RandomKey& key,
                    const SampleRange& samples) {
    const auto frame = Frame<double>::from_normal(normal);
    const Vec3<double> start = position + normal * scene.offset;
    const SobolSampler numbers(key, 0);
    int open = 0;
    for (std::uint32_t first = 0; first < samples.count; first += trace_width) {
        const int count =
            static_cast<int>(std::min<std::uint32_t>(trace_width, samples.count - first));
        const auto to_sky = [&](int k, RayQuery<double>& ray) {
            if (k >= count) return false;
            const Philox4 words =
                numbers.words(samples.first + first + static_cast<std::uint32_t>(k));
            const Vec3<double> w = frame.to_world(square_to_cosine_hemisphere(
                Vec2<double>(uniform_from<double>(words[0]), uniform_from<double>(words[1]))));
            ray = {start, w, 0, radius};
            return true;
        };
        bool blocked[trace_width];
        occluded16<double>(scene.bvh, to_sky, blocked);
        for (int k = 0; k < count; ++k) open += blocked[k] ? 0 : 1;
    }
    return open;
}

}  // namespace

template <Real R>
void trace_ambient_occlusion(const PathGeometry& scene, const Pinhole& camera, double radius,
                             std::uint64_t seed, const SampleRange& samples, double* sums) {
    constexpr std::int64_t chunk_pixels = 64;
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    parallel_for((pixels + chunk_pixels - 1) / chunk_pixels, [&](std::int64_t chunk) {
        const std::int64_t end = std::min((chunk + 1) * chunk_pixels, pixels);
        for (std::int64_t pixel = chunk * chunk_pixels; pixel < end; ++pixel)
            for (std::uint32_t first = 0; first < samples.count; first += trace_width) {
                const RandomKey key{seed, 0, static_cast<std::uint32_t>(pixel),
                                    samples.first + first};
                const int count = static_cast<int>(std::min<std::uint32_t>(
                    static_cast<std::uint32_t>(trace_width), samples.count - first));
                sums[pixel] += free_samples<R>(scene, camera, radius, key, count);
            }
    });
}

void add_point_occlusion(const PathGeometry& scene, const SurfacePoints& points, double radius,
                         std::uint64_t seed, const SampleRange& samples, double* sums) {
    parallel_for((points.count + chunk_points - 1) / chunk_points, [&](std::int64_t chunk) {
        const std::int64_t end = std::min(points.count, (chunk + 1) * chunk_points);
        for (std::int64_t i = chunk * chunk_points; i < end; ++i)
            sums[i] += free_directions(scene, row(points.positions, i), row(points.normals, i),
                                       static_cast<float>(radius),
                                       {seed, 0, static_cast<std::uint32_t>(i), 0}, samples);
    });
}

template decltype(trace_ambient_occlusion<float>) trace_ambient_occlusion<float>;
template decltype(trace_ambient_occlusion<double>) trace_ambient_occlusion<double>;

}  // namespace photograd
