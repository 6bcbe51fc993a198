#include "photograd/render/path_pairs.h"

#include <algorithm>
#include <vector>

#include "photograd/render/path_chunks.h"
#include "photograd/render/path_samples.h"
#include "photograd/render/volume_path.h"

namespace photograd {
namespace {

constexpr std::uint32_t kept_at_once = 64;  // paths of each; more only where one pixel has more

/// Traces all paths of a few pixels for one of the pictures, and keeps them.
template <Real R>
class PathKeeper {
public:
    struct Kept {
        std::int64_t pixel = 0;
        VolumePath<R> of;
    };

    PathKeeper(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
               const SampleCounts& counts)
        : scene_(scene),
          camera_(camera),
          options_(options),
          counts_(counts),
          walk_(scene, camera, options, false) {}

    /// Writes the pixels [begin, end) to `picture` (H, W, 3), which is 0 there.
    void keep(std::int64_t begin, std::int64_t end, double* picture) {
        used_ = 0;
        const SampleRange all{0, counts_.most_of(begin, end)};
        if (in_media())
            for_each_volume_path<R>(
                scene_, camera_, options_, all, counts_, false, begin, end,
                [&](std::int64_t pixel, const Path<R>& path, const MediaTrail<R>& trail) {
                    Kept& kept = next(pixel, path);
                    kept.of.trail = trail;
                    add(gather_through<R>(path, trail, nullptr), pixel, picture);
                });
        else
            walk_samples<R>(walk_, camera_, options_, all, counts_, begin, end,
                            [&](std::int64_t pixel, int k) {
                                next(pixel, walk_.path(k));
                                add(gather<R>(walk_.path(k), nullptr), pixel, picture);
                            });
        for (std::int64_t pixel = begin; pixel < end; ++pixel)
            for (int c = 0; c < 3; ++c) picture[3 * pixel + c] /= counts_.of(pixel);
    }

    /// Adds the derivatives of what is kept, d_radiance(pixel) being that of a pixel's mean.
    template <class Cotangent>
    void backward(Cotangent&& d_radiance, Vec3<R>* ahead, PathGradient<R>& gradient) const {
        for (std::size_t i = 0; i < used_; ++i) {
            const Kept& kept = kept_[i];
            const Vec3<double> d = d_radiance(kept.pixel) * (1.0 / counts_.of(kept.pixel));
            const Vec3<R> d_L(static_cast<R>(d.x), static_cast<R>(d.y), static_cast<R>(d.z));
            if (in_media()) {
                gather_through<R>(kept.of.path, kept.of.trail, ahead);
                gather_through_backward<R>(scene_, kept.of.path, kept.of.trail, ahead, d_L,
                                           gradient);
            } else {
                gather<R>(kept.of.path, ahead);
                gather_backward<R>(scene_, kept.of.path, ahead, d_L, gradient);
            }
        }
    }

private:
    [[nodiscard]] bool in_media() const { return scene_.geometry->media.any(); }
    Kept& next(std::int64_t pixel, const Path<R>& path) {
        if (used_ == kept_.size()) kept_.emplace_back();
        Kept& kept = kept_[used_++];
        kept.pixel = pixel;
        kept.of.path = path;
        return kept;
    }
    static void add(const Vec3<R>& L, std::int64_t pixel, double* picture) {
        for (int c = 0; c < 3; ++c) picture[3 * pixel + c] += static_cast<double>(L[c]);
    }

    const PathScene<R>& scene_;
    const ThinLens& camera_;
    PathOptions options_;
    SampleCounts counts_;
    PathWalk<R> walk_;
    std::vector<Kept> kept_;
    std::size_t used_ = 0;
};

}  // namespace

template <Real R>
void trace_pairs_backward(const PathScene<R>& scene, const ThinLens& camera,
                          const PathOptions& options, const std::array<std::uint64_t, 2>& seeds,
                          std::uint32_t spp, const std::uint32_t* own_counts,
                          const SquaredError& loss, const PathDerivatives<R>& out,
                          double* pictures) {
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    const SampleCounts counts{own_counts, spp};
    double* const picture[2] = {pictures, pictures + 3 * pixels};
    std::fill(pictures, pictures + 6 * pixels, 0.0);
    /// What the loss asks of one picture, by the other.
    const auto cotangent = [&](const double* other, std::int64_t pixel) {
        Vec3<double> d;
        for (int c = 0; c < 3; ++c) {
            const std::int64_t i = 3 * pixel + c;
            d[c] = loss.weight[i] * (other[i] - loss.target[i]);
        }
        return d;
    };
    const auto work = [&](const SampleRange&, std::int64_t begin, std::int64_t end,
                          PathGradient<R>& gradient) {
        std::vector<Vec3<R>> ahead(static_cast<std::size_t>(options.max_depth));
        std::vector<PathKeeper<R>> keepers;
        keepers.reserve(2);
        for (const std::uint64_t seed : seeds) {
            PathOptions own = options;
            own.seed = seed;
            keepers.emplace_back(scene, camera, own, counts);
        }
        for (std::int64_t first = begin, last = begin; first < end; first = last) {
            for (std::uint32_t kept = 0; last < end && kept < kept_at_once; ++last)
                kept += counts.of(last);
            for (std::size_t i = 0; i < 2; ++i) keepers[i].keep(first, last, picture[i]);
            for (std::size_t i = 0; i < 2; ++i)
                keepers[i].backward(
                    [&](std::int64_t pixel) { return cotangent(picture[1 - i], pixel); },
                    ahead.data(), gradient);
        }
    };
    add_chunks<R>(scene, pixels, counts.most_of(0, pixels), true, work, out);
}

template void trace_pairs_backward(const PathScene<float>&, const ThinLens&, const PathOptions&,
                                   const std::array<std::uint64_t, 2>&, std::uint32_t,
                                   const std::uint32_t*, const SquaredError&,
                                   const PathDerivatives<float>&, double*);
template void trace_pairs_backward(const PathScene<double>&, const ThinLens&, const PathOptions&,
                                   const std::array<std::uint64_t, 2>&, std::uint32_t,
                                   const std::uint32_t*, const SquaredError&,
                                   const PathDerivatives<double>&, double*);

}  // namespace photograd
