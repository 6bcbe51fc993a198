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
    // Most cameras stand still and have no lens: their rays are calculated together.
    const bool still = !(camera.radius > 0) && !camera.motion.moves;
    const Ray<R> first = camera.ray(R(0), R(0));
    R x[trace_width] = {}, y[trace_width] = {}, directions[3][trace_width];
    const auto trace = [&] {
        if (still) {
            camera.directions(x, y, directions);
            for (int k = 0; k < filled; ++k)
                starts[k].ray = {first.origin,
                                 {directions[0][k], directions[1][k], directions[2][k]}};
        }
        tracer.trace(starts, filled);
        for (int k = 0; k < filled; ++k) visit(pixels[k], k);
        filled = 0;
    };
    for (std::int64_t pixel = begin; pixel < end; ++pixel) {
        const std::uint32_t count = counts.within(samples, pixel);
        const R column = R(pixel % camera.width), row = R(pixel / camera.width);
        for (std::uint32_t i = 0; i < count; ++i) {
            const RandomKey key = key_of(options, pixel, samples.first + i);
            starts[filled] = {still ? first : sample_ray<R>(camera, key, sampler), key,
                              Media ? medium.of(key) : MediumStack{}};
            if (still) {
                const Philox4 words = sampler(key, dimensions::camera_block);
                x[filled] = column + uniform_from<R>(words[dimensions::film_x]);
                y[filled] = row + uniform_from<R>(words[dimensions::film_y]);
            }
            pixels[filled++] = pixel;
            if (filled == trace_width) trace();
        }
    }
    if (filled > 0) trace();
}

}  // namespace photograd
