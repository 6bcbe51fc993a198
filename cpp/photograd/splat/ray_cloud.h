// Gaussians prepared for ray casting: whitened, bounded, in a bounding volume hierarchy.
//
// Along a ray a Gaussian exceeds alpha_min only where q <= q_max = 2 ln(opacity / alpha_min),
// inside an ellipsoid. Its box, mean +- sqrt(q_max cov_kk), contains the peak of every ray on which
// the Gaussian is visible. Without alpha_min every Gaussian is tested against every ray.
#pragma once

#include <cmath>
#include <vector>

#include "photograd/core/parallel.h"
#include "photograd/ops/activation.h"
#include "photograd/splat/box_tree.h"
#include "photograd/splat/cloud_check.h"
#include "photograd/splat/ray_blend.h"
#include "photograd/splat/ray_gaussian.h"

namespace photograd {

struct RayOptions {
    double alpha_min = 1.0 / 255.0;
    double alpha_max = 0.999;
    double stop = 1e-4;
    double t_min = 0.01;  // meters; peaks nearer to the origin, or behind it, are ignored

    template <class R>
    [[nodiscard]] RayCutoffs<R> cutoffs() const {
        return {R(alpha_min), R(alpha_max), R(stop)};
    }
};

/// A standard deviation, in meters, is no thinner and no wider; nor is a mean farther away than
/// `max_mean`.
inline constexpr double min_sigma = 1e-12, max_sigma = 1e12, max_mean = 1e15;
/// Beyond, exp(-q / 2) < 1e-34 counts as zero.
inline constexpr double max_q = 160.0;

template <class R>
struct CastGaussian {
    RayGaussian<R> shape;
    R opacity;
    std::uint32_t row;

    /// alpha before it is clamped to alpha_max.
    [[nodiscard]] R raw(const RayPeak<R>& peak) const {
        return peak.q < R(max_q) ? opacity * exp(R(-0.5) * peak.q) : R(0);
    }
};

/// The Gaussian of one row and its box; false if it is visible on no ray.
template <class R>
bool cast_gaussian(const GaussianCloud<R>& cloud, const RayOptions& options, std::int64_t i,
                   CastGaussian<R>& out, BoxBounds<R>& box) {
    const R* mean = cloud.means + 3 * i;
    const GaussianAxes<R> axes = GaussianAxes<R>::of(cloud.quats + 4 * i, cloud.log_scales + 3 * i);
    for (int k = 0; k < 3; ++k)
        if (!(axes.s[k] > R(min_sigma) && axes.s[k] < R(max_sigma) && mean[k] < R(max_mean) &&
              mean[k] > R(-max_mean)))
            return false;
    out = {RayGaussian<R>::of(mean, axes), sigmoid(cloud.opacity_logits[i]),
           static_cast<std::uint32_t>(i)};
    R q_max = R(0);
    if (options.alpha_min > 0) {
        const R faintest = out.opacity / R(options.alpha_min);
        if (!(faintest >= R(1))) return false;
        q_max = R(2.02) * std::log(faintest) + R(0.1);  // a little too large
    }
    for (int k = 0; k < 3; ++k) {
        const R* m = axes.m[k];
        const R half = options.alpha_min > 0
                           ? sqrt(q_max * (m[0] * m[0] + m[1] * m[1] + m[2] * m[2]))
                           : R(1e30);
        const R rounding = R(1e-6) * (larger(mean[k], -mean[k]) + half);
        box.lo[k] = mean[k] - half - rounding;
        box.hi[k] = mean[k] + half + rounding;
    }
    return out.opacity > R(0);
}

template <class R>
struct RayCloud {
    RayOptions options;
    std::vector<CastGaussian<R>> gaussians;  // in the order of the tree's leaves
    BoxTree<R> tree;
};

inline constexpr std::int64_t cast_per_task = 4096;

/// Throws RangeError for parameters that are not finite.
template <class R>
RayCloud<R> prepare_ray_cloud(const GaussianCloud<R>& cloud, const RayOptions& options) {
    const std::int64_t tasks = (cloud.count + cast_per_task - 1) / cast_per_task;
    const auto rows = static_cast<std::size_t>(cloud.count);
    std::vector<CastGaussian<R>> cast(rows);
    std::vector<BoxBounds<R>> boxes(rows);
    std::vector<char> visible(rows), bad(static_cast<std::size_t>(tasks));
    parallel_for(tasks, [&](std::int64_t task) {
        const std::int64_t end = std::min(cloud.count, (task + 1) * cast_per_task);
        for (std::int64_t i = task * cast_per_task; i < end; ++i) {
            const auto row = static_cast<std::size_t>(i);
            if (bad_group(cloud, i)) bad[static_cast<std::size_t>(task)] = 1;
            visible[row] = cast_gaussian(cloud, options, i, cast[row], boxes[row]) ? 1 : 0;
        }
    });
    refuse_bad_rows("splat_rays", cloud, bad, cast_per_task);
    std::size_t kept = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        if (!visible[row]) continue;
        cast[kept] = cast[row];
        boxes[kept++] = boxes[row];
    }
    RayCloud<R> out{options, {}, BoxTree<R>(std::span<const BoxBounds<R>>(boxes.data(), kept))};
    out.gaussians.reserve(kept);
    for (const std::uint32_t item : out.tree.order()) out.gaussians.push_back(cast[item]);
    return out;
}

}  // namespace photograd
