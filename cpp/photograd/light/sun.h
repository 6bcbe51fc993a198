// The sun: a disc of constant radiance at infinity, with soft shadows.
//
//   L(w) = radiance  where w is within the angular radius of the sun's direction
//   dL/dradiance = 1 there, 0 elsewhere
// Direction and size move an edge of the integrand; L has no derivative there and none is given.
#pragma once

#include "photograd/core/frame.h"
#include "photograd/light/light.h"
#include "photograd/sampling/warp.h"

namespace photograd {

template <class R>
struct Sun {
    Vec3<R> radiance{R(1)};
    Vec3<R> direction{R(0), R(1), R(0)};  // unit, towards the sun
    R height{R(1.08e-5)};                 // 1 - cos(angular radius) of the disc

    static constexpr const char* name = "sun";
    static constexpr LightKind kind = LightKind::infinite;
    static constexpr auto params =
        describe(p("radiance", &Sun::radiance, 0.0, 100.0, "W/(m^2 sr)"));
    static constexpr auto constants =
        describe(p("direction", &Sun::direction, -1.0, 1.0), p("height", &Sun::height, 1e-6, 1.0));

    [[nodiscard]] bool contains(const Vec3<R>& w) const { return in_cap(w, direction, height); }
    Vec3<R> L(const Vec3<R>& w) const { return radiance * (contains(w) ? R(1) : R(0)); }
    void L_backward(const Vec3<R>& w, const Vec3<R>& d_L, Sun& d_self) const {
        d_self.radiance += d_L * (contains(w) ? R(1) : R(0));
    }

    Vec3<R> sample(const Vec2<R>& u2) const {
        return Frame<R>::from_normal(direction).to_world(square_to_cap(u2, height));
    }
    R pdf(const Vec3<R>& w) const { return contains(w) ? R(1 / (2 * pi)) / height : R(0); }
};

static_assert(Light<Sun>);

}  // namespace photograd
