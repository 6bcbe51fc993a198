// Directions sampled towards the bright parts of an environment map.
//
// Between texel centers the map is cut into cells: bands between the heights of neighboring rows
// of centers, each as long as the map is wide, and two half bands at the poles. The density over
// solid angle is
//
//   pdf(w) = b(x, s) / integral of b over the sphere
//
// with b bilinear between the brightnesses of a cell's corners, x along the row and s = the part of
// the cell's solid angle above w (on a sphere, equal heights are equal areas: s is linear in w.y).
// The map itself is bilinear in the angle instead of the height. Both agree at the corners and are
// zero in the same places, so their ratio stays bounded: between 2/3 and 2 at the poles, close to 1
// elsewhere, exactly 1 for a map of one color. Nothing is divided by the sine of theta.
#pragma once

#include <span>
#include <vector>

#include "photograd/core/real.h"
#include "photograd/light/lat_long.h"
#include "photograd/sampling/bilinear_patch.h"
#include "photograd/sampling/distribution_2d.h"

namespace photograd {

/// A direction in the frame of the map, its column and its density over solid angle.
struct SampledDirection {
    Vec3<double> w;
    double u, pdf;
};

class EnvironmentSampler {
public:
    /// Texels (H, 2 H, 3). `uniform_share` of the samples go everywhere alike: with 0, directions
    /// that are black now are never sampled, and if the texels change later, nothing would be known
    /// of them. A map without any light is sampled uniformly. Refuses (RangeError) texels that are
    /// negative or not finite, and a share outside of [0, 1].
    template <Real R>
    EnvironmentSampler(std::span<const R> texels, int height, double uniform_share);

    [[nodiscard]] SampledDirection sample(const Vec2<double>& u2) const;
    /// The density over solid angle of a direction at this place.
    [[nodiscard]] double pdf(const LatLong& map_point) const;
    [[nodiscard]] int height() const { return height_; }
    /// The map's luminance, integrated over the sphere, W/m^2.
    [[nodiscard]] double flux() const { return flux_; }

private:
    [[nodiscard]] BilinearPatch<double> corners(std::int64_t band, std::int64_t column) const;

    int height_;
    std::vector<float> brightness_;  // (H, 2 H)
    std::vector<double> drop_;  // (H + 2): 1 - height of the bands' edges, from the zenith down
    Distribution2D cells_;      // (H + 1, 2 H), by brightness times solid angle
    double flux_;
    double density_scale_;  // 1 / integral of the brightness over the sphere
};

}  // namespace photograd
