// The scene of a path tracer: shapes with a material each, shapes that emit, and lights without a
// shape.
//
// A shape is a mesh instance, a sphere or a signed distance field, numbered in that order. Geometry
// is built once; materials, emission and radiance of lights are numbers that may change between
// renderings.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "photograd/core/frame.h"
#include "photograd/medium/medium.h"
#include "photograd/scene/material.h"
#include "photograd/scene/medium_stack.h"
#include "photograd/scene/normal_map.h"
#include "photograd/scene/scene_lights.h"
#include "photograd/scene/textured.h"

namespace photograd {

struct PathGeometry {
    Bvh bvh;
    std::vector<std::int32_t> material;       // of each shape
    std::vector<std::vector<float>> normals;  // of each mesh: (V, 3) shading normals, or none
    SceneLights lights;
    SurfaceTextures textures;
    MediaGeometry media;
    double offset;  // by which rays start away from a surface, meters

    PathGeometry(Bvh hierarchy, std::vector<std::int32_t> materials,
                 std::vector<std::vector<float>> shading, std::span<const double> emission,
                 std::span<const AnyLight<double>> infinite_and_delta)
        : bvh(std::move(hierarchy)),
          material(std::move(materials)),
          normals(std::move(shading)),
          lights(bvh, emission, infinite_and_delta) {
        // The tracer calculates in float: its error is a few 6e-8 of the largest coordinate.
        double largest = 0;
        for (int k = 0; k < 3; ++k)
            largest = std::max({largest, std::abs(double(bvh.bounds().lo[k])),
                                std::abs(double(bvh.bounds().hi[k]))});
        offset = 1e-5 * largest;
    }
    [[nodiscard]] std::size_t shape_count() const { return material.size(); }
};

/// `sampling` is what is sampled, `materials` what is evaluated. They differ only in proofs: finite
/// differences of `materials` alone are those of the detached estimate, which `radiance_backward`
/// differentiates.
template <Real R>
struct PathScene {
    const PathGeometry* geometry;
    std::span<const Material<R>> materials, sampling;
    const R* emission;                                            // (S, 3)
    std::span<const AnyLight<R>> lights;                          // of the list
    std::span<const R* const> texels = {}, sampling_texels = {};  // (H, W, C) of each texture
    std::span<const Medium<R>> media = {}, sampling_media = {};

    [[nodiscard]] Vec3<R> emitted(std::int32_t shape) const {
        const R* L = emission + 3 * static_cast<std::size_t>(shape);
        return {L[0], L[1], L[2]};
    }
    /// Emitted radiance at the texture coordinates `uv`, times the emission texture if there is
    /// one.
    [[nodiscard]] Vec3<R> emitted(std::int32_t shape, const Vec2<R>& uv) const {
        const EmissionUse* use =
            geometry->textures.emission_texture(static_cast<std::size_t>(shape));
        return use ? emitted(shape) * emission_factor(*use, uv) : emitted(shape);
    }
    [[nodiscard]] Vec3<R> emission_factor(const EmissionUse& use, const Vec2<R>& uv) const {
        const TextureLayout& layout =
            geometry->textures.layouts[static_cast<std::size_t>(use.texture)];
        R color[max_channels];
        layout.look_up(texels[static_cast<std::size_t>(use.texture)], layout.inside(uv), color);
        return {color[use.channel], color[use.channel + 1], color[use.channel + 2]};
    }
    /// All lights at infinity: radiance, and density of emitter sampling in this direction. `found`
    /// is what is already known of the light `known`.
    [[nodiscard]] Background<R> behind(const Vec3<R>& direction, std::int64_t known = -1,
                                       const Background<R>& found = {}) const {
        Background<R> sum;
        for (const std::int32_t i : geometry->lights.at_infinity()) {
            const Background<R> one =
                i == known ? found : background(lights[static_cast<std::size_t>(i)], direction);
            sum.radiance += one.radiance;
            sum.pdf += R(geometry->lights.pmf(i)) * one.pdf;
        }
        return sum;
    }
    [[nodiscard]] bool sampling_is_attached() const {
        return materials.data() == sampling.data() && texels.data() == sampling_texels.data() &&
               media.data() == sampling_media.data();
    }
};

/// Where a ray hits a shape. `outside` is the unit normal of the triangle's winding, or out of the
/// solid; `shading` is the interpolated one, on the same side.
template <class R>
struct SurfaceHit {
    std::int32_t shape = SceneLights::none, primitive = -1;
    Vec3<R> position{R(0)}, outside{R(0)}, shading{R(0)};
    Vec2<R> uv{R(0)};
    Vec3<R> along{R(0)};  // growing u, where the material has a direction; or 0
};

/// A normal of an instance in the world, not of unit length: by the cofactors of the matrix, which
/// are its inverse's transpose times a determinant that is positive here.
template <class R>
Vec3<R> world_normal(const Affine& world_from_object, const Vec3<R>& n) {
    const auto& m = world_from_object.m;
    const auto row = [&](std::size_t i) {
        return Vec3<R>(R(m[4 * i]), R(m[4 * i + 1]), R(m[4 * i + 2]));
    };
    const Vec3<R> a = row(0), b = row(1), c = row(2);
    return {dot(cross(b, c), n), dot(cross(c, a), n), dot(cross(a, b), n)};
}

/// The interpolated normal of a mesh that has normals, on the side of the geometric one.
template <class R>
void shade(const PathGeometry& scene, std::int32_t instance, std::int32_t primitive,
           const TrianglePoint<R>& p, double time, SurfaceHit<R>& hit) {
    const Instance& placed = scene.bvh.instances()[static_cast<std::size_t>(instance)];
    const std::vector<float>& normals = scene.normals[static_cast<std::size_t>(placed.mesh)];
    if (normals.empty()) return;
    const std::uint32_t* corner =
        scene.bvh.mesh_of(instance).corners(static_cast<std::uint32_t>(primitive));
    const R weight[3] = {R(1) - p.u - p.v, p.u, p.v};
    Vec3<R> sum(R(0));
    for (int k = 0; k < 3; ++k) {
        const float* n = normals.data() + 3 * static_cast<std::size_t>(corner[k]);
        sum += weight[k] * Vec3<R>(R(n[0]), R(n[1]), R(n[2]));
    }
    if (!(length(sum) > R(1e-3))) return;  // normals that cancel
    if (placed.moves)
        sum = world_normal(placed.at(time), sum);
    else if (placed.is_placed)
        sum = world_normal(placed.world_from_object, sum);
    const R size = length(sum);
    if (!(size > R(0))) return;
    hit.shading = sum * ((dot(sum, p.normal) < R(0) ? R(-1) : R(1)) / size);
}

/// Texture coordinates of a point of an emissive primitive if its emission has a texture; else 0.
template <class R>
Vec2<R> emissive_uv(const PathGeometry& scene, const EmissivePrimitive& emitter,
                    const Vec3<R>& position) {
    const Bvh& bvh = scene.bvh;
    const bool textured = scene.textures.emission_texture(static_cast<std::size_t>(emitter.shape));
    if (!textured || emitter.shape >= bvh.sphere_instance()) return Vec2<R>(R(0));
    R u = R(0), v = R(0);
    const std::int32_t last = emitter.rectangle >= 0 ? 1 : emitter.primitive;
    std::int32_t face = emitter.primitive;
    for (;; ++face) {
        Vec3<R> p[3];
        bvh.corners(emitter.shape, face, p);
        const Vec3<R> a = p[1] - p[0], b = p[2] - p[0], q = position - p[0], n = cross(a, b);
        u = dot(cross(q, b), n) / dot(n, n);
        v = dot(cross(a, q), n) / dot(n, n);
        const R lowest = std::min({u, v, R(1) - u - v});
        if (face == last || !(lowest < R(-1e-5))) break;  // of a rectangle, the half that it is in
    }
    return bvh.texture_point(emitter.shape, face, u, v);
}

/// `time` of the ray, from 0 to 1 while the shutter is open.
template <class R>
SurfaceHit<R> surface_hit(const PathGeometry& scene, const Ray<R>& ray, std::int32_t instance,
                          std::int32_t primitive, float found_t, float time = 0) {
    if (instance == scene.bvh.sphere_instance()) {
        const Sphere sphere = scene.bvh.sphere(primitive, time);
        const SpherePoint<R> p = sphere_point(ray, sphere, R(found_t));
        return {instance + primitive, primitive, p.position, p.normal, p.normal};
    }
    if (instance == scene.bvh.solid_instance()) {
        const SdfSolid& solid = scene.bvh.solids()[static_cast<std::size_t>(primitive)];
        const SdfPoint p =
            solid.point({Vec3<double>(ray.origin), Vec3<double>(ray.direction)}, double(found_t));
        const Vec3<R> normal(p.normal);
        return {scene.bvh.first_solid() + primitive, primitive, Vec3<R>(p.position), normal,
                normal};
    }
    const TrianglePoint<R> p = scene.bvh.surface_point(ray, instance, primitive, double(time));
    SurfaceHit<R> hit{instance, primitive, p.position,
                      p.normal, p.normal,  scene.bvh.texture_point(instance, primitive, p.u, p.v)};
    shade(scene, instance, primitive, p, double(time), hit);
    const auto material =
        static_cast<std::size_t>(scene.material[static_cast<std::size_t>(instance)]);
    if (const NormalMap* map = scene.textures.bends(material))
        bend_normal(scene.bvh, *map, instance, primitive, hit.uv, hit.outside, hit.shading,
                    double(time));
    if (scene.textures.is_directed(material) && scene.bvh.mesh_of(instance).has_uv())
        hit.along = TextureAxes<R>::of(scene.bvh, instance, primitive, double(time)).u;
    return hit;
}

/// The side of a surface that a path sees: shading frame, and the geometric normal, by which
/// directions that cross the surface are rejected [Veach1997, Sec. 5.3].
///
/// Opaque surfaces are turned towards the viewer. Interpolated or bent normals disagree with the
/// surface near its silhouette: a viewer in front of it may be behind the shading normal, and a
/// direction above one of them below the other. The first case falls back to the geometric normal
/// (no black seams); a direction of the second kind is refused by `agrees` (no light through closed
/// surfaces). What remains is f cos over a part of the hemisphere of one unit normal, so that no
/// more light leaves than the model returns.
template <class R>
struct SurfaceSide {
    Vec3<R> normal;  // geometric
    Frame<R> frame;
    Vec3<R> wo;  // in the frame

    SurfaceSide() = default;
    SurfaceSide(const SurfaceHit<R>& hit, const Vec3<R>& viewer, bool has_inside) {
        const bool turn = !has_inside && dot(hit.outside, viewer) < R(0);
        normal = turn ? -hit.outside : hit.outside;
        Vec3<R> shading = turn ? -hit.shading : hit.shading;
        if (!(dot(shading, viewer) * dot(normal, viewer) > R(0))) shading = normal;
        frame = Frame<R>::from_normal(shading);
        const Vec3<R> along = hit.along - shading * dot(shading, hit.along);
        if (dot(along, along) > R(0)) {
            frame.tangent = normalize(along);
            frame.bitangent = cross(shading, frame.tangent);
        }
        wo = frame.to_local(viewer);
    }
    /// Whether a direction lies on the same side of the surface as of the shading normal.
    [[nodiscard]] bool agrees(const Vec3<R>& world, const Vec3<R>& local) const {
        return dot(normal, world) * local.z > R(0);
    }
    /// A start for rays along `direction` that does not hit the surface again.
    [[nodiscard]] Vec3<R> start(const Vec3<R>& position, const Vec3<R>& direction,
                                double offset) const {
        return position + normal * R(dot(normal, direction) > R(0) ? offset : -offset);
    }
};

}  // namespace photograd
