// Cornette-Shanks phase function [Cornette1992]: Henyey-Greenstein times a factor that makes it
// Rayleigh scattering for very small particles (g = 0).
//
//   q = 1 + g^2 - 2 g c,   c = cos_theta
//   p = 3 (1 - g^2) (1 + c^2) / (8 pi (2 + g^2) q^(3/2))
//
//   dp/dg = p (-2 g / (1 - g^2) - 2 g / (2 + g^2) - 3 (g - c) / q)
//   dp/dc = p (2 c / (1 + c^2) + 3 g / q)
//
// g is not the mean cosine here, but close to it.
#pragma once

#include "photograd/medium/phase.h"
#include "photograd/sampling/warp.h"

namespace photograd {

template <class R>
struct CornetteShanks {
    R g{R(0)};

    static constexpr const char* name = "cornette_shanks";
    static constexpr auto params = describe(photograd::p("g", &CornetteShanks::g, -0.95, 0.95));

    R p(R cos_theta) const {
        const R q = R(1) + g * g - R(2) * g * cos_theta;
        return R(3 / (8 * pi)) * (R(1) - g * g) * (R(1) + cos_theta * cos_theta) /
               ((R(2) + g * g) * (q * sqrt(q)));
    }
    void p_backward(R cos_theta, R d_p, CornetteShanks& d_self, R& d_cos_theta) const {
        const R c = cos_theta, q = R(1) + g * g - R(2) * g * c, scale = d_p * p(c);
        d_self.g +=
            scale * (R(-2) * g / (R(1) - g * g) - R(2) * g / (R(2) + g * g) - R(3) * (g - c) / q);
        d_cos_theta += scale * (R(2) * c / (R(1) + c * c) + R(3) * g / q);
    }
};

static_assert(Phase<CornetteShanks>);

}  // namespace photograd
