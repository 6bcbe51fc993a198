// The interface of reflectance models (BSDFs). Shading frame: the normal is +Z, wo points to the
// viewer and wi to the light, both away from the surface; f(wo, wi) does not contain the cosine.
#pragma once

#include <concepts>

#include "photograd/core/params.h"
#include "photograd/core/real.h"

namespace photograd {

/// Bound on the directional albedo over the whole range of parameters:
/// `conserving` at most 1, and 1 is reached; `lossy` stays below 1; `gains` up to `most`, where a
/// model is not energy-conserving.
enum class Energy : int { conserving = 0, lossy = 1, gains = 2 };

struct EnergyClaim {
    Energy kind;
    double most;  // bound on the directional albedo that tests hold the model to
};

/// A model T = M<R>. `f_backward` adds dL/dparameter to its last argument, which is a T as well.
template <class T, class R>
concept BsdfValue = requires(const T& model, T& d_model, const Vec3<R>& w) {
    { T::name } -> std::convertible_to<const char*>;
    { T::energy } -> std::convertible_to<EnergyClaim>;
    { T::reciprocal } -> std::convertible_to<bool>;
    T::params;
    { model.f(w, w) } -> std::same_as<Vec3<R>>;
    { model.f_backward(w, w, w, d_model) } -> std::same_as<void>;
};

/// Models that let light through say `transmits`, and by `index_inside()` the refractive index
/// inside over outside of each channel, 1 for a sheet with the same on both sides: their wo and wi
/// may lie on either side. All others are 0 unless both are above.
template <class T>
constexpr bool transmits() {
    if constexpr (requires { T::transmits; })
        return T::transmits;
    else
        return false;
}

/// Sampling is detached: it needs no Dual numbers. `sample(wo, u2)` returns wi, `pdf` its density.
template <class T, class R>
concept BsdfSampler = requires(const T& model, const Vec3<R>& w, const Vec2<R>& u2) {
    { model.sample(w, u2) } -> std::same_as<Vec3<R>>;
    { model.pdf(w, w) } -> std::same_as<R>;
};

template <class T, class R>
concept KnowsItsInside = !transmits<T>() || requires(const T& model) {
    { model.index_inside() } -> std::same_as<Vec3<R>>;
};

template <template <class> class M>
concept Bsdf = BsdfValue<M<double>, double> && BsdfValue<M<Dual<double>>, Dual<double>> &&
               BsdfSampler<M<double>, double> && BsdfSampler<M<float>, float> &&
               KnowsItsInside<M<double>, double>;

}  // namespace photograd
