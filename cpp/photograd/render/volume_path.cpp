#include "photograd/render/volume_path.h"

#include "photograd/render/path_samples.h"
#include "photograd/render/volume_walk.h"

namespace photograd {

template <Real R>
void for_each_volume_path(const PathScene<R>& scene, const ThinLens& camera,
                          const PathOptions& options, const SampleRange& samples,
                          const SampleCounts& counts, bool stop_when_black, std::int64_t begin,
                          std::int64_t end, const VisitVolumePath<R>& visit) {
    VolumeWalk<R> walk(scene, camera, options, stop_when_black);
    walk_samples<R>(walk, camera, options, samples, counts, begin, end,
                    [&](std::int64_t pixel, int k) { visit(pixel, walk.path(k), walk.media(k)); });
}

template <Real R>
VolumePath<R> trace_volume_path(const PathScene<R>& scene, const ThinLens& camera,
                                const PathOptions& options, std::uint32_t pixel,
                                std::uint32_t sample) {
    VolumeWalk<R> walk(scene, camera, options, false);
    walk_sample<R>(walk, camera, options, pixel, sample);
    return {walk.path(0), walk.media(0)};
}

template void for_each_volume_path(const PathScene<float>&, const ThinLens&, const PathOptions&,
                                   const SampleRange&, const SampleCounts&, bool, std::int64_t,
                                   std::int64_t, const VisitVolumePath<float>&);
template void for_each_volume_path(const PathScene<double>&, const ThinLens&, const PathOptions&,
                                   const SampleRange&, const SampleCounts&, bool, std::int64_t,
                                   std::int64_t, const VisitVolumePath<double>&);
template VolumePath<double> trace_volume_path(const PathScene<double>&, const ThinLens&,
                                              const PathOptions&, std::uint32_t, std::uint32_t);

}  // namespace photograd
