// A body of signed distances with fixed numbers and an end on all sides, as the tracer meets it [Hart1996].
//
// Rays march by |f|, from outside and from inside alike: nothing lies nearer, so no step passes the surface. They start
// `offset` away from surfaces (scene/path_scene.h), a hundred tolerances and more, and so never meet the one they leave.
// The march is bounded: a ray that grazes for `most_steps` steps has met what it grazes. It takes less than 1 / 300 as the
// cosine to do so; to let it pass instead would be a hole in the surface.
#pragma once

#include <vector>

#include "photograd/core/ray.h"
#include "photograd/geometry/ray_order.h"
#include "photograd/geometry/sdf_step.h"

namespace photograd {

/// Where a ray met the surface; the normal points out of the body, whichever side the ray came from.
struct SdfPoint {
    double t;
    Vec3<double> position, normal;
};

class SdfSolid {
public:
    static constexpr int most_steps = 4096;

    /// Refuses (SceneError) bodies that are empty or have no end, and those that nest too deeply for the stack.
    SdfSolid(const Sdf& body, const double* numbers);

    [[nodiscard]] double distance(const Vec3<double>& p) const;
    [[nodiscard]] Vec3<double> gradient(const Vec3<double>& p) const;
    /// All of the body, and a little more.
    [[nodiscard]] const Box& bounds() const { return bounds_; }
    /// What counts as the surface while marching, metres.
    [[nodiscard]] double tolerance() const { return tolerance_; }

    /// The first t in [t_min, t_max], in lengths of the direction, at which the surface is met; infinite if none is.
    [[nodiscard]] double march(const Ray<double>& ray, double t_min, double t_max) const;
    /// The same hit to rounding, along a direction of unit length.
    [[nodiscard]] SdfPoint point(const Ray<double>& ray, double found_t) const;

private:
    std::vector<SdfStep> steps_;
    Box bounds_;
    double tolerance_ = 0;
};

}  // namespace photograd
