// Paths through media, for both passes of path.h; scenes without media take the shorter way of path_walk.h.
#pragma once

#include <functional>

#include "photograd/render/path.h"
#include "photograd/render/volume_vertex.h"

namespace photograd {

template <Real R>
using VisitVolumePath =
    std::function<void(std::int64_t pixel, const Path<R>& path, const MediaTrail<R>& trail)>;

/// visit(pixel, path, trail) for every sample of the pixels [begin, end), as for_each_path does. The lens of the camera lies
/// in one medium at a time: in that of its centre.
template <Real R>
void for_each_volume_path(const PathScene<R>& scene, const ThinLens& camera,
                          const PathOptions& options, const SampleRange& samples,
                          const SampleCounts& counts, bool stop_when_black, std::int64_t begin,
                          std::int64_t end, const VisitVolumePath<R>& visit);

template <Real R>
struct VolumePath {
    Path<R> path;
    MediaTrail<R> trail;
};

/// One path, for those who want to look at its vertices and steps.
template <Real R>
VolumePath<R> trace_volume_path(const PathScene<R>& scene, const ThinLens& camera,
                                const PathOptions& options, std::uint32_t pixel,
                                std::uint32_t sample);

}  // namespace photograd
