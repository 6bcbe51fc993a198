// Gaussians made ready for rays: whitened, boxed, and in a tree.
//
// A Gaussian is brighter than alpha_min along a ray only where q <= q_max = 2 ln(opacity / alpha_min), inside
// an ellipsoid. Its box, mean +- sqrt(q_max cov_kk), holds the peak of every ray that the Gaussian is in,
// so the tree finds all of them. Without alpha_min each ray looks at every Gaussian.
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
    double t_min = 0.01;  // metres; what peaks nearer to the origin, or behind it, is not seen

    template <class R>
    [[nodiscard]] RayCutoffs<R> cutoffs() const {
        return {R(alpha_min), R(alpha_max), R(stop)};
    }
};

/// A standard deviation, in metres, is no thinner and no wider; nor is a mean farther away than `farthest`.
inline constexpr double thinnest = 1e-12, widest = 1e12, farthest = 1e15;
/// exp(-q / 2) is nothing beyond, 1e-35.
inline constexpr double largest_q = 160.0;

template <class R>
struct CastGaussian {
    RayGaussian<R> shape;
    R opacity;
    std::uint32_t row;

    /// What the ray sees, before it is held at alpha_max.
    [[nodiscard]] R raw(const RayPeak<R>& peak) const {
        return peak.q < R(largest_q) ? opacity * exp(R(-0.5) * peak.q) : R(0);
    }
};

/// The Gaussian of one row and its box; false if no ray can see it.
template <class R>
bool cast_gaussian(const GaussianCloud<R>& cloud, const RayOptions& options, std::int64_t i,
                   CastGaussian<R>& out, BoxBounds<R>& box) {
    const R* mean = cloud.means + 3 * i;
    const GaussianAxes<R> axes = GaussianAxes<R>::of(cloud.quats + 4 * i, cloud.log_scales + 3 * i);
    for (int k = 0; k < 3; ++k)
        if (!(axes.s[k] > R(thinnest) && axes.s[k] < R(widest) && mean[k] < R(farthest) &&
              mean[k] > R(-farthest)))
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
    std::vector<CastGaussian<R>> seen;  // in the order of the tree's leaves
    BoxTree<R> tree;
};

inline constexpr std::int64_t cast_per_task = 4096;

/// Refuses parameters that are no numbers.
template <class R>
RayCloud<R> prepare_ray_cloud(const GaussianCloud<R>& cloud, const RayOptions& options) {
    const std::int64_t tasks = (cloud.count + cast_per_task - 1) / cast_per_task;
    const auto rows = static_cast<std::size_t>(cloud.count);
    std::vector<CastGaussian<R>> cast(rows);
    std::vector<BoxBounds<R>> boxes(rows);
    std::vector<char> drawn(rows), bad(static_cast<std::size_t>(tasks));
    parallel_for(tasks, [&](std::int64_t task) {
        const std::int64_t end = std::min(cloud.count, (task + 1) * cast_per_task);
        for (std::int64_t i = task * cast_per_task; i < end; ++i) {
            const auto row = static_cast<std::size_t>(i);
            if (bad_group(cloud, i)) bad[static_cast<std::size_t>(task)] = 1;
            drawn[row] = cast_gaussian(cloud, options, i, cast[row], boxes[row]) ? 1 : 0;
        }
    });
    refuse_bad_rows("splat_rays", cloud, bad, cast_per_task);
    std::size_t kept = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        if (!drawn[row]) continue;
        cast[kept] = cast[row];
        boxes[kept++] = boxes[row];
    }
    RayCloud<R> out{options, {}, BoxTree<R>(std::span<const BoxBounds<R>>(boxes.data(), kept))};
    out.seen.reserve(kept);
    for (const std::uint32_t item : out.tree.order()) out.seen.push_back(cast[item]);
    return out;
}

}  // namespace photograd
