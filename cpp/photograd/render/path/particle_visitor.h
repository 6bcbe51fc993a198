// The interface through which sensors and photon maps (render/light/) record particles.
#pragma once

#include "photograd/scene/path_scene.h"

namespace photograd {

/// Counts particles on their way. `k`: which of the sixteen; `beta`: its throughput there.
class ParticleVisitor {
public:
    virtual ~ParticleVisitor() = default;
    /// At which distance a straight way of this length passes a sensor, or below 0.
    virtual double intersect(const Ray<double>&, double) { return -1; }
    virtual void splat(int /*k*/, const Vec3<double>& /*beta*/) {}
    /// A particle hits a surface; `vertex`: its number on the path.
    virtual void hit(int /*k*/, std::uint32_t /*vertex*/, const SurfaceHit<double>&,
                     const Vec3<double>& /*direction*/, const Material<double>&,
                     const Vec3<double>& /*beta*/) {}
};

}  // namespace photograd
