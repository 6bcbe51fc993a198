// Light tracing: the irradiance on a rectangle, from the particles that cross it.
//
//   E of a cell = (1 / N) sum over particles through it of flux / area of the cell    N particles
//
// Camera paths hardly ever sample light that specular surfaces focus (caustics); particles, which
// start at the emitters, sample it in proportion to its power [Arvo1986].
#pragma once

#include "photograd/render/light/particles.h"
#include "photograd/render/path/path.h"

namespace photograd {

/// A rectangle that records particles through its front, the side of edge_x x edge_y, and does not
/// stop them. It may lie on a surface. Seen from the front with edge_x to the right and edge_y up,
/// row 0 is on top.
struct IrradianceSensor {
    Vec3<double> corner, edge_x, edge_y;  // perpendicular edges, m
    std::int64_t height, width;

    /// The cell that a segment crosses, with the distance `t` to it, or -1. A segment that ends
    /// less than `epsilon` above the rectangle counts as crossing.
    [[nodiscard]] std::int64_t intersect(const Ray<double>& ray, double length, double epsilon,
                                         double& t) const;
    [[nodiscard]] double cell_area() const;  // m^2
};

/// Adds to (H, W, 3) sums over particles of their irradiance, and of its square, W/m^2: E is the
/// sum over the number of particles. The same bits for any number of threads; calls may be cut
/// between particles, but see PathSums.
void trace_irradiance(const PathScene<double>& scene, const ParticleOptions& options,
                      const ParticleRange& particles, const IrradianceSensor& sensor,
                      const PathSums& sums);

}  // namespace photograd
