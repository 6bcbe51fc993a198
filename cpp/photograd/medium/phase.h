// The interface of phase functions: how a medium scatters light over directions.
//
// p(cos_theta) is a density over solid angle, in 1/sr, that integrates to 1 over the sphere. theta
// is the scattering angle: cos_theta = 1 goes straight on. With wi towards the light
// and wo towards the viewer, both leaving the particle, cos_theta = -<wo, wi>.
#pragma once

#include <concepts>

#include "photograd/core/params.h"
#include "photograd/core/real.h"

namespace photograd {

/// A phase function T = M<R>. `p_backward` adds dL/dparameter and dL/dcos_theta to its last two
/// arguments.
template <class T, class R>
concept PhaseValue = requires(const T& phase, T& d_phase, R cos_theta, R& d_cos_theta) {
    { T::name } -> std::convertible_to<const char*>;
    T::params;
    { phase.p(cos_theta) } -> std::same_as<R>;
    { phase.p_backward(cos_theta, cos_theta, d_phase, d_cos_theta) } -> std::same_as<void>;
};

template <template <class> class M>
concept Phase = PhaseValue<M<float>, float> && PhaseValue<M<double>, double> &&
                PhaseValue<M<Dual<double>>, Dual<double>>;

}  // namespace photograd
