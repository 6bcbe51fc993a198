// A participating medium: particles that absorb light and, with a phase function, scatter it.
//
//   sigma_t   extinction coefficient, 1/m                           sigma_t = sigma_a + sigma_s
//   albedo    sigma_s / sigma_t, the share of it that scatters, 0 to 1
//
// each for three channels. Along a straight line through a homogeneous medium [Chandrasekhar1960]
//
//   T(t) = exp(-sigma_t t),      dT/dsigma_t = -t T
//
// A medium with a density grid has sigma_t times the density at each point, a pure number.
#pragma once

#include <optional>

#include "photograd/medium/any_phase.h"
#include "photograd/medium/density_grid.h"

namespace photograd {

template <Real R>
struct Medium {
    Vec3<R> sigma_t{R(0)}, albedo{R(0)};
    std::optional<AnyPhase<R>> phase;  // none: it only absorbs, and has no albedo
    const R* density = nullptr;        // values (X, Y, Z) of its grid; null: 1 everywhere
    R sigma_maj = R(0);                // of a medium with a grid: above sigma_t everywhere, 1/m

    /// sigma_t, then albedo and the phase function's parameters if it scatters.
    template <class Visit>
    void for_each(Visit&& visit) {
        for (int c = 0; c < 3; ++c) visit(sigma_t[c]);
        if (!phase) return;
        for (int c = 0; c < 3; ++c) visit(albedo[c]);
        phase->for_each(visit);
    }
    [[nodiscard]] int parameter_count() const { return phase ? 6 + phase->parameter_count() : 3; }
    /// This medium with all numbers 0, as an accumulator of derivatives.
    [[nodiscard]] Medium zero() const {
        Medium copy = *this;
        copy.for_each([](R& x) { x = R(0); });
        return copy;
    }
};

template <class R>
Vec3<R> transmittance(const Vec3<R>& sigma_t, R length) {
    return {exp(-sigma_t.x * length), exp(-sigma_t.y * length), exp(-sigma_t.z * length)};
}

}  // namespace photograd
