#include "photograd/render/path.h"

#include "photograd/core/parallel.h"
#include "photograd/render/path_samples.h"
#include "photograd/render/volume_path.h"

namespace photograd {
namespace {

/// Whether a camera ray meets the background alone, straight through what covers only in part.
template <class R>
bool escapes(const Path<R>& path) {
    const auto first =
        std::find_if(path.begin(), path.end(), [](const PathVertex<R>& v) { return !v.passed; });
    return first != path.end() && first->shape == SceneLights::background;
}

}  // namespace

template <Real R>
void trace_paths(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                 const SampleRange& samples, const PathSums& sums, double* hits) {
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    parallel_for((pixels + chunk_pixels - 1) / chunk_pixels, [&](std::int64_t chunk) {
        const std::int64_t begin = chunk * chunk_pixels,
                           end = std::min(begin + chunk_pixels, pixels);
        const auto add = [&](std::int64_t pixel, const Path<R>& path, const Vec3<R>& L) {
            if (hits) {
                if (escapes(path)) return;
                hits[pixel] += 1;
            }
            for (int c = 0; c < 3; ++c) {
                const double value = static_cast<double>(L[c]);
                sums.radiance[3 * pixel + c] += value;
                sums.squares[3 * pixel + c] += value * value;
            }
        };
        const bool black_ends = scene.drawn_as_sampled();
        if (scene.geometry->media.any())
            for_each_volume_path<R>(
                scene, camera, options, samples, {}, black_ends, begin, end,
                [&](std::int64_t pixel, const Path<R>& path, const MediaTrail<R>& trail) {
                    add(pixel, path, gather_through<R>(path, trail, nullptr));
                });
        else
            for_each_path(scene, camera, options, samples, {}, black_ends, begin, end,
                          [&](std::int64_t pixel, const Path<R>& path) {
                              add(pixel, path, gather<R>(path, nullptr));
                          });
    });
}

template <Real R>
Path<R> trace_path(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                   std::uint32_t pixel, std::uint32_t sample) {
    PathWalk<R> walk(scene, camera, options, false);
    walk_sample<R>(walk, camera, options, pixel, sample);
    return walk.path(0);
}

template void trace_paths(const PathScene<float>&, const ThinLens&, const PathOptions&,
                          const SampleRange&, const PathSums&, double*);
template void trace_paths(const PathScene<double>&, const ThinLens&, const PathOptions&,
                          const SampleRange&, const PathSums&, double*);
template Path<float> trace_path(const PathScene<float>&, const ThinLens&, const PathOptions&,
                                std::uint32_t, std::uint32_t);
template Path<double> trace_path(const PathScene<double>&, const ThinLens&, const PathOptions&,
                                 std::uint32_t, std::uint32_t);

}  // namespace photograd
