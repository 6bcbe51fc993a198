// Ambient occlusion: how much of the sky over a surface is free, weighted with the cosine [Zhukov1998].
//
//   1 - A = (1 / pi) integral over the hemisphere of V(w) cos(w) dw
//
// where V is 0 if something stands within `radius` along w. Directions are drawn in proportion to the cosine, so
// each sample is V itself. Rays of the camera that meet nothing count as free.
#pragma once

#include "photograd/render/path.h"

namespace photograd {

/// Adds the free part of each sample to sums (H, W).
template <Real R>
void trace_ambient_occlusion(const PathGeometry& scene, const Pinhole& camera, double radius,
                             std::uint64_t seed, const SampleRange& samples, double* sums);

}  // namespace photograd
