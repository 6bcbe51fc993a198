// The interface of specular BSDFs. f is a delta function: no density, nothing to evaluate for a
// given wi, and a weight of 1 in multiple importance sampling. The model lists its directions
// instead:
//
//   L(wo) = sum_k weight_k L(wi_k)        the cosine and the delta function are in the weight
//
// Shading frame as in bsdf.h, but wo may lie on either side.
#pragma once

#include <array>
#include <concepts>

#include "photograd/core/params.h"
#include "photograd/core/real.h"

namespace photograd {

/// A lobe that does not exist (total reflection) has weight 0 and wi = 0.
template <class R>
struct DeltaLobe {
    Vec3<R> wi{R(0)}, weight{R(0)};
};

/// A model T = M<R>. `lobes_backward` takes dL/dwi and dL/dweight and adds dL/dparameter to its
/// last argument.
template <class T, class R>
concept DeltaValue = requires(const T& model, T& d_model, const Vec3<R>& wo,
                              const std::array<DeltaLobe<R>, T::lobe_count>& d_lobes) {
    { T::name } -> std::convertible_to<const char*>;
    T::params;
    { model.lobes(wo) } -> std::same_as<std::array<DeltaLobe<R>, T::lobe_count>>;
    { model.lobes_backward(wo, d_lobes, d_model) } -> std::same_as<void>;
};

template <template <class> class M>
concept DeltaBsdf = DeltaValue<M<float>, float> && DeltaValue<M<double>, double> &&
                    DeltaValue<M<Dual<double>>, Dual<double>>;

}  // namespace photograd
