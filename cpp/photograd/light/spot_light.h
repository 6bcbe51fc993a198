// A spot light: a point light that is full along its axis and falls off to zero at a cone.
//
//   irradiance of what faces it = intensity s(t) / r^2
//   c = <axis, from the light to the point>,   t = (c - cos_outer) / (softness (1 - cos_outer)),
//       in [0, 1]
//   s(t) = t^2 (3 - 2 t)
//
// softness is the part of the cone over which light fades: close to 0 an edge, at 1 all the way
// from the axis. Light fades with s' = 0 at both ends, so the derivatives with respect to the shape
// of the cone have no jumps; as long as shadows do not move they are the whole derivative.
//
//   s'(t) = 6 t (1 - t)
//   dt/dcos_outer = (c - 1) / (softness (1 - cos_outer)^2),    dt/dsoftness = -t / softness
//
// `position` and `axis` move the cone over edges of the scene: no derivative is given.
#pragma once

#include "photograd/light/light.h"

namespace photograd {

template <class R>
struct SpotLight {
    Vec3<R> intensity{R(1)};
    R cos_outer{R(0.5)}, softness{R(0.3)};
    Vec3<R> position{R(0)};
    Vec3<R> axis{R(0), R(-1), R(0)};  // unit, the way the light shines

    static constexpr const char* name = "spot";
    static constexpr LightKind kind = LightKind::spot;
    static constexpr auto params =
        describe(p("intensity", &SpotLight::intensity, 0.0, 10.0, "W/sr"),
                 p("cos_outer", &SpotLight::cos_outer, -0.9, 0.95),
                 p("softness", &SpotLight::softness, 0.05, 1.0));
    static constexpr auto constants = describe(p("position", &SpotLight::position, -1.0, 1.0, "m"),
                                               p("axis", &SpotLight::axis, -1.0, 1.0));

    [[nodiscard]] LightFault fault() const {
        if (!(cos_outer >= R(-1)) || !(cos_outer < R(1)))
            return {"cos_outer", "a cosine in [-1, 1)"};
        if (!(softness > R(0)) || !(softness <= R(1))) return {"softness", "a number in (0, 1]"};
        return unit_vector_fault("axis", axis);
    }
    LightSample<R> at(const Vec3<R>& point) const {
        const Fall fall = fall_at(point);
        if (!(fall.r2 > R(0))) return {};
        const R scale = smoothstep(fall.t) / fall.r2;
        return {-fall.away, sqrt(fall.r2), intensity * scale, R(scale > R(0) ? 1 : 0), true};
    }
    void at_backward(const Vec3<R>& point, const Vec3<R>& d_radiance, SpotLight& d_self) const {
        const Fall fall = fall_at(point);
        if (!(fall.r2 > R(0))) return;
        const R share = R(1) / fall.r2, t = fall.t;
        d_self.intensity += d_radiance * (smoothstep(t) * share);
        const R d_t = dot(d_radiance, intensity) * (R(6) * t * (R(1) - t) * share);
        const R rest = R(1) - cos_outer;
        d_self.cos_outer += d_t * (fall.c - R(1)) / (softness * rest * rest);
        d_self.softness -= d_t * t / softness;
    }

private:
    struct Fall {
        R r2, c, t;
        Vec3<R> away;  // from the light to the point
    };
    static R smoothstep(R t) { return t * t * (R(3) - R(2) * t); }
    [[nodiscard]] Fall fall_at(const Vec3<R>& point) const {
        const Vec3<R> apart = point - position;
        const R r2 = dot(apart, apart);
        if (!(r2 > R(0))) return {R(0), R(0), R(0), apart};
        const Vec3<R> away = apart * (R(1) / sqrt(r2));
        const R c = dot(axis, away);
        return {r2, c, clamped((c - cos_outer) / (softness * (R(1) - cos_outer)), R(0), R(1)),
                away};
    }
};

static_assert(DeltaLight<SpotLight>);

}  // namespace photograd
