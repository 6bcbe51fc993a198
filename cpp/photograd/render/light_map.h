// Light tracing: the irradiance of a rectangle, by particles that land on it.
//
//   E of a cell = (1 / N) sum over flights through it of flux / area of the cell            N particles
//
// What a camera's path hardly finds, light that smooth surfaces gather to a bright patch (a caustic), particles find at
// once: they come from the lights and go where the light goes [Arvo1986].
#pragma once

#include "photograd/render/particle_walk.h"
#include "photograd/render/path.h"

namespace photograd {

/// A rectangle that counts what passes through its front, the side of edge_x x edge_y, and lets it go on. It may lie on
/// a surface. Seen from the front with edge_x to the right and edge_y up, row 0 is on top.
struct Receiver {
    Vec3<double> corner, edge_x, edge_y;  // perpendicular edges, m
    std::int64_t height, width;

    /// The cell that a straight way passes, and at which distance, or -1. What ends less than `hair` above the rectangle
    /// has reached it.
    [[nodiscard]] std::int64_t cell_of(const Ray<double>& ray, double length, double hair,
                                       double& at) const;
    [[nodiscard]] double cell_area() const;  // m^2
};

/// Particles `first` to `first + count - 1`.
struct ParticleRange {
    std::uint64_t first, count;
};

/// Adds to (H, W, 3) sums over particles of their irradiance, and of its square, W/m^2: E is the sum over the number of
/// particles. The same bits for any number of threads; calls may be cut between particles, but see PathSums.
void trace_light(const PathScene<double>& scene, const ParticleOptions& options,
                 const ParticleRange& particles, const Receiver& receiver, const PathSums& sums);

}  // namespace photograd
