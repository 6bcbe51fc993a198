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

/// How many samples each pixel has: the same number, or one of its own.
struct SampleCounts {
    const std::uint32_t* own = nullptr;  // (H W), or nullptr: all have `same`
    std::uint32_t same = 0;

    [[nodiscard]] std::uint32_t of(std::int64_t pixel) const { return own ? own[pixel] : same; }
    /// Of the samples in `range`, those that the pixel has.
    [[nodiscard]] std::uint32_t within(const SampleRange& range, std::int64_t pixel) const {
        if (!own) return range.count;
        return std::min(own[pixel] - std::min(own[pixel], range.first), range.count);
    }
};

/// visit(pixel, path) for every sample of the pixels [begin, end), pixel by pixel. Lanes hold successive samples.
template <class R, class Visit>
void for_each_path(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                   const SampleRange& samples, const SampleCounts& counts, bool stop_when_black,
                   std::int64_t begin, std::int64_t end, Visit&& visit) {
    constexpr int width = RayPacket::width;
    PathWalk<R> walk(scene, options, stop_when_black);
    SampleNumbers numbers(options.sampler);
    Ray<R> rays[width];
    RandomKey keys[width];
    std::int64_t pixels[width];
    int filled = 0;
    const auto trace = [&] {
        walk.trace(rays, keys, filled);
        for (int k = 0; k < filled; ++k) visit(pixels[k], walk.path(k));
        filled = 0;
    };
    for (std::int64_t pixel = begin; pixel < end; ++pixel) {
        const std::uint32_t count = counts.within(samples, pixel);
        for (std::uint32_t i = 0; i < count; ++i) {
            keys[filled] = key_of(options, pixel, samples.first + i);
            rays[filled] = camera_ray<R>(camera, keys[filled], numbers(keys[filled], 0));
            pixels[filled++] = pixel;
            if (filled == width) trace();
        }
    }
    if (filled > 0) trace();
}

}  // namespace photograd
