// Spherical-harmonic colors of many points: N directions, N times K coefficients of C channels.
//
// Each row is its own: forward and backward run over rows in parallel, and nothing is shared.
#pragma once

#include <algorithm>
#include <cstdint>

#include "photograd/core/parallel.h"
#include "photograd/ops/sh.h"

namespace photograd {

/// Rows of the arrays below: directions (N, 3), coefficients (N, K, C), colors (N, C).
template <class R>
struct ShRows {
    std::int64_t count;
    const R* directions;
    const R* coefficients;
};

inline constexpr std::int64_t sh_rows_per_task = 4096;

/// visit(first, end) for all rows, cut into tasks.
template <class Visit>
void for_sh_rows(std::int64_t count, Visit&& visit) {
    const std::int64_t tasks = (count + sh_rows_per_task - 1) / sh_rows_per_task;
    parallel_for(tasks, [&](std::int64_t task) {
        visit(task * sh_rows_per_task, std::min(count, (task + 1) * sh_rows_per_task));
    });
}

/// colors[i] = sum_k Y_k(directions[i]) coefficients[i, k]
template <int Degree, int Channels, class R>
void sh_colors(const ShRows<R>& rows, R* colors) {
    constexpr int stride = sh_count(Degree) * Channels;
    for_sh_rows(rows.count, [&](std::int64_t first, std::int64_t end) {
        R Y[sh_count(Degree)];
        for (std::int64_t i = first; i < end; ++i) {
            const R* d = rows.directions + 3 * i;
            sh_basis<Degree>(d[0], d[1], d[2], Y);
            sh_color<Degree, Channels>(Y, rows.coefficients + stride * i, colors + Channels * i);
        }
    });
}
/// Adds to d_directions (N, 3) and d_coefficients (N, K, C); or, without `add`, overwrites them.
template <int Degree, int Channels, class R>
void sh_colors_backward(const ShRows<R>& rows, const R* d_colors, R* d_directions,
                        R* d_coefficients, bool add = true) {
    constexpr int stride = sh_count(Degree) * Channels;
    for_sh_rows(rows.count, [&](std::int64_t first, std::int64_t end) {
        R Y[sh_count(Degree)], d_Y[sh_count(Degree)];
        for (std::int64_t i = first; i < end; ++i) {
            const R* d = rows.directions + 3 * i;
            sh_basis<Degree>(d[0], d[1], d[2], Y);
            std::fill_n(d_Y, sh_count(Degree), R(0));
            if (!add) {
                std::fill_n(d_directions + 3 * i, 3, R(0));
                std::fill_n(d_coefficients + stride * i, stride, R(0));
            }
            sh_color_backward<Degree, Channels>(Y, rows.coefficients + stride * i,
                                                d_colors + Channels * i, d_Y,
                                                d_coefficients + stride * i);
            sh_basis_backward<Degree>(d[0], d[1], d[2], d_Y, d_directions + 3 * i);
        }
    });
}

}  // namespace photograd
