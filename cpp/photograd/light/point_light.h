// A point light, isotropic.
//
//   irradiance of what faces it = intensity / r^2,    d/dintensity = 1 / r^2
//
// `position` moves shadows: no derivative is given. At r = 0 there is no direction, and pdf = 0.
#pragma once

#include "photograd/light/light.h"

namespace photograd {

template <class R>
struct PointLight {
    Vec3<R> intensity{R(1)};
    Vec3<R> position{R(0)};

    static constexpr const char* name = "point";
    static constexpr LightKind kind = LightKind::point;
    static constexpr auto params =
        describe(p("intensity", &PointLight::intensity, 0.0, 10.0, "W/sr"));
    static constexpr auto constants =
        describe(p("position", &PointLight::position, -1.0, 1.0, "m"));

    [[nodiscard]] LightFault fault() const { return {}; }
    LightSample<R> at(const Vec3<R>& point) const {
        const Vec3<R> to = position - point;
        const R r2 = dot(to, to);
        if (!(r2 > R(0))) return {};
        const R r = sqrt(r2);
        return {to * (R(1) / r), r, intensity * (R(1) / r2), R(1), true};
    }
    void at_backward(const Vec3<R>& point, const Vec3<R>& d_radiance, PointLight& d_self) const {
        const Vec3<R> to = position - point;
        const R r2 = dot(to, to);
        if (r2 > R(0)) d_self.intensity += d_radiance * (R(1) / r2);
    }
};

static_assert(DeltaLight<PointLight>);

}  // namespace photograd
