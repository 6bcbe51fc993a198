// A triangular area light, sampled uniformly over its area.
//
//   L(point, w) = radiance where w hits the front, from which a, b, c turn counterclockwise;
//   dL/dradiance = 1 there
//   density = (1 / area) r^2 / cos
//       cos at the triangle, between its normal and the direction to the point
#pragma once

#include "photograd/geometry/triangle.h"
#include "photograd/light/area_light.h"

namespace photograd {

template <class R>
struct TriangleLight {
    Vec3<R> radiance{R(1)};
    Vec3<R> a{R(0)}, b{R(1), R(0), R(0)}, c{R(0), R(0), R(1)};

    static constexpr const char* name = "triangle";
    static constexpr LightKind kind = LightKind::area;
    static constexpr auto params =
        describe(p("radiance", &TriangleLight::radiance, 0.0, 10.0, "W/(m^2 sr)"));
    static constexpr auto constants = describe(p("a", &TriangleLight::a, -1.0, 1.0, "m"),
                                               p("b", &TriangleLight::b, -1.0, 1.0, "m"),
                                               p("c", &TriangleLight::c, -1.0, 1.0, "m"));

    [[nodiscard]] LightFault fault() const {
        if (!(area() > R(0))) return {"a, b, c", "corners that span an area"};
        return {};
    }
    Vec3<R> L(const Vec3<R>& point, const Vec3<R>& w) const {
        return density(point, w) > R(0) ? radiance : Vec3<R>(R(0));
    }
    void L_backward(const Vec3<R>& point, const Vec3<R>& w, const Vec3<R>& d_L,
                    TriangleLight& d_self) const {
        if (density(point, w) > R(0)) d_self.radiance += d_L;
    }

    LightSample<R> sample(const Vec3<R>& point, const Vec2<R>& u2) const {
        const Vec2<R> q = square_to_triangle(u2);
        return sample_area_light((a - point) + q.x * (b - a) + q.y * (c - a), normal(),
                                 R(1) / area(), radiance);
    }
    R pdf(const Vec3<R>& point, const Vec3<R>& w) const { return density(point, w); }
    /// `pdf` of a direction that hits the front, at this distance and cosine.
    [[nodiscard]] R hit_pdf(const Vec3<R>&, R distance, R cosine) const {
        return solid_angle_density(R(1) / area(), distance * distance, cosine);
    }

    [[nodiscard]] R area() const { return R(0.5) * length(cross(b - a, c - a)); }
    [[nodiscard]] Vec3<R> normal() const { return normalize(cross(b - a, c - a)); }

private:
    [[nodiscard]] R density(const Vec3<R>& point, const Vec3<R>& w) const {
        const R cosine = -dot(w, normal());
        if (!(cosine > R(0))) return R(0);
        const TrianglePoint<R> at = triangle_point(Ray<R>{point, w}, a, b, c);
        const bool hit = at.t > R(0) && at.u >= R(0) && at.v >= R(0) && at.u + at.v <= R(1);
        return hit ? hit_pdf(point, at.t, cosine) : R(0);
    }
};

static_assert(AreaLight<TriangleLight>);

}  // namespace photograd
