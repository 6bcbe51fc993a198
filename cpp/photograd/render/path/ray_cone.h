// Ray cones [AkenineMoeller2021]: the footprint of a path on a surface, for mip map lookups.
//
// A cone has a width where it starts and a spread, by which that grows per meter; both as a whole,
// not from the axis:
//
//   w(t) = |w_0 + s t|         from the camera: w_0 = 0, s = 1 / focal length in pixels
//
// A surface with normal n cuts it in an ellipse, w / |n.d| wide along the direction d and w across.
// In texture coordinates, which change by b and c along two edges of the triangle, these are the
// sides of a Footprint.
//
// After a bounce the cone starts as wide as it has become, and its spread changes with the
// curvature k of the surface (1/m; above 0 where it bulges outwards), over which the normal turns
// by k w / |n.d|:
//
//   reflection     s + 2 k w / |n.d|          from within: -
//   refraction     s - k w / (2 |n.d|)        glass of eta 1.5 turns by a third to a half of that
//   density p      max(|that|, sqrt(4 / (pi m p)))          a cone of the solid angle 1 / (m p)
//
// A direction sampled with density p stands for the solid angle 1 / (m p): m = 64 samples a pixel
// are assumed. A spread may be below 0: the cone narrows first. Cones are held constant in
// derivatives.
//
// The texture is averaged, not the reflectance computed from it, over a square as wide as the
// longer diameter: a bias that more samples do not remove.
#pragma once

#include <cmath>

#include "photograd/scene/path_scene.h"

namespace photograd {

/// Curvature of a mesh with shading normals, the mean over the edges of a triangle of how fast the
/// normal turns along them; of a sphere, 1 / radius. Above 0 where it bulges to the side of
/// `outside`. A signed distance field counts as flat.
template <class R>
R curvature(const PathGeometry& scene, const SurfaceHit<R>& hit, double time = 0) {
    const Bvh& bvh = scene.bvh;
    if (hit.shape >= bvh.first_solid()) return R(0);
    if (hit.shape >= bvh.sphere_instance())
        return R(1) / R(bvh.spheres()[static_cast<std::size_t>(hit.primitive)].radius);
    const Instance& instance = bvh.instances()[static_cast<std::size_t>(hit.shape)];
    const std::vector<float>& normals = scene.normals[static_cast<std::size_t>(instance.mesh)];
    if (normals.empty()) return R(0);
    const std::uint32_t* corner =
        bvh.mesh_of(hit.shape).corners(static_cast<std::uint32_t>(hit.primitive));
    Vec3<R> p[3], n[3];
    bvh.corners(hit.shape, hit.primitive, p, time);
    const Affine world_from_object = instance.at(time);
    for (int k = 0; k < 3; ++k) {
        const float* row = normals.data() + 3 * static_cast<std::size_t>(corner[k]);
        n[k] = Vec3<R>(R(row[0]), R(row[1]), R(row[2]));
        if (instance.is_placed) n[k] = world_normal(world_from_object, n[k]);
        const R size = length(n[k]);
        if (!(size > R(0))) return R(0);
        n[k] *= (dot(n[k], hit.outside) < R(0) ? R(-1) : R(1)) / size;
    }
    R sum = R(0);
    for (int k = 0; k < 3; ++k) {
        const Vec3<R> edge = p[(k + 1) % 3] - p[k];
        sum += dot(n[(k + 1) % 3] - n[k], edge) / dot(edge, edge);
    }
    return sum / R(3);
}

template <class R>
struct RayCone {
    R width = R(0), spread = R(0);

    [[nodiscard]] R width_at(R t) const { return std::abs(width + spread * t); }

    /// Footprint on a mesh with texture coordinates after `t` meters along `direction`, at a
    /// time from 0 to 1.
    [[nodiscard]] Footprint<R> footprint(const Bvh& bvh, const SurfaceHit<R>& hit,
                                         const Vec3<R>& direction, R t, double time = 0) const {
        Vec3<R> p[3];
        bvh.corners(hit.shape, hit.primitive, p, time);
        const Vec3<R> e1 = p[1] - p[0], e2 = p[2] - p[0], n = cross(e1, e2);
        const Vec2<R> a = bvh.texture_point(hit.shape, hit.primitive, R(0), R(0)),
                      b = bvh.texture_point(hit.shape, hit.primitive, R(1), R(0)) - a,
                      c = bvh.texture_point(hit.shape, hit.primitive, R(0), R(1)) - a;
        const auto in_texture = [&](const Vec3<R>& step) {
            return (b * dot(cross(step, e2), n) + c * dot(cross(e1, step), n)) * (R(1) / dot(n, n));
        };
        const R cosine = dot(hit.outside, direction), w = width_at(t);
        Vec3<R> along = direction - hit.outside * cosine;
        const R sine = length(along);
        along = sine > R(1e-3) ? along * (R(1) / sine) : normalize(e1);
        return {in_texture(along * (w / slant(cosine))), in_texture(cross(hit.outside, along) * w)};
    }

    /// The cone after the surface, along `onward`; `pdf` is its density over solid angle, 0 for a
    /// specular bounce.
    [[nodiscard]] RayCone onward(const PathGeometry& scene, const SurfaceHit<R>& hit,
                                 const Vec3<R>& direction, const Vec3<R>& onward, R t, R pdf,
                                 double time = 0) const {
        const R cosine = dot(hit.outside, direction), now = width + spread * t;
        const R turn = curvature(scene, hit, time) * std::abs(now) / slant(cosine);
        const bool reflected = cosine * dot(hit.outside, onward) < R(0);
        const R gain = reflected ? (cosine < R(0) ? R(2) : R(-2)) : R(-0.5);
        // Behind a focus the cone is counted from its other side.
        const R grown = (now < R(0) ? -spread : spread) + gain * turn;
        return {std::abs(now), pdf > R(0) ? std::max(std::abs(grown), spread_of(pdf)) : grown};
    }
    /// The cone after scattering in a medium: no curvature, a spread by the density alone.
    [[nodiscard]] RayCone scattered(R t, R pdf) const {
        return {width_at(t), std::max(std::abs(spread), spread_of(pdf))};
    }

private:
    static constexpr double directions = 64;  // m

    static R slant(R cosine) { return std::max(std::abs(cosine), R(1e-3)); }
    static R spread_of(R pdf) { return std::sqrt(R(4 / (pi * directions)) / pdf); }
};

}  // namespace photograd
