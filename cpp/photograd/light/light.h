// The interface of lights. There are three families:
//
//   at infinity   Light       sky, sun, environment map: radiance depends on the direction alone
//   delta         DeltaLight  point, spot, directional: reaches a point from one direction, and no
//                             ray ever hits it
//   area          AreaLight   rectangle, sphere, triangle: a surface that emits on the side of its
//                             normal
//
// sample_light.h gives all of them one interface. Points and directions are of the world; w leaves
// the lit point.
#pragma once

#include <concepts>
#include <limits>

#include "photograd/core/params.h"
#include "photograd/core/real.h"

namespace photograd {

enum class LightKind : int { infinite, environment, point, spot, directional, area };

/// One direction at each point: a light that no ray hits, of weight 1 in multiple importance
/// sampling.
constexpr bool is_delta(LightKind kind) {
    return kind == LightKind::point || kind == LightKind::spot || kind == LightKind::directional;
}

/// A sample of the light at a point, one direction of density `pdf`, before occlusion. The estimate
/// of reflected light is f(wo, wi) cos radiance / pdf; pdf = 0 if no light arrives.
template <class R>
struct LightSample {
    Vec3<R> direction{R(0)};  // unit, towards the light
    R distance{R(0)};         // to the light, m; infinite for lights at infinity
    Vec3<R> radiance{
        R(0)};  // W/(m^2 sr); of a delta light its integral, the irradiance of what faces it, W/m^2
    R pdf{R(0)};  // over solid angle, 1/sr; 1 for delta lights, whose one direction is certain
    bool is_delta =
        false;  // no other strategy finds this light: weight 1 in multiple importance sampling
};

/// Radiance of the lights at infinity in one direction, and its sampling density, 1/sr.
template <class R>
struct Background {
    Vec3<R> radiance{R(0)};
    R pdf = R(0);
};

/// A fault of a light's numbers; a null `argument` if there is none.
struct LightFault {
    const char* argument = nullptr;
    const char* expected = nullptr;
};

/// Directions must be of unit length, to rounding in float.
template <class R>
LightFault unit_vector_fault(const char* argument, const Vec3<R>& w) {
    const R gap = dot(w, w) - R(1);
    return gap * gap <= R(1e-8) ? LightFault{} : LightFault{argument, "a vector of unit length"};
}

template <class R>
constexpr R infinitely_far() {
    return R(std::numeric_limits<double>::infinity());
}

/// A light at infinity T = M<R>. `L(w)` is the radiance seen when looking along w (towards the
/// light); `L_backward` adds dL/dparameter to its last argument. `constants` are described like
/// parameters but not differentiated.
template <class T, class R>
concept LightValue = requires(const T& light, T& d_light, const Vec3<R>& w) {
    { T::name } -> std::convertible_to<const char*>;
    { T::kind } -> std::convertible_to<LightKind>;
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

/// `at(point)` is the one sample there is; `at_backward` adds dL/dparameter for dL/d(its radiance).
template <class T, class R>
concept DeltaLightValue = requires(const T& light, T& d_light, const Vec3<R>& v) {
    { T::name } -> std::convertible_to<const char*>;
    { T::kind } -> std::convertible_to<LightKind>;
    T::params;
    T::constants;
    { light.fault() } -> std::same_as<LightFault>;
    { light.at(v) } -> std::same_as<LightSample<R>>;
    { light.at_backward(v, v, d_light) } -> std::same_as<void>;
};

/// `L(point, w)` is what arrives at a point from w, if nothing else is in between; `radiance` is
/// what the surface emits, the same everywhere.
template <class T, class R>
concept AreaLightValue = requires(const T& light, T& d_light, const Vec3<R>& v) {
    { T::name } -> std::convertible_to<const char*>;
    { T::kind } -> std::convertible_to<LightKind>;
    T::params;
    { light.radiance } -> std::convertible_to<Vec3<R>>;
    { light.fault() } -> std::same_as<LightFault>;
    { light.L(v, v) } -> std::same_as<Vec3<R>>;
    { light.L_backward(v, v, v, d_light) } -> std::same_as<void>;
};

template <class T, class R>
concept AreaLightSampler = requires(const T& light, const Vec3<R>& v, const Vec2<R>& u2) {
    { light.sample(v, u2) } -> std::same_as<LightSample<R>>;
    { light.pdf(v, v) } -> std::same_as<R>;
};

template <template <class> class M>
concept DeltaLight = DeltaLightValue<M<float>, float> && DeltaLightValue<M<double>, double> &&
                     DeltaLightValue<M<Dual<double>>, Dual<double>>;

template <template <class> class M>
concept AreaLight =
    AreaLightValue<M<double>, double> && AreaLightValue<M<Dual<double>>, Dual<double>> &&
    AreaLightSampler<M<double>, double> && AreaLightSampler<M<float>, float>;

}  // namespace photograd
