#include "photograd/render/path/path.h"

#include "photograd/render/path/adjoint.h"
#include "photograd/render/path/gradient_chunks.h"
#include "photograd/render/path/samples.h"

namespace photograd {
namespace {

/// Whether a camera ray sees the background alone, maybe through partially opaque surfaces.
template <class R>
bool escapes(const Path<R>& path) {
    const auto first =
        std::find_if(path.vertices.begin(), path.vertices.end(),
                     [](const PathVertex<R>& v) { return v.kind != VertexKind::null_surface; });
    return path.vertices.empty() ||
           (first != path.vertices.end() && first->kind == VertexKind::escaped);
}

}  // namespace

template <Real R>
void trace_paths(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                 const SampleRange& samples, const PathSums& sums, double* hits) {
    PathOptions used = options;
    used.background = !hits;
    for_each_chunk(camera, [&](std::int64_t begin, std::int64_t end) {
        for_each_path<R>(scene, camera, used, samples, {}, scene.sampling_is_attached(), begin, end,
                         [&](std::int64_t pixel, const Path<R>& path) {
                             if (hits && escapes(path)) return;
                             if (hits) hits[pixel] += 1;
                             sums.add(pixel, radiance<R>(path, nullptr));
                         });
    });
}

template <Real R>
void trace_paths_backward(const PathScene<R>& scene, const ThinLens& camera,
                          const PathOptions& options, std::uint32_t spp,
                          const std::uint32_t* own_counts, const double* d_image,
                          std::span<const GradientBlock<R>> blocks) {
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    const SampleCounts counts{own_counts, spp};
    const auto d_radiance = [&](std::int64_t pixel) {
        const double* d = d_image + 3 * pixel;
        const double share = 1.0 / counts.of(pixel);
        return Vec3<R>(R(d[0] * share), R(d[1] * share), R(d[2] * share));
    };
    const auto work = [&](const SampleRange& samples, std::int64_t begin, std::int64_t end,
                          SceneGradient<R>& gradient) {
        std::vector<Vec3<R>> Lo(static_cast<std::size_t>(options.max_depth));
        for_each_path<R>(scene, camera, options, samples, counts, false, begin, end,
                         [&](std::int64_t pixel, const Path<R>& path) {
                             radiance<R>(path, Lo.data());
                             radiance_backward<R>(scene, path, Lo.data(), d_radiance(pixel),
                                                  gradient);
                         });
    };
    add_chunks<R>(scene, pixels, counts.most_of(0, pixels), false, work, blocks);
}

template <Real R>
Path<R> trace_path(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                   std::uint32_t pixel, std::uint32_t sample) {
    Path<R> found;
    const std::int64_t begin = pixel;
    for_each_path<R>(scene, camera, options, {sample, 1}, {}, false, begin, begin + 1,
                     [&](std::int64_t, const Path<R>& path) { found = path; });
    return found;
}

template decltype(trace_paths<float>) trace_paths<float>;
template decltype(trace_paths<double>) trace_paths<double>;
template decltype(trace_paths_backward<float>) trace_paths_backward<float>;
template decltype(trace_paths_backward<double>) trace_paths_backward<double>;
template decltype(trace_path<double>) trace_path<double>;

}  // namespace photograd
