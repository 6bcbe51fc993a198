// In which shapes the rays of a camera start: in those around the centre of its lens.
#pragma once

#include "photograd/camera/thin_lens.h"
#include "photograd/core/random.h"
#include "photograd/render/sample_numbers.h"
#include "photograd/scene/path_scene.h"

namespace photograd {

/// The shapes with an interior around a point, at a time from 0 to 1: those that a ray to the outside
/// leaves once more than it enters them.
Surroundings surroundings_of(const PathGeometry& geometry, const Vec3<double>& point,
                             float time = 0);

/// The same for every sample of a picture. Where the camera moves past a surface while its shutter is
/// open, or a surface may move past the camera, each sample has a time of its own.
class CameraSurroundings {
public:
    CameraSurroundings(const PathGeometry& geometry, const ThinLens& camera, Sampler sampler);

    Surroundings of(const RandomKey& key);

private:
    const PathGeometry& geometry_;
    const ThinLens& camera_;
    SampleNumbers numbers_;
    bool changes_;
    Surroundings opening_;
};

}  // namespace photograd
