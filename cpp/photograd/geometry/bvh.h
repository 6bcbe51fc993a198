// A bounding volume hierarchy over meshes, their instances, spheres and SDFs: nearest hits and
// occlusion.
//
// Built and traversed by Embree [Wald2014], always in its robust mode: in the default mode single
// rays miss the shared edges of closed meshes. Embree answers in float; `surface_point` recomputes
// the hit on the triangle in the caller's number type.
#pragma once

#include <memory>
#include <span>

#include "photograd/core/real.h"
#include "photograd/geometry/affine.h"
#include "photograd/geometry/mesh.h"
#include "photograd/geometry/ray_order.h"
#include "photograd/geometry/sdf_solid.h"
#include "photograd/geometry/sphere.h"
#include "photograd/geometry/triangle.h"

namespace photograd {

/// `closing` is world_from_object when the shutter closes, of an instance that moves while it is
/// open; every point moves in a straight line at constant speed.
struct Instance {
    int mesh;
    Affine world_from_object;
    bool moves = false;
    Affine closing = {};
    bool is_placed = false;  // its vertices are not in the world's frame; set by Bvh

    [[nodiscard]] Affine at(double time) const {
        return moves ? world_from_object.towards(closing, time) : world_from_object;
    }
};

/// Up to 16 rays side by side, the unit in which renderers trace. Directions need not have unit
/// length: t counts in lengths of the direction.
struct alignas(64) RayPacket {
    static constexpr int width = 16;
    float origin[3][width], direction[3][width], t_min[width], t_max[width];
    float time[width];  // from 0, when the shutter opens, to 1
    bool active[width];
};

/// t is infinite and both numbers are -1 where nothing was hit.
struct alignas(64) PacketHits {
    float t[RayPacket::width], u[RayPacket::width], v[RayPacket::width];
    std::int32_t primitive[RayPacket::width], instance[RayPacket::width];
};

/// The part of each ray that counts, [t_min, t_max]: arrays (R,), or one number with step 0.
template <class R>
struct RayInterval {
    const R *t_min, *t_max;
    int t_min_step = 0, t_max_step = 0;
};

/// Where `trace` puts its answers: t (R,), primitive (R,), instance (R,), barycentrics (R, 2).
template <class R>
struct HitSpan {
    R* t;
    std::int32_t* primitive;
    std::int32_t* instance;
    R* barycentrics;
};

/// Results of `surface_points`; in a mesh without texture coordinates uv are the barycentrics.
template <class R>
struct SurfaceSpan {
    R *t, *barycentrics, *uv, *position, *normal;  // (R,), (R, 2), (R, 2), (R, 3), (R, 3)
};

class Bvh {
public:
    /// Spheres have no instances: all of them answer under one number, `sphere_instance()`, and the
    /// primitive is the number of the sphere; so do signed distance fields under
    /// `solid_instance()`. Functions that speak of triangles do not take theirs. `closing_spheres`
    /// are the same ones when the shutter closes, or none if all stand still.
    Bvh(std::vector<Mesh> meshes, std::vector<Instance> instances, std::vector<Sphere> spheres = {},
        std::vector<SdfSolid> solids = {}, std::vector<Sphere> closing_spheres = {});
    ~Bvh();
    Bvh(Bvh&&) noexcept;

    /// Nearest hits of a batch, in the order of the input. Rays that run side by side are traced in
    /// packets; others are reordered first (ray_order.h). The same bits for any number of threads.
    /// Hits on triangles are recomputed in R; t of spheres and SDFs is Embree's, a float.
    /// RangeError, with a count, for rays without direction or with numbers that Embree refuses.
    template <Real R>
    void trace(const RaySpan<R>& rays, const RayInterval<R>& interval,
               const HitSpan<R>& hits) const;

    /// blocked[i] = anything at all lies within the interval of ray i.
    template <Real R>
    void occluded(const RaySpan<R>& rays, const RayInterval<R>& interval, bool* blocked) const;

    /// One packet; `side_by_side`: neighbors, a hint. What Embree does not take meets nothing.
    void trace(const RayPacket& rays, bool side_by_side, PacketHits& hits) const;
    void occluded(const RayPacket& rays, bool side_by_side, bool* blocked) const;

    /// The world-space corners of a hit triangle.
    template <class R>
    void corners(std::int32_t instance, std::int32_t primitive, Vec3<R> out[3],
                 double time = 0) const {
        const Instance& it = instances_[static_cast<std::size_t>(instance)];
        const Mesh& mesh = meshes_[static_cast<std::size_t>(it.mesh)];
        const std::uint32_t* c = mesh.corners(static_cast<std::uint32_t>(primitive));
        for (int k = 0; k < 3; ++k) out[k] = mesh.vertex<R>(c[k]);
        if (!it.is_placed) return;
        const Affine world_from_object = it.at(time);
        for (int k = 0; k < 3; ++k) out[k] = world_from_object.point(out[k]);
    }
    template <class R>
    [[nodiscard]] TrianglePoint<R> surface_point(const Ray<R>& ray, std::int32_t instance,
                                                 std::int32_t primitive, double time = 0) const {
        Vec3<R> p[3];
        corners(instance, primitive, p, time);
        return triangle_point(ray, p[0], p[1], p[2]);
    }

    /// Texture coordinates at the barycentrics (u, v) of a hit.
    template <class R>
    [[nodiscard]] Vec2<R> texture_point(std::int32_t instance, std::int32_t primitive, R u,
                                        R v) const {
        const Mesh& mesh = mesh_of(instance);
        if (!mesh.has_uv()) return {u, v};
        const std::uint32_t* c = mesh.corners(static_cast<std::uint32_t>(primitive));
        const Vec2<R> a = mesh.uv<R>(c[0]);
        return a + u * (mesh.uv<R>(c[1]) - a) + v * (mesh.uv<R>(c[2]) - a);
    }
    /// `surface_point` for a batch of hits; a row with primitive -1 gets infinite t and zeros.
    template <Real R>
    void surface_points(const RaySpan<R>& rays, const std::int32_t* primitive,
                        const std::int32_t* instance, const SurfaceSpan<R>& out) const;
    /// Refuses (RangeError, naming the row) numbers that belong to no triangle of this scene.
    void check_numbers(const char* function, std::span<const std::int32_t> primitive,
                       const std::int32_t* instance) const;

    [[nodiscard]] const Mesh& mesh_of(std::int32_t instance) const {
        const Instance& it = instances_[static_cast<std::size_t>(instance)];
        return meshes_[static_cast<std::size_t>(it.mesh)];
    }
    [[nodiscard]] std::span<const Mesh> meshes() const { return meshes_; }
    [[nodiscard]] std::span<const Instance> instances() const { return instances_; }
    [[nodiscard]] std::span<const Sphere> spheres() const { return spheres_; }
    [[nodiscard]] std::int32_t sphere_instance() const {
        return static_cast<std::int32_t>(instances_.size());
    }
    /// A sphere at a time from 0 to 1.
    [[nodiscard]] Sphere sphere(std::int32_t number, float time) const {
        const Sphere& a = spheres_[static_cast<std::size_t>(number)];
        if (closing_spheres_.empty()) return a;
        const Sphere& b = closing_spheres_[static_cast<std::size_t>(number)];
        const auto between = [time](float x, float y) { return (1 - time) * x + time * y; };
        return {between(a.x, b.x), between(a.y, b.y), between(a.z, b.z),
                between(a.radius, b.radius)};
    }
    /// Whether anything moves while the shutter is open; whether this shape does.
    [[nodiscard]] bool moves() const { return moves_; }
    [[nodiscard]] bool moves(std::int32_t shape) const;
    [[nodiscard]] std::span<const SdfSolid> solids() const { return solids_; }
    [[nodiscard]] std::int32_t solid_instance() const { return sphere_instance() + 1; }
    /// Instances, spheres and solids are numbered one after another.
    [[nodiscard]] std::size_t shape_count() const {
        return instances_.size() + spheres_.size() + solids_.size();
    }
    [[nodiscard]] std::int32_t first_solid() const {
        return static_cast<std::int32_t>(instances_.size() + spheres_.size());
    }
    [[nodiscard]] const Box& bounds() const { return bounds_; }

private:
    struct Tree;  // Embree's handles
    std::vector<Mesh> meshes_;
    std::vector<Instance> instances_;
    std::vector<Sphere> spheres_, closing_spheres_;
    std::vector<SdfSolid> solids_;
    bool moves_ = false;
    std::unique_ptr<Tree> tree_;
    Box bounds_;
};

}  // namespace photograd
