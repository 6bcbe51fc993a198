// Particle tracing: light transport from the emitters, by a PathTracer of importance. Sensors and
// photon maps record the particles.
#pragma once

#include <functional>

#include "photograd/render/path/options.h"
#include "photograd/render/path/particle_visitor.h"
#include "photograd/scene/emit.h"

namespace photograd {

struct ParticleOptions {
    int max_depth = 64;     // segments of the longest way; 1: straight from the emitters
    int roulette_from = 4;  // the first surface with Russian roulette
    std::uint64_t seed = 0;
};

/// Particles `first` to `first + count - 1`.
struct ParticleRange {
    std::uint64_t first, count;
};

inline constexpr std::uint64_t chunk_particles = 4096;  // of one task

/// Particle `number` as it leaves its emitter.
Particle emitted_particle(const PathScene<double>& scene, std::uint64_t seed, std::uint64_t number);

/// Records particles; `flux` is the power in W with which particle k of the current sixteen leaves
/// its emitter.
class FluxVisitor : public ParticleVisitor {
public:
    Vec3<double> flux[16];
};

/// Follows particles, sixteen side by side, in a fixed order.
void trace_particles(const PathScene<double>& scene, const ParticleOptions& options,
                     const ParticleRange& particles, FluxVisitor& visitor);

}  // namespace photograd
