// Rays through a bounding volume hierarchy, one at a time, with a stack of what is left to look at.
#pragma once

#include "photograd/geometry/reference/bvh_build.h"
#include "photograd/geometry/triangle.h"

namespace photograd {

/// primitive is -1, and t infinite, where nothing was met.
struct NearestHit {
    double t, u, v;
    std::int32_t primitive;
};

/// Cost of a ray.
struct Visits {
    std::int32_t boxes = 0, triangles = 0;
};

/// The nearest hit of a ray within [t_min, t_max], or, with `any`, whichever is found first. Of
/// triangles hit at one and the same t, the one with the least number.
NearestHit walk_bvh(const Mesh& mesh, const BvhTree& tree, const Ray<double>& ray, double t_min,
                    double t_max, bool any, Visits& visits);

/// The nearest hit by testing all triangles, as a reference for `walk_bvh`.
NearestHit try_all_triangles(const Mesh& mesh, const Ray<double>& ray, double t_min, double t_max);

}  // namespace photograd
