// The list of steps and the bounding box of a signed distance field, from its tree.
#pragma once

#include <vector>

#include "photograd/geometry/sdf_steps.h"

namespace photograd {

/// Infinite where a body has no end, lo > hi where nothing is left of it.
struct SdfReach {
    Vec3<double> lo, hi;
};

/// Refuses (SceneError) a tree that would need a higher stack than `SdfStep::deepest`.
std::vector<SdfStep> lay_out(const Sdf& body, const double* numbers, SdfReach& reach);

}  // namespace photograd
