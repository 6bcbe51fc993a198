// An environment map: radiance by direction, as a latitude-longitude image (lat_long.h).
//
//   L(w) = sum over the four texels around w of weight * texel
//       weights bilinear, columns going around
//   dL/dtexel = weight
//
// world_from_map rotates directions of the map to those of the world. A rotation moves the edges of
// all texels through the scene; no derivative with respect to it is given.
#pragma once

#include "photograd/light/environment_sampler.h"
#include "photograd/light/lat_long.h"
#include "photograd/light/light.h"

namespace photograd {

/// Texels (H, 2 H, 3) that a direction sees, as numbers row * 2 H + column, and their weights.
template <class R>
struct EnvironmentTaps {
    std::int64_t texel[4];
    R weight[4];
};

template <class R>
EnvironmentTaps<R> environment_taps(double u, double v, int height) {
    const TexelPair column = columns_at(u, 2 * height), row = rows_at(v, height);
    const double f = column.fraction, g = row.fraction;
    const auto texel = [&](int r, int c) { return static_cast<std::int64_t>(r) * 2 * height + c; };
    return {{texel(row.first, column.first), texel(row.first, column.second),
             texel(row.second, column.first), texel(row.second, column.second)},
            {R((1 - g) * (1 - f)), R((1 - g) * f), R(g * (1 - f)), R(g * f)}};
}

/// A view: texels and sampler belong to the caller. The sampler may have been built from other
/// texels, as while a picture is being recovered: its density is its own, and the estimate stays
/// right wherever it is not zero.
template <class R>
struct Environment {
    const R* texels;
    int height;
    Mat3<R> world_from_map;
    const EnvironmentSampler* sampler;

    static constexpr const char* name = "environment";
    static constexpr LightKind kind = LightKind::environment;

    [[nodiscard]] EnvironmentTaps<R> taps(const Vec3<R>& w) const {
        const Vec2<double> uv = lat_long_from_direction(map_from_world(w));
        return environment_taps<R>(uv.x, uv.y, height);
    }
    Vec3<R> L(const Vec3<R>& w) const { return look_up(taps(w)); }
    /// Adds to d_texels (H, 2 H, 3). Threads that share them scatter by owner instead, from `taps`
    /// (environment_gradient.h).
    void L_backward(const Vec3<R>& w, const Vec3<R>& d_L, R* d_texels) const {
        const EnvironmentTaps<R> at = taps(w);
        for (int k = 0; k < 4; ++k)
            for (int c = 0; c < 3; ++c) d_texels[3 * at.texel[k] + c] += at.weight[k] * d_L[c];
    }

    Vec3<R> sample(const Vec2<R>& u2) const {
        return world_from_map * Vec3<R>(sampler->sample({double(u2.x), double(u2.y)}).w);
    }
    R pdf(const Vec3<R>& w) const { return R(sampler->pdf(lat_long_of(map_from_world(w)))); }

    /// `sample` with its radiance and density: its place in the map is known, but for the angle to
    /// the zenith.
    [[nodiscard]] LightSample<R> sample_with_radiance(const Vec2<R>& u2) const {
        const SampledDirection sampled = sampler->sample({double(u2.x), double(u2.y)});
        const Vec3<double>& w = sampled.w;
        const double v = polar_angle(sqrt(w.x * w.x + w.z * w.z), w.y) / pi;
        return {world_from_map * Vec3<R>(w), infinitely_far<R>(),
                look_up(environment_taps<R>(sampled.u, v, height)), R(sampled.pdf), false};
    }
    /// L and pdf of a direction by one lookup of its place.
    [[nodiscard]] Background<R> L_and_pdf(const Vec3<R>& w) const {
        const LatLong map_point = lat_long_of(map_from_world(w));
        return {look_up(environment_taps<R>(map_point.u, map_point.v, height)),
                R(sampler->pdf(map_point))};
    }

private:
    [[nodiscard]] Vec3<R> look_up(const EnvironmentTaps<R>& at) const {
        Vec3<R> radiance(R(0));
        for (int k = 0; k < 4; ++k)
            for (int c = 0; c < 3; ++c) radiance[c] += at.weight[k] * texels[3 * at.texel[k] + c];
        return radiance;
    }
    [[nodiscard]] Vec3<double> map_from_world(const Vec3<R>& w) const {
        return {double(dot(world_from_map[0], w)), double(dot(world_from_map[1], w)),
                double(dot(world_from_map[2], w))};
    }
};

}  // namespace photograd
