// A constant environment: equal radiance from all directions.
//
//   L(w) = radiance,    dL/dradiance = 1
#pragma once

#include "photograd/light/light.h"
#include "photograd/sampling/warp.h"

namespace photograd {

template <class R>
struct ConstantLight {
    Vec3<R> radiance{R(1)};

    static constexpr const char* name = "constant";
    static constexpr LightKind kind = LightKind::infinite;
    static constexpr auto params =
        describe(p("radiance", &ConstantLight::radiance, 0.0, 10.0, "W/(m^2 sr)"));
    static constexpr auto constants = describe();

    Vec3<R> L(const Vec3<R>&) const { return radiance; }
    void L_backward(const Vec3<R>&, const Vec3<R>& d_L, ConstantLight& d_self) const {
        d_self.radiance += d_L;
    }

    Vec3<R> sample(const Vec2<R>& u2) const { return square_to_cap(u2, R(2)); }
    R pdf(const Vec3<R>&) const { return R(1 / (4 * pi)); }
};

static_assert(Light<ConstantLight>);

}  // namespace photograd
