#include "photograd/render/light_map.h"

#include "photograd/core/parallel.h"
#include "photograd/render/volume_particles.h"

namespace photograd {
namespace {

constexpr std::uint64_t chunk_particles = 4096;  // of one task
constexpr std::int64_t slab_chunks = 32;         // whose landings are held at a time

struct Landing {
    std::int64_t cell;
    Vec3<double> flux;
};

/// walk(follow) calls follow(first, count) for all sixteens of particles of a task.
template <class Walk>
void land(const PathScene<double>& scene, const ParticleOptions& options, const Receiver& receiver,
          double hair, Walk&& walk, std::vector<Landing>& out) {
    ParticleWalk particles(scene, options);
    walk([&](std::uint64_t first, int count) {
        particles.follow(first, count, [&](const Flight& flight) {
            double at;
            const std::int64_t cell = receiver.cell_of(flight.ray, flight.length, hair, at);
            if (cell >= 0) out.push_back({cell, flight.flux});
        });
    });
}
template <class Walk>
void land_through_media(const PathScene<double>& scene, const ParticleOptions& options,
                        const Receiver& receiver, double hair, Walk&& walk,
                        std::vector<Landing>& out) {
    VolumeParticleWalk particles(scene, options);
    std::int64_t cell = -1;
    const auto gate = [&](const Ray<double>& ray, double length) {
        double at = -1;
        cell = receiver.cell_of(ray, length, hair, at);
        return cell >= 0 ? at : -1.0;
    };
    walk([&](std::uint64_t first, int count) {
        particles.follow(first, count, gate,
                         [&](const Vec3<double>& flux) { out.push_back({cell, flux}); });
    });
}

}  // namespace

double Receiver::cell_area() const {
    return length(cross(edge_x, edge_y)) / static_cast<double>(height * width);
}

std::int64_t Receiver::cell_of(const Ray<double>& ray, double length, double hair,
                               double& at) const {
    const Vec3<double> normal = normalize(cross(edge_x, edge_y));
    const double above = dot(ray.origin - corner, normal), falling = -dot(ray.direction, normal);
    if (!(above > 0) || !(falling > 0)) return -1;
    if (!(above - falling * length <= hair)) return -1;
    at = std::min(above / falling, length);
    const Vec3<double> p = ray.at(at) - corner;
    const double x = dot(p, edge_x) / dot(edge_x, edge_x), y = dot(p, edge_y) / dot(edge_y, edge_y);
    if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return -1;
    const auto column = static_cast<std::int64_t>(x * static_cast<double>(width)),
               from_below = static_cast<std::int64_t>(y * static_cast<double>(height));
    return (height - 1 - from_below) * width + column;
}

void trace_light(const PathScene<double>& scene, const ParticleOptions& options,
                 const ParticleRange& particles, const Receiver& receiver, const PathSums& sums) {
    const double hair = 2 * scene.geometry->offset, share = 1 / receiver.cell_area();
    const auto chunks =
        static_cast<std::int64_t>((particles.count + chunk_particles - 1) / chunk_particles);
    std::vector<std::vector<Landing>> landings(
        static_cast<std::size_t>(std::min(slab_chunks, chunks)));
    for (std::int64_t start = 0; start < chunks; start += slab_chunks) {
        const std::int64_t count = std::min(slab_chunks, chunks - start);
        parallel_for(count, [&](std::int64_t i) {
            std::vector<Landing>& own = landings[static_cast<std::size_t>(i)];
            own.clear();
            const auto begin = static_cast<std::uint64_t>(start + i) * chunk_particles,
                       end = std::min(begin + chunk_particles, particles.count);
            const auto walk = [&](auto&& follow) {
                for (std::uint64_t n = begin; n < end; n += walk_width)
                    follow(particles.first + n,
                           static_cast<int>(std::min<std::uint64_t>(walk_width, end - n)));
            };
            if (scene.geometry->media.any())
                land_through_media(scene, options, receiver, hair, walk, own);
            else
                land(scene, options, receiver, hair, walk, own);
        });
        // Chunk by chunk, in their order, by one thread: adding is little work beside tracing.
        for (std::int64_t i = 0; i < count; ++i)
            for (const Landing& landing : landings[static_cast<std::size_t>(i)])
                for (int c = 0; c < 3; ++c) {
                    const double E = landing.flux[c] * share;
                    sums.radiance[3 * landing.cell + c] += E;
                    sums.squares[3 * landing.cell + c] += E * E;
                }
    }
}

}  // namespace photograd
