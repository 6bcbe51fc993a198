#include "photograd/render/light/photon_map.h"

#include <bit>

#include "photograd/core/parallel.h"

namespace photograd {
namespace {

class PhotonVisitor : public FluxVisitor {
public:
    PhotonVisitor(double share, bool direct, std::vector<Photon>& photons)
        : share_(share), direct_(direct), photons_(photons) {}

    void hit(int k, std::uint32_t vertex, const SurfaceHit<double>& hit,
             const Vec3<double>& direction, const Material<double>& material,
             const Vec3<double>& beta) override {
        if (material.is_specular() || (vertex == 0 && !direct_)) return;
        const SurfaceSide<double> side(hit, -direction, false);
        photons_.push_back(
            {hit.position, -direction, side.normal, flux[k] * beta * share_, vertex == 0});
    }

private:
    double share_;
    bool direct_;
    std::vector<Photon>& photons_;
};

}  // namespace

PhotonMap::PhotonMap(const PathScene<double>& scene, const ParticleOptions& options,
                     std::uint64_t count, double radius, bool direct)
    : radius_(radius) {
    const std::uint64_t chunks = (count + chunk_particles - 1) / chunk_particles;
    const double share = 1 / static_cast<double>(count);
    std::vector<std::vector<Photon>> of_chunk(chunks);
    parallel_for(static_cast<std::int64_t>(chunks), [&](std::int64_t chunk) {
        std::vector<Photon>& own = of_chunk[static_cast<std::size_t>(chunk)];
        PhotonVisitor visitor(share, direct, own);
        const auto begin = static_cast<std::uint64_t>(chunk) * chunk_particles,
                   end = std::min(begin + chunk_particles, count);
        trace_particles(scene, options, {begin, end - begin}, visitor);
    });
    for (const std::vector<Photon>& own : of_chunk)
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
