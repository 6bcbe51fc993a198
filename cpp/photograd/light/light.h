// What every light at infinity says about itself: the radiance that arrives from a direction of the world.
#pragma once

#include <concepts>

#include "photograd/core/params.h"
#include "photograd/core/real.h"

namespace photograd {

/// A light T = M<R>. `L(w)` is the radiance seen when looking along w (towards the light); `L_backward` adds
/// dL/dparameter to its last argument. `constants` are described like parameters but not differentiated.
template <class T, class R>
concept LightValue = requires(const T& light, T& d_light, const Vec3<R>& w) {
    { T::name } -> std::convertible_to<const char*>;
    T::params;
    T::constants;
    { light.L(w) } -> std::same_as<Vec3<R>>;
    { light.L_backward(w, w, d_light) } -> std::same_as<void>;
};

/// `sample(u2)` returns a direction towards the light, `pdf` its density over solid angle.
template <class T, class R>
concept LightSampler = requires(const T& light, const Vec3<R>& w, const Vec2<R>& u2) {
    { light.sample(u2) } -> std::same_as<Vec3<R>>;
    { light.pdf(w) } -> std::same_as<R>;
};

template <template <class> class M>
concept Light = LightValue<M<double>, double> && LightValue<M<Dual<double>>, Dual<double>> &&
                LightSampler<M<double>, double> && LightSampler<M<float>, float>;

}  // namespace photograd
