// A box along the axes, and the part of a ray that lies in it [Kay1986].
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "photograd/core/ray.h"

namespace photograd {

struct Aabb {
    Vec3<double> lo = Vec3<double>(std::numeric_limits<double>::infinity());
    Vec3<double> hi = Vec3<double>(-std::numeric_limits<double>::infinity());

    void add(const Vec3<double>& p) {
        for (int k = 0; k < 3; ++k) {
            lo[k] = std::min(lo[k], p[k]);
            hi[k] = std::max(hi[k], p[k]);
        }
    }
    void add(const Aabb& box) {  // by ends, not by corners: an empty box adds nothing
        for (int k = 0; k < 3; ++k) {
            lo[k] = std::min(lo[k], box.lo[k]);
            hi[k] = std::max(hi[k], box.hi[k]);
        }
    }
    [[nodiscard]] bool empty() const { return !(lo.x <= hi.x); }
    /// Half the surface: what the chance of being met by a random line is proportional to.
    [[nodiscard]] double half_area() const {
        if (empty()) return 0;
        const Vec3<double> e = hi - lo;
        return e.x * e.y + e.y * e.z + e.z * e.x;
    }
};

/// Whether the ray hits the box within [t_min, t_max]. Between the two planes of an axis it is for
/// t from (lo - o) / d to (hi - o) / d, the larger last; in the box where it is between all three
/// pairs.
///
/// The interval is widened by far more than what rounding here and in the test of a triangle can
/// make: a hit may be false, a miss never is. `enter` is where the ray comes in.
inline bool meets(const Aabb& box, const Ray<double>& ray, double t_min, double t_max,
                  double& enter) {
    constexpr double slack = 1e-12;
    for (int k = 0; k < 3; ++k) {
        const double o = ray.origin[k], d = ray.direction[k];
        if (d == 0) {  // parallel to both planes; 0 / 0 would be no number
            if (o < box.lo[k] || o > box.hi[k]) return false;
            continue;
        }
        const double a = (box.lo[k] - o) / d, b = (box.hi[k] - o) / d;
        const double near = std::min(a, b), far = std::max(a, b);
        t_min = std::max(t_min, near - slack * std::abs(near));
        t_max = std::min(t_max, far + slack * std::abs(far));
    }
    enter = t_min;
    return t_min <= t_max;
}

}  // namespace photograd
