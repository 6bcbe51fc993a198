// Path tracers that start at a camera: sixteen samples at a time, pixel by pixel.
#pragma once

#include "photograd/render/path/camera_medium.h"
#include "photograd/render/path/camera_sample.h"
#include "photograd/render/path/path.h"
#include "photograd/render/path/tracer.h"

namespace photograd {

/// Traces every sample of the pixels [begin, end); lanes hold successive samples. visit(pixel, k)
/// finds the path in lane k of the tracer.
template <Real R, bool Media, class Tracer, class Visit>
void trace_samples(Tracer& tracer, const PathScene<R>& scene, const ThinLens& camera,
                   const PathOptions& options, const SampleRange& samples,
                   const SampleCounts& counts, std::int64_t begin, std::int64_t end,
                   Visit&& visit) {
    PathSampler sampler(options.sampler);
    CameraMedium medium(*scene.geometry, camera, options.sampler, Media);
    PathStart<R> starts[trace_width];
    std::int64_t pixels[trace_width];
    int filled = 0;
    const auto trace = [&] {
        tracer.trace(starts, filled);
        for (int k = 0; k < filled; ++k) visit(pixels[k], k);
        filled = 0;
    };
    for (std::int64_t pixel = begin; pixel < end; ++pixel) {
        const std::uint32_t count = counts.within(samples, pixel);
        for (std::uint32_t i = 0; i < count; ++i) {
            const RandomKey key = key_of(options, pixel, samples.first + i);
            starts[filled] = {sample_ray<R>(camera, key, sampler), key, medium.of(key)};
            pixels[filled++] = pixel;
            if (filled == trace_width) trace();
        }
    }
    if (filled > 0) trace();
}

}  // namespace photograd
