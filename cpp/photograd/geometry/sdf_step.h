// One entry of the list that a signed distance field (SDF) is laid out as (sdf_steps.h).
#pragma once

#include <array>

#include "photograd/geometry/affine.h"
#include "photograd/geometry/reference/sdf.h"

namespace photograd {

struct SdfStep {
    static constexpr int deepest = 64;  // distances that wait on the stack
    SdfKind kind;
    std::array<double, 4> x;  // its numbers, in meters of the world
    Affine shape_from_world;  // of a shape: rotation and shift
};

}  // namespace photograd
