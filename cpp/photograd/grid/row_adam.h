// Adam [Kingma2015] on the rows of an array that have a gradient, in one pass over memory.
//
//   m <- beta_1 m + (1 - beta_1) g,   v <- beta_2 v + (1 - beta_2) g^2,   p <- p - a m / (sqrt(v) + e)
//
// a and e carry the bias correction of the step (photograd_course.optim.adam). A row whose gradient is
// zero throughout keeps every bit, moments included: no sample has touched it. In a sparse grid that is
// most of them, and reading the gradient is then all that is done.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "photograd/core/parallel.h"
#include "photograd/core/real.h"

namespace photograd {

/// In double: 1 - 0.999 would lose five digits in float.
struct AdamStep {
    double beta_1, beta_2, a, e;
};

/// parameter, mean and mean_square (rows, width) are changed in place.
template <Real R>
void adam_rows(const AdamStep& s, std::int64_t rows, std::int64_t width, const R* gradient,
               R* parameter, R* mean, R* mean_square) {
    constexpr std::int64_t rows_a_task = 2048;
    const R beta_1 = static_cast<R>(s.beta_1), beta_2 = static_cast<R>(s.beta_2),
            a = static_cast<R>(s.a), e = static_cast<R>(s.e),
            rest_1 = static_cast<R>(1.0 - s.beta_1),
            ratio = static_cast<R>((1.0 - s.beta_2) / (1.0 - s.beta_1));
    parallel_for((rows + rows_a_task - 1) / rows_a_task, [&](std::int64_t task) {
        const std::int64_t last = std::min(rows, (task + 1) * rows_a_task);
        for (std::int64_t row = task * rows_a_task; row < last; ++row) {
            const R* g = gradient + row * width;
            bool any = false;
            for (std::int64_t j = 0; j < width; ++j) any |= g[j] != R(0);
            if (!any) continue;
            R *p = parameter + row * width, *m = mean + row * width, *v = mean_square + row * width;
            for (std::int64_t j = 0; j < width; ++j) {
                const R part = g[j] * rest_1;
                m[j] = m[j] * beta_1 + part;
                v[j] = v[j] * beta_2 + (part * g[j]) * ratio;
                p[j] = p[j] - m[j] / (std::sqrt(v[j]) + e) * a;
            }
        }
    });
}

}  // namespace photograd
