#include "photograd/render/reference/path_tracer.h"

#include "photograd/render/path/camera_sample.h"
#include "photograd/render/path/samples.h"
#include "photograd/render/reference/trace_reference.h"

namespace photograd {

void trace_reference(const PathScene<double>& scene, const ThinLens& camera,
                     const PathOptions& options, const SampleRange& samples, const PathSums& sums) {
    const reference::PathTracer tracer(scene, options);
    for_each_chunk(camera, [&](std::int64_t begin, std::int64_t end) {
        PathSampler sampler;
        for (std::int64_t pixel = begin; pixel < end; ++pixel)
            for (std::uint32_t i = 0; i < samples.count; ++i) {
                const RandomKey key = key_of(options, pixel, samples.first + i);
                RandomStream random(key, dimensions::reference_step);
                const Ray<double> ray = sample_ray<double>(camera, key, sampler);
                sums.add(pixel, tracer.radiance(ray, sample_time(key, sampler), random));
            }
    });
}

}  // namespace photograd
