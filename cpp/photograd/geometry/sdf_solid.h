// A bounded signed distance field (SDF) with fixed parameters, for the path tracer: sphere tracing
// [Hart1996].
//
// A ray advances by |f|, outside and inside alike: nothing lies nearer, so no step passes the
// surface. Rays start `offset` away from surfaces (scene/path_scene.h), a hundred tolerances and
// more, so that they do not hit the surface they leave. After `most_steps` steps the ray counts as
// a hit: only cosines below 1 / 300 take so many, and a miss would be a hole in the surface.
#pragma once

#include <vector>

#include "photograd/core/ray.h"
#include "photograd/geometry/ray_order.h"
#include "photograd/geometry/sdf_step.h"

namespace photograd {

/// Where a ray hits the surface; the normal points outwards, whichever side the ray came from.
struct SdfPoint {
    double t;
    Vec3<double> position, normal;
};

class SdfSolid {
public:
    static constexpr int most_steps = 4096;

    /// Throws SceneError if the field is empty, unbounded, or nested too deeply for the stack.
    SdfSolid(const Sdf& body, const double* numbers);

    [[nodiscard]] double distance(const Vec3<double>& p) const;
    [[nodiscard]] Vec3<double> gradient(const Vec3<double>& p) const;
    /// The bounding box, slightly enlarged.
    [[nodiscard]] const Box& bounds() const { return bounds_; }
    /// What counts as the surface while marching, meters.
    [[nodiscard]] double tolerance() const { return tolerance_; }

    /// The first hit t in [t_min, t_max], in lengths of the direction; infinite if there is none.
    [[nodiscard]] double march(const Ray<double>& ray, double t_min, double t_max) const;
    /// Refines the hit found_t of `march` to rounding, along a direction of unit length.
    [[nodiscard]] SdfPoint point(const Ray<double>& ray, double found_t) const;

private:
    std::vector<SdfStep> steps_;
    Box bounds_;
    double tolerance_ = 0;
};

}  // namespace photograd
