// Shadow maps: what a light sees, and percentage-closer filtering of comparisons with it
// [Williams1978; Reeves1987].
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "photograd/core/real.h"
#include "photograd/core/vec.h"

namespace photograd {

/// A depth buffer (S, S) and the map of points (x, y, z, 1) of the world to its homogeneous pixels;
/// a shadow map has six of them where a light shines in all directions.
struct ShadowView {
    std::array<double, 12> pixels_from_world;
    const double* depth;
};

struct ShadowFilter {
    int size;            // S
    int radius;          // texels: comparisons with (2 radius + 1)^2 of them are averaged
    double depth_bias;   // meters along the light's axis
    double normal_bias;  // texels, by which points are moved along their normals
    double texel;        // width of a texel at a depth of 1 m, meters
};

/// visibility (N) from 0 to 1 of points (N, 3) with unit normals (N, 3); 1 outside of all views,
/// and where the normal is 0.
template <Real R>
void shadow_lookup(std::span<const ShadowView> views, const ShadowFilter& filter,
                   std::int64_t count, const R* points, const R* normals, R* visibility);

}  // namespace photograd
