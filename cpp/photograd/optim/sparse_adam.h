// Adam [Kingma2015] on the rows of an array that have a gradient, in one pass over memory.
//
//   m <- beta_1 m + (1 - beta_1) g,   v <- beta_2 v + (1 - beta_2) g^2,
//   p <- p - step_size m / (sqrt(v) + epsilon)
//
// step_size and epsilon carry the bias correction (photograd_course.optim.adam). A row whose
// gradient is zero keeps every bit, moments included: lazy updates, as in sparse optimizers. Most
// rows of a sparse grid are such rows, and only their gradient is read.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "photograd/core/parallel.h"
#include "photograd/core/real.h"

namespace photograd {

/// In double: 1 - 0.999 would lose five digits in float.
struct AdamStep {
    double beta_1, beta_2, step_size, epsilon;
};

/// parameter, mean and mean_square (rows, width) are changed in place.
template <Real R>
void sparse_adam(const AdamStep& s, std::int64_t rows, std::int64_t width, const R* gradient,
                 R* parameter, R* mean, R* mean_square) {
    constexpr std::int64_t rows_per_task = 2048;
    const R beta_1 = static_cast<R>(s.beta_1), beta_2 = static_cast<R>(s.beta_2),
            step_size = static_cast<R>(s.step_size), epsilon = static_cast<R>(s.epsilon),
            rest_1 = static_cast<R>(1.0 - s.beta_1),
            ratio = static_cast<R>((1.0 - s.beta_2) / (1.0 - s.beta_1));
    parallel_for((rows + rows_per_task - 1) / rows_per_task, [&](std::int64_t task) {
        const std::int64_t last = std::min(rows, (task + 1) * rows_per_task);
        for (std::int64_t row = task * rows_per_task; row < last; ++row) {
            const R* g = gradient + row * width;
            bool any = false;
            for (std::int64_t j = 0; j < width; ++j) any |= g[j] != R(0);
            if (!any) continue;
            R *p = parameter + row * width, *m = mean + row * width, *v = mean_square + row * width;
            for (std::int64_t j = 0; j < width; ++j) {
                const R part = g[j] * rest_1;
                m[j] = m[j] * beta_1 + part;
                v[j] = v[j] * beta_2 + (part * g[j]) * ratio;
                p[j] = p[j] - m[j] / (std::sqrt(v[j]) + epsilon) * step_size;
            }
        }
    });
}

}  // namespace photograd
