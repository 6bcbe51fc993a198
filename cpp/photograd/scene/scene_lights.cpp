#include "photograd/scene/scene_lights.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "photograd/core/errors.h"
#include "photograd/light/light_power.h"
#include "photograd/light/rectangle.h"

namespace photograd {
namespace {

constexpr double least_share = 0.01;  // of all choices, for the lights of the list together

double emitted_luminance(std::span<const double> emission, std::size_t shape) {
    for (std::size_t c = 0; c < 3; ++c) {
        const double L = emission[3 * shape + c];
        if (!(L >= 0) || !std::isfinite(L))
            fail(ErrorKind::scene, "scene", "emission", "finite radiance of at least 0",
                 std::to_string(L) + " in shape " + std::to_string(shape));
    }
    return luminance(&emission[3 * shape]);
}

/// Power of a surface that emits L; refuses one without area.
double surface_power(double area, double L, std::int32_t shape, std::int32_t primitive) {
    if (!(area > 0))
        fail(ErrorKind::scene, "scene", "emission", "lights with an area",
             "none in primitive " + std::to_string(primitive) + " of shape " +
                 std::to_string(shape));
    return pi * area * L;
}

template <class R>
Vec3<R> front_of(const SphereLight<R>& ball, const Vec3<R>& position) {
    return normalize(position - ball.center);
}
template <class R>
Vec3<R> front_of(const PlacedQuad<R>& quad, const Vec3<R>&) {
    return quad.front;
}
template <class R>
Vec3<R> front_of(const TriangleLight<R>& triangle, const Vec3<R>&) {
    return triangle.normal();
}

EmissivePoint uniform_point(const SphereLight<double>& ball, const Vec2<double>& u2) {
    const Vec3<double> out = square_to_cap(u2, 2.0);
    return {ball.center + ball.radius * out, out, 4 * pi * ball.radius * ball.radius};
}
EmissivePoint uniform_point(const PlacedQuad<double>& placed, const Vec2<double>& u2) {
    const QuadLight<double>& quad = placed.light;
    return {quad.corner + u2.x * quad.edge_x + u2.y * quad.edge_y, placed.front,
            length(cross(quad.edge_x, quad.edge_y))};
}
EmissivePoint uniform_point(const TriangleLight<double>& triangle, const Vec2<double>& u2) {
    const Vec2<double> q = square_to_triangle(u2);
    return {triangle.a + q.x * (triangle.b - triangle.a) + q.y * (triangle.c - triangle.a),
            triangle.normal(), triangle.area()};
}

}  // namespace

SceneLights::SceneLights(const Bvh& bvh, std::span<const double> emission,
                         std::span<const AnyLight<double>> infinite_and_delta)
    : infinite_and_delta_count_(static_cast<std::int64_t>(infinite_and_delta.size())) {
    std::vector<double> power;
    for (std::size_t i = 0; i < infinite_and_delta.size(); ++i) {
        (is_delta(infinite_and_delta[i]) ? deltas_ : at_infinity_)
            .push_back(static_cast<std::int32_t>(i));
        power.push_back(light_power(infinite_and_delta[i], bvh.bounds()));
    }
    const std::size_t shapes = bvh.shape_count();
    first_.assign(shapes, -1);
    for (std::size_t shape = 0; shape < shapes; ++shape) {
        const double L = emitted_luminance(emission, shape);
        if (L > 0) add_shape(bvh, static_cast<std::int32_t>(shape), L, power);
    }
    double total = 0;
    for (const double P : power) total += P;
    const double least =
        total > 0
            ? least_share * total / std::max(1.0, static_cast<double>(infinite_and_delta_count_))
            : 1.0;
    for (std::size_t i = 0; i < infinite_and_delta.size(); ++i)
        power[i] = std::max(power[i], least);
    if (!power.empty()) choice_ = Distribution1D(power);
    std::vector<double> of_deltas;
    for (const std::int32_t i : deltas_) of_deltas.push_back(power[static_cast<std::size_t>(i)]);
    if (!of_deltas.empty()) delta_choice_ = Distribution1D(of_deltas);
}

template <class R>
void SceneLights::add_rectangle(const QuadLight<double>& quad) {
    std::get<std::vector<PlacedQuad<R>>>(rectangles_)
        .emplace_back(QuadLight<R>{Vec3<R>(1), Vec3<R>(quad.corner), Vec3<R>(quad.edge_x),
                                   Vec3<R>(quad.edge_y)});
}

void SceneLights::add_shape(const Bvh& bvh, std::int32_t shape, double L,
                            std::vector<double>& power) {
    if (bvh.moves(shape))
        fail(ErrorKind::scene, "scene", "emission", "lights that stand still",
             "one that moves, shape " + std::to_string(shape));
    if (shape >= bvh.first_solid())
        fail(ErrorKind::scene, "scene", "emission", "light from meshes and spheres alone",
             "an SDF that emits light, shape " + std::to_string(shape));
    first_[static_cast<std::size_t>(shape)] = static_cast<std::int32_t>(primitives_.size());
    if (shape >= bvh.sphere_instance()) {
        const std::int32_t ball = shape - bvh.sphere_instance();
        const double r = double(bvh.spheres()[static_cast<std::size_t>(ball)].radius);
        primitives_.push_back({shape, ball});
        power.push_back(surface_power(4 * pi * r * r, L, shape, ball));
        return;
    }
    const auto faces = static_cast<std::int32_t>(bvh.mesh_of(shape).face_count());
    Vec3<double> p[3], other[3];
    if (faces == 2) {
        bvh.corners(shape, 0, p);
        bvh.corners(shape, 1, other);
        if (const auto rectangle = rectangle_of(p, other)) {
            const auto known = std::get<1>(rectangles_).size();
            primitives_.push_back({shape, 0, static_cast<std::int32_t>(known)});
            add_rectangle<float>(*rectangle);
            add_rectangle<double>(*rectangle);
            const double area = length(cross(rectangle->edge_x, rectangle->edge_y));
            power.push_back(surface_power(area, L, shape, 0));
            return;
        }
    }
    for (std::int32_t face = 0; face < faces; ++face) {
        bvh.corners(shape, face, p);
        primitives_.push_back({shape, face});
        power.push_back(
            surface_power(0.5 * length(cross(p[1] - p[0], p[2] - p[0])), L, shape, face));
    }
}

Choice SceneLights::choose_delta(double u) const {
    Choice choice = delta_choice_.sample(u);
    choice.index = deltas_[static_cast<std::size_t>(choice.index)];
    return choice;
}

/// use(the primitive as a light of its kind).
template <class R, class Use>
auto SceneLights::as_light(const Bvh& bvh, const EmissivePrimitive& emissive, Use&& use) const {
    if (emissive.rectangle >= 0)
        return use(std::get<std::vector<PlacedQuad<R>>>(
            rectangles_)[static_cast<std::size_t>(emissive.rectangle)]);
    if (emissive.shape >= bvh.sphere_instance()) {
        const Sphere& ball = bvh.spheres()[static_cast<std::size_t>(emissive.primitive)];
        return use(SphereLight<R>{Vec3<R>(1), ball.center<R>(), R(ball.radius)});
    }
    Vec3<R> p[3];
    bvh.corners(emissive.shape, emissive.primitive, p);
    return use(TriangleLight<R>{Vec3<R>(1), p[0], p[1], p[2]});
}

template <Real R>
EmissiveSample<R> SceneLights::sample(const Bvh& bvh, const EmissivePrimitive& emissive,
                                      const Vec3<R>& point, const Vec2<R>& u2) const {
    return as_light<R>(bvh, emissive, [&](const auto& light) -> EmissiveSample<R> {
        const LightSample<R> found = light.sample(point, u2);
        if (!(found.pdf > R(0))) return {};
        return {found, front_of(light, point + found.direction * found.distance)};
    });
}

EmissivePoint SceneLights::point_on(const Bvh& bvh, const EmissivePrimitive& emissive,
                                    const Vec2<double>& u2) const {
    return as_light<double>(bvh, emissive,
                            [&](const auto& light) { return uniform_point(light, u2); });
}

template <Real R>
R SceneLights::hit_pdf(const Bvh& bvh, std::int32_t shape, std::int32_t primitive,
                       const Vec3<R>& point, R distance, R cosine) const {
    const std::int32_t first = first_[static_cast<std::size_t>(shape)];
    if (first < 0) return R(0);
    const EmissivePrimitive& start = primitives_[static_cast<std::size_t>(first)];
    const bool single = start.rectangle >= 0 || shape >= bvh.sphere_instance();
    const std::int64_t number = first + (single ? 0 : primitive);
    const R density =
        as_light<R>(bvh, primitives_[static_cast<std::size_t>(number)],
                    [&](const auto& light) { return light.hit_pdf(point, distance, cosine); });
    return R(pmf(infinite_and_delta_count_ + number)) * density;
}

template EmissiveSample<float> SceneLights::sample(const Bvh&, const EmissivePrimitive&,
                                                   const Vec3<float>&, const Vec2<float>&) const;
template EmissiveSample<double> SceneLights::sample(const Bvh&, const EmissivePrimitive&,
                                                    const Vec3<double>&, const Vec2<double>&) const;
template float SceneLights::hit_pdf(const Bvh&, std::int32_t, std::int32_t, const Vec3<float>&,
                                    float, float) const;
template double SceneLights::hit_pdf(const Bvh&, std::int32_t, std::int32_t, const Vec3<double>&,
                                     double, double) const;

}  // namespace photograd
