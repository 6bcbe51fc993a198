#include "photograd/geometry/sdf_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "photograd/core/errors.h"
#include "photograd/core/world_limit.h"
#include "photograd/geometry/sdf_layout.h"

namespace photograd {
namespace {

/// Cuts [t_min, t_max] to what lies in the box; false if nothing does.
bool clip(const Box& box, const Ray<double>& ray, double& t_min, double& t_max) {
    for (int k = 0; k < 3; ++k) {
        const double o = ray.origin[k], d = ray.direction[k];
        if (d == 0) {
            if (o < double(box.lo[k]) || o > double(box.hi[k])) return false;
            continue;
        }
        const double a = (double(box.lo[k]) - o) / d, b = (double(box.hi[k]) - o) / d;
        t_min = std::max(t_min, std::min(a, b));
        t_max = std::min(t_max, std::max(a, b));
    }
    return t_min <= t_max;
}

}  // namespace

SdfSolid::SdfSolid(const Sdf& body, const double* numbers) {
    SdfReach reach;
    steps_ = lay_out(body, numbers, reach);
    double largest = 0;
    for (int k = 0; k < 3; ++k) {
        if (!(reach.lo[k] < reach.hi[k]))
            fail(ErrorKind::scene, "SdfSolid", "body", "something inside", "nothing is left of it");
        largest = std::max({largest, std::abs(reach.lo[k]), std::abs(reach.hi[k])});
    }
    if (!(largest < 1e30))
        fail(ErrorKind::scene, "SdfSolid", "body", "an end on all sides", "none",
             "intersect planes with a box or a sphere");
    if (!(largest <= world_limit))
        fail(ErrorKind::scene, "SdfSolid", "body",
             "all of it within " + number_text(world_limit) + " m of the origin",
             number_text(largest) + " m");
    tolerance_ = 1e-7 * largest;
    for (int k = 0; k < 3; ++k) {
        // Rounding to float takes less than this away.
        bounds_.lo[k] = static_cast<float>(reach.lo[k] - 4 * tolerance_);
        bounds_.hi[k] = static_cast<float>(reach.hi[k] + 4 * tolerance_);
    }
}

double SdfSolid::distance(const Vec3<double>& p) const { return steps_distance<double>(steps_, p); }

Vec3<double> SdfSolid::gradient(const Vec3<double>& p) const { return steps_gradient(steps_, p); }

double SdfSolid::march(const Ray<double>& ray, double t_min, double t_max) const {
    constexpr double missed = std::numeric_limits<double>::infinity();
    if (!clip(bounds_, ray, t_min, t_max)) return missed;
    const double per_meter = 1 / length(ray.direction);
    double t = t_min, f = distance(ray.at(t));
    const bool inside = f < 0;
    for (int step = 0; step < most_steps; ++step) {
        const double gap = inside ? -f : f;
        if (gap <= tolerance_) return t;
        t += gap * per_meter;
        if (!(t <= t_max)) return missed;
        f = distance(ray.at(t));
    }
    return t;
}

SdfPoint SdfSolid::point(const Ray<double>& ray, double found_t) const {
    double t = found_t, f = distance(ray.at(t));
    // Newton's steps along the ray, none longer than half a chord at whose middle the surface is a
    // tolerance deep.
    const double size = length(Vec3<double>(bounds_.hi) - Vec3<double>(bounds_.lo));
    for (int step = 0; step < 8 && f != 0; ++step) {
        const double slope = dot(gradient(ray.at(t)), ray.direction), next = t - f / slope;
        if (!(std::abs(next - t) <= 1e-3 * size)) break;
        const double f_next = distance(ray.at(next));
        if (!(std::abs(f_next) < std::abs(f))) break;
        t = next;
        f = f_next;
    }
    // Where the ray only grazes the surface: steps along the gradient, to a point beside the ray.
    Vec3<double> p = ray.at(t), g = gradient(p);
    for (int step = 0; step < 4 && f != 0; ++step) {
        const Vec3<double> nearer = p - g * (f / dot(g, g));
        const double f_nearer = distance(nearer);
        if (!(std::abs(f_nearer) < std::abs(f))) break;
        p = nearer;
        f = f_nearer;
        g = gradient(p);
    }
    const double slope = length(g);
    return {t, p, slope > 0 ? g / slope : -ray.direction};
}

}  // namespace photograd
