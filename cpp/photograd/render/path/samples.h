// A loop over the paths of a picture, pixel by pixel.
#pragma once

#include <functional>

#include "photograd/render/path/path.h"

namespace photograd {

inline constexpr std::int64_t chunk_pixels = 64;  // of one task

/// How much wider what a pixel sees becomes per meter.
inline double pixel_spread(const Pinhole& camera) { return 1 / std::max(camera.fx, camera.fy); }

template <Real R>
using VisitPath = std::function<void(std::int64_t pixel, const Path<R>& path)>;

/// visit(pixel, path) for every sample of the pixels [begin, end), sixteen traced side by side. The
/// lens of the camera lies in one medium at a time: that of its center. `stop_when_black`: see
/// PathTracer.
template <Real R>
void for_each_path(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                   const SampleRange& samples, const SampleCounts& counts, bool stop_when_black,
                   std::int64_t begin, std::int64_t end, const VisitPath<R>& visit);

/// visit(begin, end) for chunks of the pixels of a camera, on all threads.
void for_each_chunk(const Pinhole& camera,
                    const std::function<void(std::int64_t begin, std::int64_t end)>& visit);

}  // namespace photograd
