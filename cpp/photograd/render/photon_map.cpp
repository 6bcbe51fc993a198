#include "photograd/render/photon_map.h"

#include <bit>

#include "photograd/core/parallel.h"

namespace photograd {
namespace {

constexpr std::uint64_t chunk_particles = 4096;

}  // namespace

PhotonMap::PhotonMap(const PathScene<double>& scene, const ParticleOptions& options,
                     std::uint64_t count, double radius, bool direct)
    : radius_(radius) {
    const std::uint64_t chunks = (count + chunk_particles - 1) / chunk_particles;
    const double share = 1 / static_cast<double>(count);
    std::vector<std::vector<Photon>> kept(chunks);
    parallel_for(static_cast<std::int64_t>(chunks), [&](std::int64_t chunk) {
        std::vector<Photon>& own = kept[static_cast<std::size_t>(chunk)];
        ParticleWalk walk(scene, options);
        const auto begin = static_cast<std::uint64_t>(chunk) * chunk_particles,
                   end = std::min(begin + chunk_particles, count);
        for (std::uint64_t n = begin; n < end; n += walk_width)
            walk.follow(n, static_cast<int>(std::min<std::uint64_t>(walk_width, end - n)),
                        [&](const Flight& flight) {
                            if (!flight.hit || flight.material->is_specular()) return;
                            const bool first = flight.depth == 0;
                            if (first && !direct) return;
                            const Vec3<double> back = -flight.ray.direction;
                            const SurfaceSide<double> side(*flight.hit, back, false);
                            own.push_back({flight.hit->position, back, side.normal,
                                           flight.flux * share, first});
                        });
    });
    for (const std::vector<Photon>& own : kept)
        photons_.insert(photons_.end(), own.begin(), own.end());
    // About one row a photon; several cells may share one.
    row_count_ = static_cast<std::uint32_t>(
        std::bit_ceil(std::clamp<std::size_t>(photons_.size(), 1, std::size_t(1) << 22)));
    std::vector<std::uint32_t> owner;
    owner.reserve(photons_.size());
    for (const Photon& photon : photons_)
        owner.push_back(static_cast<std::uint32_t>(row_of(cell_of(photon.position))));
    bin_by_owner(std::span<const std::uint32_t>(owner), static_cast<int>(row_count_), rows_);
}

PhotonMap::Cell PhotonMap::cell_of(const Vec3<double>& point) const {
    Cell cell;
    for (int k = 0; k < 3; ++k)
        cell[static_cast<std::size_t>(k)] =
            static_cast<std::int64_t>(std::floor(point[k] / (2 * radius_)));
    return cell;
}

std::size_t PhotonMap::row_of(const Cell& cell) const {
    const auto part = [](std::int64_t x, std::uint64_t prime) {
        return static_cast<std::uint64_t>(x) * prime;
    };
    const std::uint64_t mixed =
        part(cell[0], 73856093) ^ part(cell[1], 19349663) ^ part(cell[2], 83492791);
    return static_cast<std::size_t>(mixed & (row_count_ - 1));
}

double PhotonMap::density() const { return 1 / (pi * radius_ * radius_); }

Vec3<double> PhotonMap::irradiance(const Vec3<double>& point, const Vec3<double>& normal) const {
    Vec3<double> sum(0);
    for_each_near(point, [&](const Photon& photon) {
        if (lies_on(photon, normal)) sum += photon.flux;
    });
    return sum * density();
}

}  // namespace photograd
