// Pictures of the path tracer to read (render/reference/path_tracer.h), to compare with.
#pragma once

#include "photograd/render/path/path.h"

namespace photograd {

/// Adds samples to both sums, as trace_paths does. Independent random numbers; textures without mip
/// maps; one ray at a time.
void trace_reference(const PathScene<double>& scene, const ThinLens& camera,
                     const PathOptions& options, const SampleRange& samples, const PathSums& sums);

}  // namespace photograd
