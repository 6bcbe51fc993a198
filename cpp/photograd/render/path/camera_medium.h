// The shapes in which the rays of a camera start: those around the center of its lens.
#pragma once

#include "photograd/camera/thin_lens.h"
#include "photograd/core/random.h"
#include "photograd/render/path/sampler.h"
#include "photograd/scene/path_scene.h"

namespace photograd {

/// The shapes with an interior around a point, at a time from 0 to 1: those that a ray to the
/// outside leaves once more than it enters them.
MediumStack medium_stack_at(const PathGeometry& geometry, const Vec3<double>& point,
                            float time = 0);

/// Of every sample. Where the camera crosses a surface while its shutter is open, or a surface may
/// move past the camera, each moment is looked up anew.
class CameraMedium {
public:
    /// `media`: whether the scene has any; without, all stacks are empty.
    CameraMedium(const PathGeometry& geometry, const ThinLens& camera, Sampler sampler, bool media);

    MediumStack of(const RandomKey& key);

private:
    const PathGeometry& geometry_;
    const ThinLens& camera_;
    PathSampler sampler_;
    bool changes_;
    MediumStack opening_;
};

}  // namespace photograd
