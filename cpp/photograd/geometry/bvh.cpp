#include "photograd/geometry/bvh.h"

// The one switch between Embree's major versions; the build says which was found.
#if PHOTOGRAD_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "photograd/core/errors.h"
#include "photograd/geometry/bvh_limits.h"
#include "photograd/geometry/ray_batch.h"

namespace photograd {
namespace {

constexpr int width = RayPacket::width;

// Version 3 takes a context, version 4 optional arguments; both carry the hint about coherence.
#if PHOTOGRAD_EMBREE_MAJOR == 3
RTCIntersectContext query(bool side_by_side) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        side_by_side ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}
void intersect(const int* valid, RTCScene scene, bool side_by_side, RTCRayHit16* rays) {
    RTCIntersectContext context = query(side_by_side);
    rtcIntersect16(valid, scene, &context, rays);
}
void any_hit(const int* valid, RTCScene scene, bool side_by_side, RTCRay16* rays) {
    RTCIntersectContext context = query(side_by_side);
    rtcOccluded16(valid, scene, &context, rays);
}
#else
RTCRayQueryFlags query(bool side_by_side) {
    return side_by_side ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
}
void intersect(const int* valid, RTCScene scene, bool side_by_side, RTCRayHit16* rays) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = query(side_by_side);
    rtcIntersect16(valid, scene, rays, &arguments);
}
void any_hit(const int* valid, RTCScene scene, bool side_by_side, RTCRay16* rays) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = query(side_by_side);
    rtcOccluded16(valid, scene, rays, &arguments);
}
#endif

/// valid[i] is -1 where lane i is on and Embree takes its ray, else 0: Embree ends the process over
/// numbers out of its range and over NaN. A sum of sizes is cheaper than a look at each of them.
void find_valid(const RayPacket& rays, float reach, int* valid) {
    float size[width] = {};
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < width; ++i)
            size[i] += std::abs(rays.origin[axis][i]) + std::abs(rays.direction[axis][i]);
    for (int i = 0; i < width; ++i) valid[i] = rays.active[i] ? -1 : 0;
    for (int i = 0; i < width; ++i)
        valid[i] &= -static_cast<int>(size[i] <= reach) & -static_cast<int>(rays.t_min[i] >= 0) &
                    -static_cast<int>(rays.t_min[i] <= rays.t_max[i]);
}

/// Where packets of sixteen have no kernel (processors without AVX-512), Embree splits them up and
/// does not look at `valid`, only at the interval: a lane that is off gets an empty one, and a
/// harmless ray. So does one whose ray is not valid: it meets nothing. Paths may scatter that far.
void load(const RayPacket& rays, float reach, RTCRay16& out, int* valid) {
    find_valid(rays, reach, valid);
    for (int i = 0; i < width; ++i) {
        const bool on = valid[i] != 0;
        out.org_x[i] = on ? rays.origin[0][i] : 0;
        out.org_y[i] = on ? rays.origin[1][i] : 0;
        out.org_z[i] = on ? rays.origin[2][i] : 0;
        out.dir_x[i] = on ? rays.direction[0][i] : 0;
        out.dir_y[i] = on ? rays.direction[1][i] : 0;
        out.dir_z[i] = on ? rays.direction[2][i] : 1;
        out.tnear[i] = on ? rays.t_min[i] : 1;
        out.tfar[i] = on ? rays.t_max[i] : 0;
        out.time[i] = on ? rays.time[i] : 0;
        out.mask[i] = 0xffffffffu;
        out.id[i] = static_cast<unsigned>(i);
        out.flags[i] = 0;
    }
}

/// Embree's callback must not throw: it keeps the first message for `check` to throw.
void keep_message(void* message, RTCError, const char* text) {
    auto& kept = *static_cast<std::string*>(message);
    if (kept.empty() && text) kept = text;
}

void bounds_of_solid(const RTCBoundsFunctionArguments* a) {
    const Box& box = static_cast<const SdfSolid*>(a->geometryUserPtr)[a->primID].bounds();
    *a->bounds_o = {box.lo.x, box.lo.y, box.lo.z, 0, box.hi.x, box.hi.y, box.hi.z, 0};
}
/// met(i, t) for every ray of Embree's packet that hits solid `primID` before its
/// nearest hit so far.
template <class Arguments, class Met>
void march_packet(const Arguments& a, RTCRayN* rays, Met&& met) {
    const SdfSolid& solid = static_cast<const SdfSolid*>(a.geometryUserPtr)[a.primID];
    for (unsigned i = 0; i < a.N; ++i) {
        if (a.valid[i] == 0) continue;
        const Ray<double> ray{
            {RTCRayN_org_x(rays, a.N, i), RTCRayN_org_y(rays, a.N, i), RTCRayN_org_z(rays, a.N, i)},
            {RTCRayN_dir_x(rays, a.N, i), RTCRayN_dir_y(rays, a.N, i),
             RTCRayN_dir_z(rays, a.N, i)}};
        const float near = RTCRayN_tnear(rays, a.N, i), far = RTCRayN_tfar(rays, a.N, i);
        const double t = solid.march(ray, double(near), double(far));
        if (std::isfinite(t)) met(i, std::max(near, static_cast<float>(t)));
    }
}
void intersect_solid(const RTCIntersectFunctionNArguments* a) {
    RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
    RTCHitN* hits = RTCRayHitN_HitN(a->rayhit, a->N);
    march_packet(*a, rays, [&](unsigned i, float t) {
        RTCRayN_tfar(rays, a->N, i) = t;
        RTCHitN_Ng_x(hits, a->N, i) = RTCHitN_Ng_y(hits, a->N, i) = RTCHitN_Ng_z(hits, a->N, i) = 0;
        RTCHitN_u(hits, a->N, i) = RTCHitN_v(hits, a->N, i) = 0;
        RTCHitN_primID(hits, a->N, i) = a->primID;
        RTCHitN_geomID(hits, a->N, i) = a->geomID;
        RTCHitN_instID(hits, a->N, i, 0) = RTC_INVALID_GEOMETRY_ID;  // solids are never instanced
    });
}
void occlude_by_solid(const RTCOccludedFunctionNArguments* a) {
    march_packet(*a, a->ray, [&](unsigned i, float) {
        RTCRayN_tfar(a->ray, a->N, i) = -std::numeric_limits<float>::infinity();
    });
}

}  // namespace

struct Bvh::Tree {
    std::string message;
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<RTCScene> mesh_scenes;  // of meshes that are placed by a transformation
    std::vector<RTCGeometry> geometries;
    bool transformed = false;  // some instance lies under a transformation
    float reach = 1e18f;       // most that sizes of a ray add up to; Embree takes 1.8e18 each

    Tree() : device(rtcNewDevice(nullptr)) {
        if (!device)
            fail(ErrorKind::scene, "bvh", "device", "an Embree device",
                 "error " + std::to_string(static_cast<int>(rtcGetDeviceError(nullptr))));
        rtcSetDeviceErrorFunction(device, &keep_message, &message);
        scene = new_scene();
    }
    ~Tree() {
        for (RTCGeometry g : geometries) rtcReleaseGeometry(g);
        for (RTCScene s : mesh_scenes)
            if (s) rtcReleaseScene(s);
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;

    [[nodiscard]] RTCScene new_scene() const {
        const RTCScene s = rtcNewScene(device);
        rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
        return s;
    }
    void check(const char* argument) const {
        const RTCError code = rtcGetDeviceError(device);
        if (code != RTC_ERROR_NONE || !message.empty())
            fail(ErrorKind::scene, "bvh", argument, "geometry that Embree accepts",
                 "error " + std::to_string(static_cast<int>(code)) + ": " + message);
    }
    void add_mesh(const Mesh& mesh) {
        const RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        geometries.push_back(g);
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   mesh.vertex_data(), 0, 3 * sizeof(float),
                                   static_cast<std::size_t>(mesh.vertex_count()));
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.face_data(),
                                   0, 3 * sizeof(std::uint32_t),
                                   static_cast<std::size_t>(mesh.face_count()));
        rtcCommitGeometry(g);
        check("meshes");
    }
    /// All spheres as one geometry, in the scene under the number `id`.
    void add_spheres(const std::vector<Sphere>& spheres, const std::vector<Sphere>& closing,
                     unsigned id) {
        const RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        rtcSetGeometryTimeStepCount(g, closing.empty() ? 1 : 2);
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, spheres.data(),
                                   0, sizeof(Sphere), spheres.size());
        if (!closing.empty())
            rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 1, RTC_FORMAT_FLOAT4,
                                       closing.data(), 0, sizeof(Sphere), closing.size());
        rtcCommitGeometry(g);
        rtcAttachGeometryByID(scene, g, id);
        rtcReleaseGeometry(g);
        check("spheres");
    }
    /// All solids as one geometry of ours, in the scene under the number `id`.
    void add_solids(const std::vector<SdfSolid>& solids, unsigned id) {
        const RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(solids.size()));
        // Embree only hands the pointer back, as one to non-const.
        rtcSetGeometryUserData(g, const_cast<SdfSolid*>(solids.data()));
        rtcSetGeometryBoundsFunction(g, &bounds_of_solid, nullptr);
        rtcSetGeometryIntersectFunction(g, &intersect_solid);
        rtcSetGeometryOccludedFunction(g, &occlude_by_solid);
        rtcCommitGeometry(g);
        rtcAttachGeometryByID(scene, g, id);
        rtcReleaseGeometry(g);
        check("solids");
    }
    /// Puts mesh `it.mesh` into the scene under the number `id`; without a transformation directly,
    /// which saves a level of the hierarchy.
    void add_instance(const Instance& it, unsigned id) {
        const auto m = static_cast<std::size_t>(it.mesh);
        if (!it.is_placed) {
            rtcAttachGeometryByID(scene, geometries[m], id);
            return;
        }
        transformed = true;
        if (!mesh_scenes[m]) {
            mesh_scenes[m] = new_scene();
            rtcAttachGeometry(mesh_scenes[m], geometries[m]);
            rtcCommitScene(mesh_scenes[m]);
        }
        const RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(g, mesh_scenes[m]);
        rtcSetGeometryTimeStepCount(g, it.moves ? 2 : 1);
        for (unsigned step = 0; step < (it.moves ? 2u : 1u); ++step) {
            const Affine& transform = step == 0 ? it.world_from_object : it.closing;
            float rows[12];
            for (std::size_t i = 0; i < 12; ++i) rows[i] = static_cast<float>(transform.m[i]);
            rtcSetGeometryTransform(g, step, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows);
        }
        rtcCommitGeometry(g);
        rtcAttachGeometryByID(scene, g, id);
        rtcReleaseGeometry(g);
    }
};

Bvh::Bvh(std::vector<Mesh> meshes, std::vector<Instance> instances, std::vector<Sphere> spheres,
         std::vector<SdfSolid> solids, std::vector<Sphere> closing_spheres)
    : meshes_(std::move(meshes)),
      instances_(std::move(instances)),
      spheres_(std::move(spheres)),
      closing_spheres_(std::move(closing_spheres)),
      solids_(std::move(solids)),
      tree_(std::make_unique<Tree>()) {
    if (shape_count() == 0) fail(ErrorKind::scene, "bvh", "instances", "at least one", "none");
    check_spheres(spheres_);
    check_spheres(closing_spheres_);
    moves_ = !closing_spheres_.empty();
    if (moves_ && closing_spheres_.size() != spheres_.size())
        fail(ErrorKind::scene, "bvh", "closing_spheres", "one for each sphere, or none",
             std::to_string(closing_spheres_.size()));
    std::vector<Vec3<double>> extents;
    for (const Mesh& mesh : meshes_) {
        extents.push_back(extent_of(mesh));
        check_transform("vertices", {}, extents.back(),
                        "mesh " + std::to_string(extents.size() - 1));
        tree_->add_mesh(mesh);
    }
    tree_->mesh_scenes.resize(meshes_.size(), nullptr);
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        Instance& it = instances_[i];
        it.is_placed = it.moves || !it.world_from_object.is_identity();
        const std::string name = "instance " + std::to_string(i);
        if (it.mesh < 0 || it.mesh >= static_cast<int>(meshes_.size()))
            fail(ErrorKind::scene, "bvh", "instances",
                 "mesh numbers below " + std::to_string(meshes_.size()),
                 std::to_string(it.mesh) + " in " + name);
        const double volume = it.world_from_object.determinant();
        if (!(std::abs(volume) > 0 && std::abs(volume) < std::numeric_limits<double>::infinity()))
            fail(ErrorKind::scene, "bvh", "world_from_object", "finite, invertible matrices",
                 "determinant " + std::to_string(volume) + " in " + name);
        const Vec3<double>& extent = extents[static_cast<std::size_t>(it.mesh)];
        check_transform("world_from_object", it.world_from_object, extent, name);
        if (it.moves) check_transform("world_from_object", it.closing, extent, name);
        if (it.is_placed)
            tree_->reach = std::min(tree_->reach, static_cast<float>(reach_into(it, name)));
        moves_ = moves_ || it.moves;
        tree_->add_instance(it, static_cast<unsigned>(i));
    }
    if (!spheres_.empty())
        tree_->add_spheres(spheres_, closing_spheres_, static_cast<unsigned>(instances_.size()));
    if (!solids_.empty()) tree_->add_solids(solids_, static_cast<unsigned>(solid_instance()));
    rtcCommitScene(tree_->scene);
    tree_->check("instances");
    RTCBounds b;
    rtcGetSceneBounds(tree_->scene, &b);
    bounds_ = {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
    check_reach(double(tree_->reach), bounds_);
}

Bvh::~Bvh() = default;
Bvh::Bvh(Bvh&&) noexcept = default;

bool Bvh::moves(std::int32_t shape) const {
    const auto number = static_cast<std::size_t>(shape);
    if (number < instances_.size()) return instances_[number].moves;
    if (closing_spheres_.empty() || shape >= first_solid()) return false;
    const Sphere &a = spheres_[number - instances_.size()],
                 &b = closing_spheres_[number - instances_.size()];
    return a.x != b.x || a.y != b.y || a.z != b.z || a.radius != b.radius;
}

void Bvh::trace(const RayPacket& rays, bool side_by_side, PacketHits& hits) const {
    RTCRayHit16 packet;
    alignas(64) int valid[width];
    load(rays, tree_->reach, packet.ray, valid);
    for (int i = 0; i < width; ++i) {
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    intersect(valid, tree_->scene, side_by_side, &packet);
    for (int i = 0; i < width; ++i) {
        const bool hit = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        const bool placed = packet.hit.instID[0][i] != RTC_INVALID_GEOMETRY_ID;
        hits.t[i] = hit ? packet.ray.tfar[i] : std::numeric_limits<float>::infinity();
        hits.u[i] = hit ? packet.hit.u[i] : 0;
        hits.v[i] = hit ? packet.hit.v[i] : 0;
        hits.primitive[i] = hit ? static_cast<std::int32_t>(packet.hit.primID[i]) : -1;
        hits.instance[i] =
            hit ? static_cast<std::int32_t>(placed ? packet.hit.instID[0][i] : packet.hit.geomID[i])
                : -1;
    }
}

void Bvh::occluded(const RayPacket& rays, bool side_by_side, bool* blocked) const {
    RTCRay16 packet;
    alignas(64) int valid[width];
    load(rays, tree_->reach, packet, valid);
    // In scenes with transformed instances rtcOccluded16 of Embree 3.13.5 (Debian's) loops for ever
    // on packets with the coherent hint whose directions differ in sign; rtcIntersect16 does not,
    // nor does Embree 4.4. Occlusion goes without the hint there.
    any_hit(valid, tree_->scene, side_by_side && !tree_->transformed, &packet);
    for (int i = 0; i < width; ++i) blocked[i] = rays.active[i] && packet.tfar[i] < 0;
}

template <Real R>
void Bvh::trace(const RaySpan<R>& rays, const RayInterval<R>& interval,
                const HitSpan<R>& out) const {
    for_each_packet(rays, interval, bounds_, tree_->reach, "trace",
                    [&](const RayPacket& packet, bool near, const auto& rows) {
                        PacketHits hits;
                        trace(packet, near, hits);
                        for (int k = 0; k < width; ++k) {
                            if (!packet.active[k]) continue;
                            const std::int64_t i = rows[k];
                            out.primitive[i] = hits.primitive[k];
                            out.instance[i] = hits.instance[k];
                            out.t[i] = R(hits.t[k]);
                            out.barycentrics[2 * i] = R(hits.u[k]);
                            out.barycentrics[2 * i + 1] = R(hits.v[k]);
                            if constexpr (std::same_as<R, double>) {
                                if (hits.primitive[k] < 0 || hits.instance[k] >= sphere_instance())
                                    continue;
                                const auto p =
                                    surface_point(rays.ray(i), hits.instance[k], hits.primitive[k]);
                                out.t[i] = p.t;
                                out.barycentrics[2 * i] = p.u;
                                out.barycentrics[2 * i + 1] = p.v;
                            }
                        }
                    });
}

template <Real R>
void Bvh::occluded(const RaySpan<R>& rays, const RayInterval<R>& interval, bool* blocked) const {
    for_each_packet(rays, interval, bounds_, tree_->reach, "occluded",
                    [&](const RayPacket& packet, bool near, const auto& rows) {
                        bool hit[width];
                        occluded(packet, near, hit);
                        for (int k = 0; k < width; ++k)
                            if (packet.active[k]) blocked[rows[k]] = hit[k];
                    });
}

template void Bvh::trace(const RaySpan<float>&, const RayInterval<float>&,
                         const HitSpan<float>&) const;
template void Bvh::trace(const RaySpan<double>&, const RayInterval<double>&,
                         const HitSpan<double>&) const;
template void Bvh::occluded(const RaySpan<float>&, const RayInterval<float>&, bool*) const;
template void Bvh::occluded(const RaySpan<double>&, const RayInterval<double>&, bool*) const;

}  // namespace photograd
