#include "photograd/render/path/samples.h"

#include "photograd/core/parallel.h"
#include "photograd/render/path/camera_medium.h"
#include "photograd/render/path/camera_sample.h"
#include "photograd/render/path/camera_tracer.h"

namespace photograd {
namespace {

template <Real R, bool Media>
void trace_all(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
               const SampleRange& samples, const SampleCounts& counts, bool stop_when_black,
               std::int64_t begin, std::int64_t end, const VisitPath<R>& visit) {
    PathTracer<R, Media> tracer(scene, options, R(pixel_spread(camera)), stop_when_black);
    trace_samples<R, Media>(tracer, scene, camera, options, samples, counts, begin, end,
                            [&](std::int64_t pixel, int k) { visit(pixel, tracer.path(k)); });
}

}  // namespace

template <Real R>
void for_each_path(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                   const SampleRange& samples, const SampleCounts& counts, bool stop_when_black,
                   std::int64_t begin, std::int64_t end, const VisitPath<R>& visit) {
    (scene.geometry->media.any() ? trace_all<R, true>
                                 : trace_all<R, false>)(scene, camera, options, samples, counts,
                                                        stop_when_black, begin, end, visit);
}

void for_each_chunk(const Pinhole& camera,
                    const std::function<void(std::int64_t begin, std::int64_t end)>& visit) {
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    parallel_for((pixels + chunk_pixels - 1) / chunk_pixels, [&](std::int64_t chunk) {
        visit(chunk * chunk_pixels, std::min((chunk + 1) * chunk_pixels, pixels));
    });
}

template decltype(for_each_path<float>) for_each_path<float>;
template decltype(for_each_path<double>) for_each_path<double>;

}  // namespace photograd
