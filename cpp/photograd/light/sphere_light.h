// A spherical area light, sampled uniformly in the cone of directions that hit it.
//
//   sin^2(a) = radius^2 / d^2 for the angle a of the cone, d = distance of the center
//   height of the cone's cap = 1 - cos(a) = sin^2(a) / (1 + cos(a))
//       nothing cancels for balls far away
//   density = 1 / (2 pi height)
//   L(point, w) = radiance in the cone, 0 outside;    dL/dradiance = 1 in the cone
#pragma once

#include "photograd/core/frame.h"
#include "photograd/light/light.h"
#include "photograd/sampling/warp.h"

namespace photograd {

template <class R>
struct SphereLight {
    Vec3<R> radiance{R(1)};
    Vec3<R> center{R(0)};
    R radius{R(1)};

    static constexpr const char* name = "sphere";
    static constexpr LightKind kind = LightKind::area;
    static constexpr auto params =
        describe(p("radiance", &SphereLight::radiance, 0.0, 10.0, "W/(m^2 sr)"));
    static constexpr auto constants = describe(p("center", &SphereLight::center, -1.0, 1.0, "m"),
                                               p("radius", &SphereLight::radius, 0.01, 1.0, "m"));

    [[nodiscard]] LightFault fault() const {
        if (!(radius > R(0))) return {"radius", "a positive number"};
        return {};
    }
    Vec3<R> L(const Vec3<R>& point, const Vec3<R>& w) const {
        const Cone cone = cone_from(point);
        return cone.height > R(0) && in_cap(w, cone.axis, cone.height) ? radiance : Vec3<R>(R(0));
    }
    void L_backward(const Vec3<R>& point, const Vec3<R>& w, const Vec3<R>& d_L,
                    SphereLight& d_self) const {
        const Cone cone = cone_from(point);
        if (cone.height > R(0) && in_cap(w, cone.axis, cone.height)) d_self.radiance += d_L;
    }

    /// A ray at the angle b to the axis meets the near side at t = d cos(b) - sqrt(radius^2 - d^2
    /// sin^2(b)), here as the product of both meetings, d^2 - radius^2, over the far one.
    LightSample<R> sample(const Vec3<R>& point, const Vec2<R>& u2) const {
        const Cone cone = cone_from(point);
        if (!(cone.height > R(0))) return {};
        const Vec3<R> local = square_to_cap(u2, cone.height);
        const R d = cone.distance, side = d * d * (local.x * local.x + local.y * local.y);
        const R inside = radius * radius - side;
        const R far = d * local.z + (inside > R(0) ? sqrt(inside) : R(0));
        return {Frame<R>::from_normal(cone.axis).to_world(local), (d - radius) * (d + radius) / far,
                radiance, R(1 / (2 * pi)) / cone.height, false};
    }
    R pdf(const Vec3<R>& point, const Vec3<R>& w) const {
        const Cone cone = cone_from(point);
        const bool in_cone = cone.height > R(0) && in_cap(w, cone.axis, cone.height);
        return in_cone ? R(1 / (2 * pi)) / cone.height : R(0);
    }
    /// `pdf` of a direction that hits the sphere; at its rim `pdf` may round to a miss.
    [[nodiscard]] R hit_pdf(const Vec3<R>& point, R, R) const {
        const Cone cone = cone_from(point);
        return cone.height > R(0) ? R(1 / (2 * pi)) / cone.height : R(0);
    }

private:
    struct Cone {
        Vec3<R> axis;
        R distance, height;  // height 0: the point is not outside of the ball
    };
    [[nodiscard]] Cone cone_from(const Vec3<R>& point) const {
        const Vec3<R> to = center - point;
        const R d2 = dot(to, to), sin2 = radius * radius / d2;
        if (!(sin2 < R(1))) return {to, R(0), R(0)};
        const R d = sqrt(d2);
        return {to * (R(1) / d), d, sin2 / (R(1) + sqrt(R(1) - sin2))};
    }
};

static_assert(AreaLight<SphereLight>);

}  // namespace photograd
