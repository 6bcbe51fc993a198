// A rectangular area light, sampled uniformly by solid angle: all samples have one weight, so that
// only the cosine at the receiver and shadows cause variance.
//
//   L(point, w) = radiance where w meets the rectangle's front,    dL/dradiance = 1 there
//
// The front is the side of edge_x x edge_y. Where the rectangle fills less than 1e-6 sr, its solid
// angle loses its digits, and points are sampled uniformly over its area instead.
#pragma once

#include "photograd/light/area_light.h"
#include "photograd/sampling/spherical_rectangle.h"

namespace photograd {

template <class R>
struct QuadLight {
    Vec3<R> radiance{R(1)};
    Vec3<R> corner{R(-0.5), R(0), R(-0.5)}, edge_x{R(1), R(0), R(0)}, edge_y{R(0), R(0), R(1)};

    static constexpr const char* name = "quad";
    static constexpr LightKind kind = LightKind::area;
    static constexpr auto params =
        describe(p("radiance", &QuadLight::radiance, 0.0, 10.0, "W/(m^2 sr)"));
    static constexpr auto constants = describe(p("corner", &QuadLight::corner, -1.0, 1.0, "m"),
                                               p("edge_x", &QuadLight::edge_x, -1.0, 1.0, "m"),
                                               p("edge_y", &QuadLight::edge_y, -1.0, 1.0, "m"));

    [[nodiscard]] LightFault fault() const {
        const R x2 = dot(edge_x, edge_x), y2 = dot(edge_y, edge_y), xy = dot(edge_x, edge_y);
        if (!(x2 > R(0)) || !(y2 > R(0))) return {"edge_x, edge_y", "edges of some length"};
        if (!(xy * xy <= R(1e-8) * x2 * y2)) return {"edge_x, edge_y", "perpendicular edges"};
        return {};
    }
    Vec3<R> L(const Vec3<R>& point, const Vec3<R>& w) const {
        return intersect(point, w).cosine > R(0) ? radiance : Vec3<R>(R(0));
    }
    void L_backward(const Vec3<R>& point, const Vec3<R>& w, const Vec3<R>& d_L,
                    QuadLight& d_self) const {
        if (intersect(point, w).cosine > R(0)) d_self.radiance += d_L;
    }

    LightSample<R> sample(const Vec3<R>& point, const Vec2<R>& u2) const {
        return sample(point, u2, axes());
    }
    /// With `axes()` kept, which no point changes.
    LightSample<R> sample(const Vec3<R>& point, const Vec2<R>& u2,
                          const RectangleAxes& known) const {
        const Vec3<R> normal = cross(edge_x, edge_y), from = corner - point;
        if (!(dot(from, normal) < R(0))) return {};
        const SphericalRectangle projected = spherical_rectangle(point, known);
        if (projected.solid_angle < smallest)
            return sample_area_light(from + u2.x * edge_x + u2.y * edge_y, normalize(normal),
                                     R(1) / length(normal), radiance);
        const Vec3<double> to = projected.sample({double(u2.x), double(u2.y)});
        const double r = length(to);
        const Vec3<double> w = to * (1 / r);
        return {{R(w.x), R(w.y), R(w.z)}, R(r), radiance, R(1 / projected.solid_angle), false};
    }
    R pdf(const Vec3<R>& point, const Vec3<R>& w) const {
        const Hit at = intersect(point, w);
        return at.cosine > R(0) ? hit_pdf(point, at.t, at.cosine) : R(0);
    }
    /// `pdf` of a direction that hits the front, at this distance and cosine.
    [[nodiscard]] R hit_pdf(const Vec3<R>& point, R distance, R cosine) const {
        return hit_pdf(point, distance, cosine, axes());
    }
    [[nodiscard]] R hit_pdf(const Vec3<R>& point, R distance, R cosine,
                            const RectangleAxes& known) const {
        const double solid_angle = spherical_rectangle(point, known).solid_angle;
        if (solid_angle >= smallest) return R(1 / solid_angle);
        return solid_angle_density(R(1) / length(cross(edge_x, edge_y)), distance * distance,
                                   cosine);
    }

    [[nodiscard]] RectangleAxes axes() const { return {wide(edge_x), wide(edge_y)}; }
    [[nodiscard]] Vec3<R> front() const { return normalize(cross(edge_x, edge_y)); }

private:
    static constexpr double smallest = 1e-6;  // sr

    struct Hit {
        R t, cosine;  // cosine 0: w misses the front
    };
    [[nodiscard]] Hit intersect(const Vec3<R>& point, const Vec3<R>& w) const {
        const Vec3<R> normal = normalize(cross(edge_x, edge_y)), from = corner - point;
        const R cosine = -dot(w, normal), t = -dot(from, normal) / cosine;
        if (!(cosine > R(0)) || !(t > R(0))) return {R(0), R(0)};
        const Vec3<R> inside = w * t - from;
        const R x = dot(inside, edge_x) / dot(edge_x, edge_x),
                y = dot(inside, edge_y) / dot(edge_y, edge_y);
        const bool hit = x >= R(0) && x <= R(1) && y >= R(0) && y <= R(1);
        return {t, hit ? cosine : R(0)};
    }
    static Vec3<double> wide(const Vec3<R>& v) { return Vec3<double>(v.x, v.y, v.z); }
    [[nodiscard]] SphericalRectangle spherical_rectangle(const Vec3<R>& point,
                                                         const RectangleAxes& known) const {
        return {wide(corner) - wide(point), known};
    }
};

static_assert(AreaLight<QuadLight>);

/// A rectangle with what no lit point changes.
template <class R>
struct PlacedQuad {
    QuadLight<R> light;
    RectangleAxes axes;
    Vec3<R> front;

    explicit PlacedQuad(const QuadLight<R>& quad)
        : light(quad), axes(quad.axes()), front(quad.front()) {}

    LightSample<R> sample(const Vec3<R>& point, const Vec2<R>& u2) const {
        return light.sample(point, u2, axes);
    }
    [[nodiscard]] R hit_pdf(const Vec3<R>& point, R distance, R cosine) const {
        return light.hit_pdf(point, distance, cosine, axes);
    }
};

}  // namespace photograd
