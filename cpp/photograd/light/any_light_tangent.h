// The directional derivative of a light's radiance along a direction of its parameters: forward
// mode, the transpose of background_backward and delta_backward. `along` is a light of the same
// kind, which holds the change of each parameter; a map's holds that of each texel.
#pragma once

#include "photograd/light/any_light.h"

namespace photograd {

/// t(use(light)), where the light's parameters are dual numbers and its constants are not.
template <class R, class Use>
Vec3<R> light_tangent(const AnyLight<R>& any, const AnyLight<R>& along, Use&& use) {
    using D = Dual<R>;
    Vec3<D> out(D(0.0));
    const auto look = [&]<template <class> class M>() {
        const M<R>* light = std::get_if<M<R>>(&any.model);
        if (light == nullptr) return;
        const M<R>& change = std::get<M<R>>(along.model);
        M<D> dual;
        const auto lift = [](const auto& from, const auto& v, const auto& to, const M<R>& value,
                             const M<R>& tangent, M<D>& lifted) {
            R values[16], tangents[16] = {};
            std::size_t i = 0, k = 0;
            for_each_scalar(from, [&](const R& x) { values[i++] = x; }, value);
            i = 0;
            for_each_scalar(v, [&](const R& x) { tangents[i++] = x; }, tangent);
            for_each_scalar(
                to,
                [&](D& x) {
                    x = D(values[k], tangents[k]);
                    ++k;
                },
                lifted);
        };
        lift(M<R>::params, M<R>::params, M<D>::params, *light, change, dual);
        lift(M<R>::constants, describe(), M<D>::constants, *light, change, dual);
        out = use(dual);
    };
    Lights::for_each(look);
    DeltaLights::for_each(look);
    return {out.x.tangent, out.y.tangent, out.z.tangent};
}

/// Of a light at infinity, in the direction w. A map's radiance is linear in its texels.
template <class R>
Vec3<R> background_tangent(const AnyLight<R>& any, const AnyLight<R>& along, const Vec3<R>& w) {
    using D = Dual<R>;
    if (const auto* map = std::get_if<Environment<R>>(&along.model)) return map->L(w);
    const Vec3<D> origin(D(0.0)), direction(D(w.x), D(w.y), D(w.z));
    return light_tangent(
        any, along, [&](const auto& light) { return light_radiance(light, origin, direction); });
}

/// Of a delta light's sample at a point.
template <class R>
Vec3<R> delta_tangent(const AnyLight<R>& any, const AnyLight<R>& along, const Vec3<R>& point) {
    using D = Dual<R>;
    const Vec3<D> at(D(point.x), D(point.y), D(point.z));
    return light_tangent(any, along, [&]<class L>(const L& light) {
        if constexpr (is_delta(L::kind))
            return light.at(at).radiance;
        else
            return Vec3<D>(D(0.0));
    });
}

}  // namespace photograd
