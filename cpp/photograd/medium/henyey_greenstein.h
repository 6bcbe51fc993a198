// Henyey-Greenstein phase function [Henyey1941], of one parameter.
//
//   q = 1 + g^2 - 2 g c,   c = cos_theta
//       squared length of a triangle's side, never zero for |g| < 1
//   p = (1 - g^2) / (4 pi q^(3/2))
//
//   dp/dg = (-2 g q - 3 (1 - g^2) (g - c)) / (4 pi q^(5/2))
//   dp/dc = 3 g (1 - g^2) / (4 pi q^(5/2))
//
// g is the mean cosine: 0 is isotropic, towards 1 light goes ever more forward, below 0 back.
//
// Sampling inverts it in closed form. With s uniform in [-1, 1],
//
//   cos_theta = (1 + g^2 - ((1 - g^2) / (1 + g s))^2) / (2 g)
//             = (2 s + g (3 + s^2) + 2 g^2 s + g^3 (s^2 - 1)) / (2 (1 + g s)^2)
//
// The second form is the first with g divided out: it holds for g = 0 as well, where cos_theta = s.
// Other phase functions of this folder are close to this one and are sampled by it: what they
// scatter is weighed with p(cos_theta) / p_HG(cos_theta), at most 3 / (2 + g^2) for Cornette and
// Shanks's.
#pragma once

#include "photograd/core/frame.h"
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

template <class R>
R henyey_greenstein_cosine(R g, R s) {
    const R below = R(1) + g * s;
    const R above = R(2) * s + g * (R(3) + s * s) + R(2) * g * g * s + g * g * g * (s * s - R(1));
    const R c = above / (R(2) * below * below);
    return c < R(-1) ? R(-1) : (c > R(1) ? R(1) : c);
}

/// A unit direction turned from `direction` by an angle of that density.
template <Real R>
Vec3<R> sample_henyey_greenstein(R g, const Vec3<R>& direction, const Vec2<R>& u2) {
    const Vec2<R> p = square_to_disk(u2);  // |p|^2 is uniform, and so is p's angle
    const R u = p.x * p.x + p.y * p.y;
    const R c = henyey_greenstein_cosine(g, R(1) - R(2) * u);
    const R rest = R(1) - c * c;
    const R scale = rest > R(0) && u > R(0) ? sqrt(rest / u) : R(0);
    return Frame<R>::from_normal(direction).to_world({p.x * scale, p.y * scale, c});
}
template <class R>
R henyey_greenstein_pdf(R g, R cos_theta) {
    return HenyeyGreenstein<R>{g}.p(cos_theta);
}

}  // namespace photograd
