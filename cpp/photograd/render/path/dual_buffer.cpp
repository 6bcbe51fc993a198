#include "photograd/render/path/dual_buffer.h"

#include <algorithm>
#include <vector>

#include "photograd/render/path/adjoint.h"
#include "photograd/render/path/gradient_chunks.h"
#include "photograd/render/path/samples.h"

namespace photograd {
namespace {

constexpr std::uint32_t cached_at_once = 64;  // paths of each; more only where one pixel has more

/// All paths of a few pixels for one of the pictures.
template <Real R>
class PathCache {
public:
    PathCache(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
              const SampleCounts& counts)
        : scene_(scene), camera_(camera), options_(options), counts_(counts) {}

    /// Traces the pixels [begin, end) and writes them to `picture` (H, W, 3), which is 0 there.
    void trace(std::int64_t begin, std::int64_t end, double* picture) {
        used_ = 0;
        for_each_path<R>(scene_, camera_, options_, {0, counts_.most_of(begin, end)}, counts_,
                         false, begin, end, [&](std::int64_t pixel, const Path<R>& path) {
                             add(pixel, path);
                             const Vec3<R> L = radiance<R>(path, nullptr);
                             for (int c = 0; c < 3; ++c)
                                 picture[3 * pixel + c] += static_cast<double>(L[c]);
                         });
        for (std::int64_t pixel = begin; pixel < end; ++pixel)
            for (int c = 0; c < 3; ++c) picture[3 * pixel + c] /= counts_.of(pixel);
    }

    /// Adds the derivatives of the cached paths, d_radiance(pixel) being that of a pixel's mean.
    template <class Cotangent>
    void backward(Cotangent&& d_radiance, Vec3<R>* Lo, SceneGradient<R>& gradient) const {
        for (std::size_t i = 0; i < used_; ++i) {
            const auto& [pixel, path] = cached_[i];
            const Vec3<double> d = d_radiance(pixel) * (1.0 / counts_.of(pixel));
            radiance<R>(path, Lo);
            radiance_backward<R>(scene_, path, Lo, Vec3<R>(R(d.x), R(d.y), R(d.z)), gradient);
        }
    }

private:
    void add(std::int64_t pixel, const Path<R>& path) {
        if (used_ == cached_.size()) cached_.emplace_back();
        cached_[used_].first = pixel;
        cached_[used_++].second = path;
    }

    const PathScene<R>& scene_;
    const ThinLens& camera_;
    PathOptions options_;
    SampleCounts counts_;
    std::vector<std::pair<std::int64_t, Path<R>>> cached_;
    std::size_t used_ = 0;
};

}  // namespace

template <Real R>
void dual_buffer_backward(const PathScene<R>& scene, const ThinLens& camera,
                          const PathOptions& options, const std::array<std::uint64_t, 2>& seeds,
                          std::uint32_t spp, const std::uint32_t* own_counts,
                          const SquaredError& loss, std::span<const GradientBlock<R>> blocks,
                          double* pictures) {
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    const SampleCounts counts{own_counts, spp};
    double* const picture[2] = {pictures, pictures + 3 * pixels};
    std::fill(pictures, pictures + 6 * pixels, 0.0);
    const auto residual = [&](const double* other, std::int64_t pixel) {
        Vec3<double> d;
        for (int c = 0; c < 3; ++c) {
            const std::int64_t i = 3 * pixel + c;
            d[c] = loss.weight[i] * (other[i] - loss.target[i]);
        }
        return d;
    };
    const auto work = [&](const SampleRange&, std::int64_t begin, std::int64_t end,
                          SceneGradient<R>& gradient) {
        std::vector<Vec3<R>> Lo(static_cast<std::size_t>(options.max_depth));
        std::vector<PathCache<R>> caches;
        for (const std::uint64_t seed : seeds) {
            PathOptions own = options;
            own.seed = seed;
            caches.emplace_back(scene, camera, own, counts);
        }
        for (std::int64_t first = begin, last = begin; first < end; first = last) {
            for (std::uint32_t cached = 0; last < end && cached < cached_at_once; ++last)
                cached += counts.of(last);
            for (std::size_t i = 0; i < 2; ++i) caches[i].trace(first, last, picture[i]);
            for (std::size_t i = 0; i < 2; ++i)
                caches[i].backward(
                    [&](std::int64_t pixel) { return residual(picture[1 - i], pixel); }, Lo.data(),
                    gradient);
        }
    };
    add_chunks<R>(scene, pixels, counts.most_of(0, pixels), true, work, blocks);
}

template decltype(dual_buffer_backward<float>) dual_buffer_backward<float>;
template decltype(dual_buffer_backward<double>) dual_buffer_backward<double>;

}  // namespace photograd
