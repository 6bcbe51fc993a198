// Path tracing: the radiance that reaches a camera after any number of bounces, and its
// derivatives.
//
// A pixel is the mean of radiance(path) over its samples: render/path/tracer.h samples the paths,
// render/path/adjoint.h sums them up. Both passes trace the same paths for the same seed. A loss of
// the picture should be differentiated with paths of another seed than the picture's: where d_image
// and the derivative share their noise, the mean of their product is not the product of their
// means.
#pragma once

#include <algorithm>
#include <span>

#include "photograd/camera/thin_lens.h"
#include "photograd/render/path/options.h"
#include "photograd/render/path/record.h"
#include "photograd/scene/gradient.h"

namespace photograd {

/// Samples `first` to `first + count - 1` of each pixel.
struct SampleRange {
    std::uint32_t first = 0, count = 16;
};

/// How many samples each pixel has: the same number, or one of its own.
struct SampleCounts {
    const std::uint32_t* own = nullptr;  // (H W), or nullptr: all have `same`
    std::uint32_t same = 0;

    [[nodiscard]] std::uint32_t of(std::int64_t pixel) const { return own ? own[pixel] : same; }
    /// The most of any pixel in [begin, end).
    [[nodiscard]] std::uint32_t most_of(std::int64_t begin, std::int64_t end) const {
        return own ? *std::max_element(own + begin, own + end) : same;
    }
    /// Of the samples in `range`, those that the pixel has.
    [[nodiscard]] std::uint32_t within(const SampleRange& range, std::int64_t pixel) const {
        if (!own) return range.count;
        return std::min(own[pixel] - std::min(own[pixel], range.first), range.count);
    }
};

/// Sums over samples (H, W, 3), of the radiance and of its square, for mean and variance; further
/// calls may add samples. Calls may be cut anywhere between samples; the bits are the same only for
/// the same cuts, since the tracer may name either triangle at a common edge, depending on the rays
/// beside.
struct PathSums {
    double *radiance, *squares;

    template <class R>
    void add(std::int64_t pixel, const Vec3<R>& L) const {
        for (int c = 0; c < 3; ++c) {
            const auto value = static_cast<double>(L[c]);
            radiance[3 * pixel + c] += value;
            squares[3 * pixel + c] += value * value;
        }
    }
};

/// With `hits` (H, W) what a camera ray sees of the background is left out, as alpha asks: `hits`
/// counts the samples that hit anything else, and those that do not add nothing to the sums.
template <Real R>
void trace_paths(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                 const SampleRange& samples, const PathSums& sums, double* hits = nullptr);

/// Adds derivatives for dL/d(mean radiance) (H, W, 3) of `spp` samples a pixel, or of `counts` (H,
/// W), at least 1 each, if that is given, to the sums of all blocks of the scene. Numbers of
/// samples may follow d_image, if its noise is not that of these paths: each pixel's part is the
/// mean of its own samples, so that their number changes the noise of the sum, not its expectation.
/// Memory does not grow with the size of the picture or the number of samples.
template <Real R>
void trace_paths_backward(const PathScene<R>& scene, const ThinLens& camera,
                          const PathOptions& options, std::uint32_t spp,
                          const std::uint32_t* counts, const double* d_image,
                          std::span<const GradientBlock<R>> blocks);

/// One path, to look at its vertices.
template <Real R>
Path<R> trace_path(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                   std::uint32_t pixel, std::uint32_t sample);

}  // namespace photograd
