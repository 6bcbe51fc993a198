#include "photograd/geometry/reference/sphere_trace.h"

#include <cmath>
#include <limits>
#include <span>

#include "photograd/core/scatter.h"

namespace photograd {
namespace {

constexpr std::int64_t block_size = 1024;  // rays of one task

/// f and its slope along the ray, df/dt.
double slope_along(const Sdf& body, const double* numbers, const Ray<double>& ray, double t,
                   std::vector<double>& unused) {
    Vec3<double> gradient(0);
    body.backward(numbers, ray.at(t), 1.0, gradient, unused.data());
    return dot(gradient, ray.direction);
}

/// From within the tolerance to rounding, if Newton's steps lead there.
double polished(const Sdf& body, const double* numbers, const Ray<double>& ray, double t,
                double t_min, std::vector<double>& unused) {
    double f = body.distance(numbers, ray.at(t));
    for (int step = 0; step < 8 && f != 0; ++step) {
        const double slope = slope_along(body, numbers, ray, t, unused);
        const double next = t - f / slope;
        if (!(next >= t_min)) break;  // no number, or away from the surface and out of the interval
        const double f_next = body.distance(numbers, ray.at(next));
        if (!(std::abs(f_next) < std::abs(f))) break;
        t = next;
        f = f_next;
    }
    return t;
}

struct March {
    double t;
    std::int32_t steps;
    SdfEnd end;
};

March march_ray(const Sdf& body, const double* numbers, const Ray<double>& ray,
                const SdfMarch& march, std::vector<double>& unused) {
    const double per_meter = 1 / length(ray.direction);
    double t = march.t_min;
    for (std::int32_t step = 1; step <= march.max_steps; ++step) {
        const double f = body.distance(numbers, ray.at(t));
        if (f <= march.tolerance) {
            if (t > march.t_min) t = polished(body, numbers, ray, t, march.t_min, unused);
            return {t, step, SdfEnd::hit};
        }
        t += f * per_meter;
        if (!(t <= march.t_max))
            return {std::numeric_limits<double>::infinity(), step, SdfEnd::missed};
    }
    return {t, march.max_steps, SdfEnd::gave_up};
}

}  // namespace

void trace_sdf(const Sdf& body, const double* numbers, const RaySpan<double>& rays,
               const SdfMarch& march, const SdfHits& hits) {
    parallel_for((rays.count + block_size - 1) / block_size, [&](std::int64_t block) {
        std::vector<double> unused(static_cast<std::size_t>(body.number_count()));
        const std::int64_t end = std::min(rays.count, (block + 1) * block_size);
        for (std::int64_t i = block * block_size; i < end; ++i) {
            const March found = march_ray(body, numbers, rays.ray(i), march, unused);
            hits.t[i] = found.t;
            hits.steps[i] = found.steps;
            hits.end[i] = found.end;
        }
    });
}

void trace_sdf_backward(const Sdf& body, const double* numbers, const RaySpan<double>& rays,
                        const SdfMarch& march, const double* t, const SdfEnd* end,
                        const double* d_t, double* d_numbers, double* d_origins,
                        double* d_directions) {
    const std::span<double> total(d_numbers, static_cast<std::size_t>(body.number_count()));
    const std::int64_t blocks = (rays.count + block_size - 1) / block_size;
    sum_partials(blocks, total, [&](std::int64_t block, std::span<double> d_sum) {
        std::vector<double> unused(d_sum.size());
        const std::int64_t last = std::min(rays.count, (block + 1) * block_size);
        for (std::int64_t i = block * block_size; i < last; ++i) {
            if (end[i] != SdfEnd::hit || !(t[i] > march.t_min) || d_t[i] == 0) continue;
            const Ray<double> ray = rays.ray(i);
            const double weight = -d_t[i] / slope_along(body, numbers, ray, t[i], unused);
            Vec3<double> d_p(0);
            body.backward(numbers, ray.at(t[i]), weight, d_p, d_sum.data());
            for (int k = 0; k < 3; ++k) {
                d_origins[3 * i + k] += d_p[k];
                d_directions[3 * i + k] += t[i] * d_p[k];
            }
        }
    });
}

}  // namespace photograd
