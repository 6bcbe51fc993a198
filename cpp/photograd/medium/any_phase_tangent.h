// The directional derivative of a phase function along its parameters: forward mode, transpose of
// p_backward. `along` is a phase function of the same kind, which holds the change of each
// parameter.
#pragma once

#include "photograd/core/dual.h"
#include "photograd/medium/any_phase.h"

namespace photograd {

/// t(p), where the cosine changes by v_cos_theta; by default the angle is held.
inline double phase_tangent(const AnyPhase<double>& phase, const AnyPhase<double>& along,
                            double cos_theta, double v_cos_theta = 0) {
    using D = Dual<double>;
    double value[8], change[8], found = 0;
    Phases::for_each([&]<template <class> class M>() {
        const M<double>* model = std::get_if<M<double>>(&phase.model);
        if (model == nullptr) return;
        std::size_t i = 0, j = 0, k = 0;
        for_each_scalar([&](const double& x) { value[i++] = x; }, *model);
        for_each_scalar([&](const double& x) { change[j++] = x; },
                        std::get<M<double>>(along.model));
        M<D> dual;
        for_each_scalar(
            [&](D& x) {
                x = D(value[k], change[k]);
                ++k;
            },
            dual);
        found = dual.p(D(cos_theta, v_cos_theta)).tangent;
    });
    return found;
}

}  // namespace photograd
