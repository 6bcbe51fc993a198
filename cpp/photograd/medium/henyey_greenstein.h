// Henyey and Greenstein's phase function [Henyey1941], one number for all shapes of haze and dust.
//
//   q = 1 + g^2 - 2 g c,   c = cos_theta            squared length of a triangle's side, never zero for |g| < 1
//   p = (1 - g^2) / (4 pi q^(3/2))
//
//   dp/dg = (-2 g q - 3 (1 - g^2) (g - c)) / (4 pi q^(5/2))
//   dp/dc = 3 g (1 - g^2) / (4 pi q^(5/2))
//
// g is the mean cosine: 0 scatters evenly, towards 1 ever more forward, below 0 back to the light.
#pragma once

#include "photograd/medium/phase.h"
#include "photograd/sampling/warp.h"

namespace photograd {

template <class R>
struct HenyeyGreenstein {
    R g{R(0)};

    static constexpr const char* name = "henyey_greenstein";
    static constexpr auto params = describe(photograd::p("g", &HenyeyGreenstein::g, -0.95, 0.95));

    R p(R cos_theta) const {
        const R q = R(1) + g * g - R(2) * g * cos_theta;
        return R(1 / (4 * pi)) * (R(1) - g * g) / (q * sqrt(q));
    }
    void p_backward(R cos_theta, R d_p, HenyeyGreenstein& d_self, R& d_cos_theta) const {
        const R q = R(1) + g * g - R(2) * g * cos_theta, rest = R(1) - g * g;
        const R scale = d_p * R(1 / (4 * pi)) / (q * q * sqrt(q));
        d_self.g += scale * (R(-2) * g * q - R(3) * rest * (g - cos_theta));
        d_cos_theta += scale * (R(3) * g * rest);
    }
};

static_assert(Phase<HenyeyGreenstein>);

}  // namespace photograd
