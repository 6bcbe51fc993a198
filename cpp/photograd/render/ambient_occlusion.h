// Ambient occlusion: how much of the hemisphere is free, weighted with the cosine [Zhukov1998].
//
//   1 - A = (1 / pi) integral over the hemisphere of V(w) cos(w) dw
//
// where V is 0 if something stands within `radius` along w. Directions are sampled in proportion to
// the cosine, so each sample is V itself. Camera rays that meet nothing count as free.
//
// A picture of it is of one camera; a texture that holds it, of the point under each texel
// (geometry/texel_cover.h), serves all.
#pragma once

#include "photograd/render/path/path.h"

namespace photograd {

/// Adds the free part of each sample to sums (H, W).
template <Real R>
void trace_ambient_occlusion(const PathGeometry& scene, const Pinhole& camera, double radius,
                             std::uint64_t seed, const SampleRange& samples, double* sums);

/// Points of surfaces (N, 3) and the geometric normals of their fronts (N, 3), of unit length.
struct SurfacePoints {
    const double *positions, *normals;
    std::int64_t count;
};

/// Adds to sums (N,) how many of the samples over each point are free. Directions are Sobol' points
/// (sampling/sobol.h); point i has the random numbers of pixel i.
void add_point_occlusion(const PathGeometry& scene, const SurfacePoints& points, double radius,
                         std::uint64_t seed, const SampleRange& samples, double* sums);

}  // namespace photograd
