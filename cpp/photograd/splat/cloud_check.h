// Gaussians with parameters that are not finite are refused; the error names row and parameter.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "photograd/core/errors.h"
#include "photograd/ops/sh.h"
#include "photograd/splat/options.h"

namespace photograd {

template <class R>
bool all_numbers(const R* x, std::int64_t n) {
    int bad = 0;
    for (std::int64_t i = 0; i < n; ++i) bad |= x[i] - x[i] == R(0) ? 0 : 1;
    return bad == 0;
}

/// The group of row i that holds what no parameter may be; nullptr if there is none. A log-scale of
/// minus infinity (no extent) and infinite logits (fully opaque, or absent) have a meaning.
template <class R>
const char* bad_group(const GaussianCloud<R>& cloud, std::int64_t i) {
    const R* log_scale = cloud.log_scales + 3 * i;
    const std::int64_t stride = 3 * sh_count(cloud.degree);
    if (!all_numbers(cloud.means + 3 * i, 3)) return "means";
    for (int k = 0; k < 3; ++k)
        if (!(log_scale[k] < std::numeric_limits<R>::infinity())) return "log_scales";
    if (!all_numbers(cloud.quats + 4 * i, 4)) return "quats";
    if (std::isnan(cloud.opacity_logits[i])) return "opacity_logits";
    if (!all_numbers(cloud.sh + stride * i, stride)) return "sh";
    return nullptr;
}

/// Throws if a task of `rows_per_task` rows is marked: it names the first bad row of the first such
/// task.
template <class R>
void refuse_bad_rows(const char* function, const GaussianCloud<R>& cloud,
                     const std::vector<char>& bad_task, std::int64_t rows_per_task) {
    for (std::size_t task = 0; task < bad_task.size(); ++task) {
        if (!bad_task[task]) continue;
        for (auto i = static_cast<std::int64_t>(task) * rows_per_task;; ++i)
            if (const char* group = bad_group(cloud, i))
                fail(ErrorKind::range, function, group, "finite numbers",
                     "one that is not, in row " + std::to_string(i),
                     "remove the row, or find the step that made it");
    }
}

}  // namespace photograd
