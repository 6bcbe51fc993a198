// Photon mapping: particles from the emitters are stored where they hit surfaces, and their density
// estimates the reflected radiance [Jensen2001a].
//
//   L(x, b) = 1 / (pi r^2) sum over photons within r of x of f(b, a_p) flux_p |a_p n| / |a_p m|
//
// a_p is where photon p came from; n and m are the shading and the geometric normal, as in
// render/path/scatter.h. The density is that of a disk of radius r, so the estimate is biased by
// what a blur of that size changes, r^2 times the curvature of the irradiance, however many photons
// there are, and noisy with few. Photons of surfaces that face elsewhere do not count; at edges of
// surfaces a part of the disk lies beside them, and they are too dark.
//
// A photon is stored on every surface that is not specular. A camera path goes through specular
// surfaces, and through media, to the first surface that is not, where all its light is read from
// the map, direct light as well. Light that media scatter is path traced, by next event estimation
// at scattering events.
#pragma once

#include <array>

#include "photograd/core/scatter.h"
#include "photograd/render/light/particles.h"
#include "photograd/render/path/path.h"

namespace photograd {

struct Photon {
    Vec3<double> position, back, normal, flux;  // m; unit, to where it came from; geometric; W
    bool direct;                                // straight from a light
};

/// With a fixed radius, what lies within r is in one of eight cells of edge 2 r around. Cells are
/// hashed to rows of photons [Teschner2003].
class PhotonMap {
public:
    /// Traces particles 0 to count - 1. Without `direct` only scattered particles are stored.
    PhotonMap(const PathScene<double>& scene, const ParticleOptions& options, std::uint64_t count,
              double radius, bool direct);

    /// visit(photon) for those within the radius, in a fixed order.
    template <class Visit>
    void for_each_near(const Vec3<double>& point, Visit&& visit) const {
        const Cell low = cell_of(point - Vec3<double>(radius_));
        for (int corner = 0; corner < 8; ++corner) {
            const Cell cell{low[0] + (corner & 1), low[1] + (corner >> 1 & 1),
                            low[2] + (corner >> 2)};
            const std::size_t row = row_of(cell);
            for (std::uint32_t i = rows_.begin[row]; i < rows_.begin[row + 1]; ++i) {
                const Photon& photon = photons_[rows_.order[i]];
                const Vec3<double> apart = photon.position - point;
                if (dot(apart, apart) <= radius_ * radius_ && cell_of(photon.position) == cell)
                    visit(photon);
            }
        }
    }
    /// Irradiance of what lies at `point` with this normal, W/m^2.
    [[nodiscard]] Vec3<double> irradiance(const Vec3<double>& point,
                                          const Vec3<double>& normal) const;
    [[nodiscard]] std::span<const Photon> photons() const { return photons_; }
    /// One photon's share of an estimate: 1 / (pi r^2), 1/m^2.
    [[nodiscard]] double density() const;

private:
    using Cell = std::array<std::int64_t, 3>;
    [[nodiscard]] Cell cell_of(const Vec3<double>& point) const;
    [[nodiscard]] std::size_t row_of(const Cell& cell) const;

    double radius_;
    std::vector<Photon> photons_;
    std::uint32_t row_count_ = 1;
    OwnerBins rows_;
};

/// Whether a photon counts for a surface with this geometric normal.
inline bool lies_on(const Photon& photon, const Vec3<double>& normal) {
    return dot(photon.normal, normal) > 0.5 && dot(photon.back, normal) > 0;
}

/// Adds samples of a picture to sums (H, W, 3), as trace_paths does.
void trace_photons(const PathScene<double>& scene, const PhotonMap& map, const ThinLens& camera,
                   const PathOptions& options, const SampleRange& samples, const PathSums& sums);

}  // namespace photograd
