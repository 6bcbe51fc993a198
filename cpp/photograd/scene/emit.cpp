#include "photograd/scene/emit.h"

#include "photograd/sampling/warp.h"

namespace photograd {
namespace {

struct BoundingSphere {
    Vec3<double> center;
    double radius;

    explicit BoundingSphere(const Box& box) {
        Vec3<double> half;
        for (int k = 0; k < 3; ++k) {
            center[k] = 0.5 * (double(box.lo[k]) + double(box.hi[k]));
            half[k] = 0.5 * (double(box.hi[k]) - double(box.lo[k]));
        }
        radius = length(half);
    }
    void include(const Vec3<double>& point) { radius = std::max(radius, length(point - center)); }
};

/// Around all shapes, and around the density grid of the world's medium, which scatters as well.
BoundingSphere around_scene(const PathGeometry& geometry) {
    BoundingSphere around(geometry.bvh.bounds());
    const std::int32_t world = geometry.media.any() ? geometry.media.world : MediaGeometry::vacuum;
    if (world < 0) return around;
    const DensityLayout& grid = geometry.media.grids[static_cast<std::size_t>(world)];
    if (grid.empty()) return around;
    for (int corner = 0; corner < 8; ++corner)
        around.include(grid.in_world(Vec3<double>(corner & 1, corner >> 1 & 1, corner >> 2)));
    return around;
}

/// Parallel light of irradiance E from `towards`, through a point of the disc.
Particle from_infinity(const BoundingSphere& around, const Vec3<double>& towards,
                       const Vec3<double>& E, const Vec2<double>& u_position) {
    const Vec2<double> p = square_to_disk(u_position);
    const auto frame = Frame<double>::from_normal(towards);
    Particle out;
    out.origin =
        around.center + around.radius * (p.x * frame.tangent + p.y * frame.bitangent + towards);
    out.direction = -towards;
    out.flux = E * (pi * around.radius * around.radius);
    out.far = true;
    return out;
}

/// From a light without size at `position`, into a cap of directions around `axis`.
template <class L>
Particle from_point(const L& light, const Vec3<double>& axis, double height,
                    const Vec2<double>& u_direction) {
    Particle out;
    out.origin = light.position;
    out.direction = Frame<double>::from_normal(axis).to_world(square_to_cap(u_direction, height));
    // The irradiance a meter away is what one steradian gets.
    out.flux = light.at(out.origin + out.direction).radiance * (2 * pi * height);
    return out;
}

Particle from_infinite_or_delta(const AnyLight<double>& any, const BoundingSphere& around,
                                const Vec2<double>& u_position, const Vec2<double>& u_direction) {
    return std::visit(
        [&]<class L>(const L& light) -> Particle {
            if constexpr (L::kind == LightKind::spot) {
                return from_point(light, light.axis, 1 - light.cos_outer, u_direction);
            } else if constexpr (L::kind == LightKind::point) {
                return from_point(light, Vec3<double>(0, 0, 1), 2.0, u_direction);
            } else {
                const LightSample<double> s = sample_light(light, around.center, u_direction);
                if (!(s.pdf > 0)) return {};
                return from_infinity(around, s.direction, s.radiance * (1 / s.pdf), u_position);
            }
        },
        any.model);
}

Particle from_surface(const PathScene<double>& scene, const EmissivePrimitive& emissive,
                      const Vec2<double>& u_position, const Vec2<double>& u_direction) {
    const PathGeometry& geometry = *scene.geometry;
    const EmissivePoint at = geometry.lights.point_on(geometry.bvh, emissive, u_position);
    Particle out;
    out.normal = at.normal;
    out.direction =
        Frame<double>::from_normal(at.normal).to_world(square_to_cosine_hemisphere(u_direction));
    out.origin = at.position + at.normal * geometry.offset;
    const Vec2<double> uv = emissive_uv(geometry, emissive, at.position);
    out.flux = scene.emitted(emissive.shape, uv) * (pi * at.area);
    return out;
}

}  // namespace

Particle emit(const PathScene<double>& scene, double u, const Vec2<double>& u_position,
              const Vec2<double>& u_direction) {
    const SceneLights& lights = scene.geometry->lights;
    const Choice choice = lights.choose(u);
    Particle out =
        choice.index < lights.infinite_and_delta_count()
            ? from_infinite_or_delta(scene.lights[static_cast<std::size_t>(choice.index)],
                                     around_scene(*scene.geometry), u_position, u_direction)
            : from_surface(scene, lights.primitive(choice.index), u_position, u_direction);
    out.flux *= 1 / choice.pmf;
    out.entry = choice.index;
    return out;
}

}  // namespace photograd
