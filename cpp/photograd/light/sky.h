// A sky gradient: radiance by the height h = w.y of a direction alone, constant if its three colors
// are equal.
//
//   L(w) = (1 - h) horizon + h zenith     above the horizon
//   L(w) = (1 + h) horizon - h ground     below
#pragma once

#include "photograd/light/light.h"
#include "photograd/sampling/warp.h"

namespace photograd {

template <class R>
struct Sky {
    Vec3<R> zenith{R(1)}, horizon{R(1)}, ground{R(1)};

    static constexpr const char* name = "sky";
    static constexpr LightKind kind = LightKind::infinite;
    static constexpr auto params = describe(p("zenith", &Sky::zenith, 0.0, 10.0, "W/(m^2 sr)"),
                                            p("horizon", &Sky::horizon, 0.0, 10.0, "W/(m^2 sr)"),
                                            p("ground", &Sky::ground, 0.0, 10.0, "W/(m^2 sr)"));
    static constexpr auto constants = describe();

    Vec3<R> L(const Vec3<R>& w) const {
        const R up = w.y > R(0) ? w.y : R(0), down = w.y > R(0) ? R(0) : -w.y;
        return horizon * (R(1) - up - down) + zenith * up + ground * down;
    }
    void L_backward(const Vec3<R>& w, const Vec3<R>& d_L, Sky& d_self) const {
        const R up = w.y > R(0) ? w.y : R(0), down = w.y > R(0) ? R(0) : -w.y;
        d_self.horizon += d_L * (R(1) - up - down);
        d_self.zenith += d_L * up;
        d_self.ground += d_L * down;
    }

    /// Uniform over the sphere.
    Vec3<R> sample(const Vec2<R>& u2) const { return square_to_cap(u2, R(2)); }
    R pdf(const Vec3<R>&) const { return R(1 / (4 * pi)); }
};

static_assert(Light<Sky>);

}  // namespace photograd
