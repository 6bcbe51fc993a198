// The paths of a picture, for both passes: sixteen at a time, pixel by pixel.
#pragma once

#include <algorithm>

#include "photograd/render/path.h"
#include "photograd/render/path_walk.h"
#include "photograd/render/shutter_time.h"

namespace photograd {

inline constexpr std::int64_t chunk_pixels = 64;  // of one task

inline RandomKey key_of(const PathOptions& options, std::int64_t pixel, std::uint32_t sample) {
    return {options.seed, 0, static_cast<std::uint32_t>(pixel), sample};
}

/// The ray of one sample, at its moment.
template <class R>
Ray<R> sample_ray(const ThinLens& camera, const RandomKey& key, SampleNumbers& numbers) {
    const Philox4 words = numbers(key, 0);
    if (!camera.motion.moves) return camera_ray<R>(camera, key, words);
    return camera_ray<R>(camera.at(sample_time(key, numbers)), key, words);
}

/// Walks every sample of the pixels [begin, end), pixel by pixel; lanes hold successive samples. visit(pixel, k) finds
/// the path in lane k of the walk.
template <class R, class Walk, class Visit>
void walk_samples(Walk& walk, const ThinLens& camera, const PathOptions& options,
                  const SampleRange& samples, const SampleCounts& counts, std::int64_t begin,
                  std::int64_t end, Visit&& visit) {
    constexpr int width = RayPacket::width;
    SampleNumbers numbers(options.sampler);
    Ray<R> rays[width];
    RandomKey keys[width];
    std::int64_t pixels[width];
    int filled = 0;
    const auto trace = [&] {
        walk.trace(rays, keys, filled);
        for (int k = 0; k < filled; ++k) visit(pixels[k], k);
        filled = 0;
    };
    for (std::int64_t pixel = begin; pixel < end; ++pixel) {
        const std::uint32_t count = counts.within(samples, pixel);
        for (std::uint32_t i = 0; i < count; ++i) {
            keys[filled] = key_of(options, pixel, samples.first + i);
            rays[filled] = sample_ray<R>(camera, keys[filled], numbers);
            pixels[filled++] = pixel;
            if (filled == width) trace();
        }
    }
    if (filled > 0) trace();
}

/// Walks one sample alone; its path is in lane 0.
template <class R, class Walk>
void walk_sample(Walk& walk, const ThinLens& camera, const PathOptions& options,
                 std::uint32_t pixel, std::uint32_t sample) {
    const RandomKey key = key_of(options, pixel, sample);
    SampleNumbers numbers(options.sampler);
    const Ray<R> ray = sample_ray<R>(camera, key, numbers);
    walk.trace(&ray, &key, 1);
}

/// visit(pixel, path) for every sample of the pixels [begin, end).
template <class R, class Visit>
void for_each_path(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                   const SampleRange& samples, const SampleCounts& counts, bool stop_when_black,
                   std::int64_t begin, std::int64_t end, Visit&& visit) {
    PathWalk<R> walk(scene, camera, options, stop_when_black);
    walk_samples<R>(walk, camera, options, samples, counts, begin, end,
                    [&](std::int64_t pixel, int k) { visit(pixel, walk.path(k)); });
}

}  // namespace photograd
