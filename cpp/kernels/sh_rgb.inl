// Spherical-harmonic colors and their derivatives, sixteen points at a time. Functions of direction
// alone (the basis and its derivative) run with one point a lane. What touches coefficients runs
// point by point with the three channels of a coefficient as a vector: they lie side by side in
// memory, 12 K bytes a point, and reading and writing those once is what takes the time.
//
// Vectors are four wide, so the fourth float belongs to the next coefficient and is dropped; the
// last coefficient of a point is read one float early instead, so that nothing behind the array is
// touched.
#pragma once

#include "kernels/sh_rgb.h"
#include "photograd/core/lanes.h"
#include "photograd/ops/sh.h"

namespace photograd::PHOTOGRAD_ISA {

using ShRgb4 = float __attribute__((vector_size(16), aligned(4), may_alias));

template <int Degree>
struct ShPoints {
    static constexpr int count = sh_count(Degree);  // coefficients K
    static constexpr int stride = 3 * count;        // floats of a point
    Lanes<float> x, y, z;
    Lanes<float> Y[count];
};

// Coefficient k of a point. K - 1 is the only one for which (k < last) is false.
static inline ShRgb4 coefficient(const float* point, int k, int last) {
    const auto load = [](const float* p) { return *reinterpret_cast<const ShRgb4*>(p); };
    if (k < last) return load(point + 3 * k);
    const ShRgb4 early = load(point + 3 * k - 1);
    return __builtin_shufflevector(early, early, 1, 2, 3, 3);
}

// Directions of n points and the basis there. Lanes beyond n hold the direction 0.
template <int Degree>
static inline void evaluate_basis(const float* directions, int n, ShPoints<Degree>& points) {
    points.x = points.y = points.z = {};
    for (int i = 0; i < n; ++i) {
        points.x[i] = directions[3 * i];
        points.y[i] = directions[3 * i + 1];
        points.z[i] = directions[3 * i + 2];
    }
    for (int i = 0; i < lane_count; ++i) {
        float Y[ShPoints<Degree>::count];
        sh_basis<Degree>(points.x[i], points.y[i], points.z[i], Y);
        for (int k = 0; k < ShPoints<Degree>::count; ++k) points.Y[k][i] = Y[k];
    }
}

template <int Degree>
static void sh_rgb_points(const ShRgbArgs& a, std::int64_t from, int n, float* colors) {
    constexpr int last = ShPoints<Degree>::count - 1;
    ShPoints<Degree> points;
    evaluate_basis(a.directions + 3 * from, n, points);
    float out[3 * lane_count + 1];
    for (int i = 0; i < n; ++i) {
        const float* row = a.coefficients + ShPoints<Degree>::stride * (from + i);
        ShRgb4 color = points.Y[0][i] * coefficient(row, 0, last);
        for (int k = 1; k <= last; ++k) color = color + points.Y[k][i] * coefficient(row, k, last);
        *reinterpret_cast<ShRgb4*>(out + 3 * i) = color;
    }
    for (int j = 0; j < 3 * n; ++j) colors[3 * from + j] = out[j];
}

// dL/dY_k of four points: the products of the channels, added up across each vector.
static inline ShRgb4 channel_sums(const ShRgb4* p) {
    const ShRgb4 ab01 = __builtin_shufflevector(p[0], p[1], 0, 4, 1, 5);
    const ShRgb4 cd01 = __builtin_shufflevector(p[2], p[3], 0, 4, 1, 5);
    const ShRgb4 ab2 = __builtin_shufflevector(p[0], p[1], 2, 6, 2, 6);
    const ShRgb4 cd2 = __builtin_shufflevector(p[2], p[3], 2, 6, 2, 6);
    const ShRgb4 red = __builtin_shufflevector(ab01, cd01, 0, 1, 4, 5);
    const ShRgb4 green = __builtin_shufflevector(ab01, cd01, 2, 3, 6, 7);
    const ShRgb4 blue = __builtin_shufflevector(ab2, cd2, 0, 1, 4, 5);
    return (red + green) + blue;
}

// d_color[i] of n points as vectors of four, the fourth zero; lanes beyond n are zero.
static inline void load_cotangents(const float* d_colors, int n, ShRgb4* d_color) {
    for (int i = 0; i < lane_count; ++i) {
        const float* d = d_colors + 3 * i;
        d_color[i] = i < n ? ShRgb4{d[0], d[1], d[2], 0.0f} : ShRgb4{};
    }
}

template <int Degree>
static inline void basis_cotangents(const float* rows, int n, const ShRgb4* d_color,
                                    Lanes<float>* d_Y) {
    constexpr int last = ShPoints<Degree>::count - 1, stride = ShPoints<Degree>::stride;
    for (int i = 0; i < n; i += 4) {
        const float* row[4];  // behind the last point, the last point again
        for (int j = 0; j < 4; ++j) row[j] = rows + stride * smaller(i + j, n - 1);
        for (int k = 0; k <= last; ++k) {
            ShRgb4 product[4];
            for (int j = 0; j < 4; ++j) product[j] = coefficient(row[j], k, last) * d_color[i + j];
            *reinterpret_cast<ShRgb4*>(&d_Y[k][i]) = channel_sums(product);
        }
    }
}

// d_direction of n points, three floats a point.
template <int Degree>
static inline void direction_cotangents(const ShPoints<Degree>& points, const Lanes<float>* d_Y,
                                        Lanes<float>* d) {
    for (int i = 0; i < lane_count; ++i) {
        float of_point[ShPoints<Degree>::count], out[3] = {};
        for (int k = 0; k < ShPoints<Degree>::count; ++k) of_point[k] = d_Y[k][i];
        sh_basis_backward<Degree>(points.x[i], points.y[i], points.z[i], of_point, out);
        for (int c = 0; c < 3; ++c) d[c][i] = out[c];
    }
}

// Adds `count` floats to the gradient, or overwrites it.
static inline void deliver(const float* from, int count, bool add, float* to) {
    if (add)
        for (int j = 0; j < count; ++j) to[j] = to[j] + from[j];
    else
        for (int j = 0; j < count; ++j) to[j] = from[j];
}

template <int Degree>
static void sh_rgb_points_backward(const ShRgbArgs& a, const ShRgbBackward& back, std::int64_t from,
                                   int n) {
    constexpr int count = ShPoints<Degree>::count, stride = ShPoints<Degree>::stride;
    ShPoints<Degree> points;
    evaluate_basis(a.directions + 3 * from, n, points);
    ShRgb4 d_color[lane_count];
    load_cotangents(back.d_colors + 3 * from, n, d_color);

    Lanes<float> d_Y[count] = {}, d_direction[3];
    basis_cotangents<Degree>(a.coefficients + stride * from, n, d_color, d_Y);
    direction_cotangents(points, d_Y, d_direction);
    for (int i = 0; i < n; ++i)
        for (int c = 0; c < 3; ++c) {
            float& to = back.d_directions[3 * (from + i) + c];
            to = back.add ? to + d_direction[c][i] : d_direction[c][i];
        }

    // The fourth float of a product is overwritten by the next one.
    alignas(64) float rows[lane_count * stride + 4];
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < count; ++k)
            *reinterpret_cast<ShRgb4*>(rows + stride * i + 3 * k) = points.Y[k][i] * d_color[i];
    deliver(rows, stride * n, back.add, back.d_coefficients + stride * from);
}

// Calls visit(first point, number of points) for sixteen of [begin, end) at a time.
template <class Visit>
static inline void for_point_blocks(std::int64_t begin, std::int64_t end, Visit&& visit) {
    for (std::int64_t from = begin; from < end; from += lane_count)
        visit(from, static_cast<int>(smaller<std::int64_t>(lane_count, end - from)));
}

static void sh_rgb(const ShRgbArgs& a, std::int64_t begin, std::int64_t end, float* colors) {
    for_point_blocks(begin, end, [&](std::int64_t from, int n) {
        switch (a.degree) {
            case 1: return sh_rgb_points<1>(a, from, n, colors);
            case 2: return sh_rgb_points<2>(a, from, n, colors);
            case 3: return sh_rgb_points<3>(a, from, n, colors);
            default: return sh_rgb_points<4>(a, from, n, colors);
        }
    });
}
static void sh_rgb_backward(const ShRgbArgs& a, const ShRgbBackward& back, std::int64_t begin,
                            std::int64_t end) {
    for_point_blocks(begin, end, [&](std::int64_t from, int n) {
        switch (a.degree) {
            case 1: return sh_rgb_points_backward<1>(a, back, from, n);
            case 2: return sh_rgb_points_backward<2>(a, back, from, n);
            case 3: return sh_rgb_points_backward<3>(a, back, from, n);
            default: return sh_rgb_points_backward<4>(a, back, from, n);
        }
    });
}

}  // namespace photograd::PHOTOGRAD_ISA
