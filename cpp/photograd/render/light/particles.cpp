#include "photograd/render/light/particles.h"

#include "photograd/render/path/camera_medium.h"
#include "photograd/render/path/tracer.h"

namespace photograd {
namespace {

RandomKey key_of(std::uint64_t seed, std::uint64_t number) {
    return {seed, dimensions::particle_step, static_cast<std::uint32_t>(number),
            static_cast<std::uint32_t>(number >> 32)};
}

/// Transmittance of a world medium up to the start of a particle from infinity.
Vec3<double> transmittance_from_infinity(const PathScene<double>& scene, const Particle& particle,
                                         const RandomKey& key) {
    const std::int32_t world = scene.geometry->media.world;
    if (world < 0) return Vec3<double>(1);
    Path<double> path;
    FreePathSampler<double>::State state;
    state.stream = RandomStream(key, dimensions::particle_start_step);
    state.product = path.start_product();
    FreePathSampler<double>(scene).add_transmittance(world, particle.origin, -particle.direction,
                                                     endless, state, path);
    return state.product.value;
}

template <bool Media>
void trace(const PathScene<double>& scene, const ParticleOptions& options,
           const ParticleRange& particles, FluxVisitor& visitor) {
    PathOptions as_path;
    as_path.max_depth = options.max_depth;
    as_path.roulette_from = options.roulette_from;
    as_path.seed = options.seed;
    PathTracer<double, Media, Transport::importance> tracer(scene, as_path, 0, true);
    PathStart<double> starts[trace_width];
    for (std::uint64_t done = 0; done < particles.count; done += trace_width) {
        const auto count =
            static_cast<int>(std::min<std::uint64_t>(trace_width, particles.count - done));
        for (int k = 0; k < count; ++k) {
            const std::uint64_t number = particles.first + done + static_cast<std::uint64_t>(k);
            const Particle one = emitted_particle(scene, options.seed, number);
            PathStart<double>& start = starts[k];
            start = {{one.origin, one.direction}, key_of(options.seed, number)};
            visitor.flux[k] = one.flux;
            if constexpr (Media) {
                if (one.far) visitor.flux[k] *= transmittance_from_infinity(scene, one, start.key);
            }
            start.exists = !is_black(visitor.flux[k]);
            if constexpr (Media)
                if (start.exists) start.stack = medium_stack_at(*scene.geometry, one.origin);
        }
        tracer.trace(starts, count, &visitor);
    }
}

}  // namespace

Particle emitted_particle(const PathScene<double>& scene, std::uint64_t seed,
                          std::uint64_t number) {
    const RandomKey key = key_of(seed, number);
    const Philox4 emitter_words = random_block(key, dimensions::particle_emitter_block),
                  direction_words = random_block(key, dimensions::particle_direction_block);
    return emit(scene, uniform_from<double>(emitter_words[dimensions::emitter]),
                {uniform_from<double>(emitter_words[dimensions::emitter_u]),
                 uniform_from<double>(emitter_words[dimensions::emitter_v])},
                {uniform_from<double>(direction_words[dimensions::direction_u]),
                 uniform_from<double>(direction_words[dimensions::direction_v])});
}

void trace_particles(const PathScene<double>& scene, const ParticleOptions& options,
                     const ParticleRange& particles, FluxVisitor& visitor) {
    (scene.geometry->media.any() ? trace<true> : trace<false>)(scene, options, particles, visitor);
}

}  // namespace photograd
