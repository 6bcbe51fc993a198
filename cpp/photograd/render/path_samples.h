// The paths of a picture, for both passes: sixteen at a time, pixel by pixel.
#pragma once

#include <algorithm>

#include "photograd/render/path.h"
#include "photograd/render/path_walk.h"

namespace photograd {

inline constexpr std::int64_t chunk_pixels = 64;  // of one task

inline RandomKey key_of(const PathOptions& options, std::int64_t pixel, std::uint32_t sample) {
    return {options.seed, 0, static_cast<std::uint32_t>(pixel), sample};
}

/// visit(pixel, path) for every sample of the pixels [begin, end), pixel by pixel. Lanes hold successive samples.
template <class R, class Visit>
void for_each_path(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                   const SampleRange& samples, bool stop_when_black, std::int64_t begin,
                   std::int64_t end, Visit&& visit) {
    constexpr int width = RayPacket::width;
    PathWalk<R> walk(scene, options, stop_when_black);
    SampleNumbers numbers(options.sampler);
    const std::int64_t total = (end - begin) * samples.count;
    for (std::int64_t first = 0; first < total; first += width) {
        const int count = static_cast<int>(std::min<std::int64_t>(width, total - first));
        Ray<R> rays[width];
        RandomKey keys[width];
        for (int k = 0; k < count; ++k) {
            const std::int64_t i = first + k;
            keys[k] = key_of(options, begin + i / samples.count,
                             samples.first + static_cast<std::uint32_t>(i % samples.count));
            rays[k] = camera_ray<R>(camera, keys[k], numbers(keys[k], 0));
        }
        walk.trace(rays, keys, count);
        for (int k = 0; k < count; ++k) visit(begin + (first + k) / samples.count, walk.path(k));
    }
}

}  // namespace photograd
