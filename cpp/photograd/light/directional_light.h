// A directional light: parallel light from one direction, equal at every point.
//
//   irradiance of what faces it = irradiance,    d/dirradiance = 1
//
// The cosine at a tilted surface is not included. `direction` moves shadows: no derivative is
// given.
#pragma once

#include "photograd/light/light.h"

namespace photograd {

template <class R>
struct DirectionalLight {
    Vec3<R> irradiance{R(1)};
    Vec3<R> direction{R(0), R(1), R(0)};  // unit, towards the light

    static constexpr const char* name = "directional";
    static constexpr LightKind kind = LightKind::directional;
    static constexpr auto params =
        describe(p("irradiance", &DirectionalLight::irradiance, 0.0, 10.0, "W/m^2"));
    static constexpr auto constants =
        describe(p("direction", &DirectionalLight::direction, -1.0, 1.0));

    [[nodiscard]] LightFault fault() const { return unit_vector_fault("direction", direction); }
    LightSample<R> at(const Vec3<R>&) const {
        return {direction, infinitely_far<R>(), irradiance, R(1), true};
    }
    void at_backward(const Vec3<R>&, const Vec3<R>& d_radiance, DirectionalLight& d_self) const {
        d_self.irradiance += d_radiance;
    }
};

static_assert(DeltaLight<DirectionalLight>);

}  // namespace photograd
