// Any light without a surface, for lists of lights of different kinds.
//
// The set is closed (registry.h and the environment map), so an entry is a variant over it, not a
// base class. Its functions are those of sample_light.h; lights with a surface are shapes of the
// scene that emit instead, since rays have to hit them.
#pragma once

#include <variant>
#include <vector>

#include "photograd/light/environment.h"
#include "photograd/light/registry.h"
#include "photograd/light/sample_light.h"

namespace photograd {

/// Derivatives with respect to a map's texels, not yet added up: texels are many and a path meets
/// few of them, so that they are scattered by their owners later (environment_gradient.h).
template <class R>
struct DirectionAdjoint {
    std::vector<R> w, d_L;  // (N, 3) each
};

namespace detail {
template <class R, class Map, class AtInfinity, class Delta>
struct LightVariantOf;
template <class R, class Map, template <class> class... AtInfinity, template <class> class... Delta>
struct LightVariantOf<R, Map, ModelList<AtInfinity...>, ModelList<Delta...>> {
    using type = std::variant<AtInfinity<R>..., Delta<R>..., Map>;
};
}  // namespace detail

template <class R>
struct AnyLight {
    typename detail::LightVariantOf<R, Environment<R>, Lights, DeltaLights>::type model;
};
/// Accumulator of the derivatives of an AnyLight.
template <class R>
struct AnyLightGradient {
    typename detail::LightVariantOf<R, DirectionAdjoint<R>, Lights, DeltaLights>::type model;
};

template <class R>
bool is_delta(const AnyLight<R>& any) {
    return std::visit([]<class L>(const L&) { return is_delta(L::kind); }, any.model);
}

/// The gradient of this light, 0.
template <class R>
AnyLightGradient<R> zero_gradient(const AnyLight<R>& any) {
    return std::visit(
        []<class L>(const L&) -> AnyLightGradient<R> {
            if constexpr (L::kind != LightKind::environment) {
                L light;
                for_each_scalar([](R& x) { x = R(0); }, light);
                return {light};
            } else {
                return {DirectionAdjoint<R>{}};
            }
        },
        any.model);
}

/// Radiance from the direction w and its sampling density; none from delta lights.
template <class R>
Background<R> background(const AnyLight<R>& any, const Vec3<R>& w) {
    return std::visit(
        [&]<class L>(const L& light) -> Background<R> {
            if constexpr (L::kind == LightKind::environment)
                return light.L_and_pdf(w);
            else
                return {light_radiance(light, Vec3<R>(R(0)), w),
                        light_pdf(light, Vec3<R>(R(0)), w)};
        },
        any.model);
}
/// Adds the derivative of <d_L, radiance of background>.
template <class R>
void background_backward(const AnyLight<R>& any, const Vec3<R>& w, const Vec3<R>& d_L,
                         AnyLightGradient<R>& d_any) {
    std::visit(
        [&]<class L>(const L& light) {
            if constexpr (L::kind != LightKind::environment) {
                light_radiance_backward(light, Vec3<R>(R(0)), w, d_L, std::get<L>(d_any.model));
            } else {
                auto& lookups = std::get<DirectionAdjoint<R>>(d_any.model);
                for (int k = 0; k < 3; ++k) {
                    lookups.w.push_back(w[k]);
                    lookups.d_L.push_back(d_L[k]);
                }
            }
        },
        any.model);
}
/// A direction in which a point is lit; u2 is not used by delta lights, the point not by others.
template <class R>
LightSample<R> sample_any(const AnyLight<R>& any, const Vec3<R>& point, const Vec2<R>& u2) {
    return std::visit([&](const auto& light) { return sample_light(light, point, u2); }, any.model);
}
/// Adds the derivative of <d_radiance, radiance of a delta light's sample>.
template <class R>
void delta_backward(const AnyLight<R>& any, const Vec3<R>& point, const Vec3<R>& d_radiance,
                    AnyLightGradient<R>& d_any) {
    std::visit(
        [&]<class L>(const L& light) {
            if constexpr (is_delta(L::kind))
                light.at_backward(point, d_radiance, std::get<L>(d_any.model));
        },
        any.model);
}

}  // namespace photograd
