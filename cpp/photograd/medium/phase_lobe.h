// Sampling the angle by which a particle turns light.
//
// Henyey and Greenstein's density [Henyey1941] has an inverse in closed form. With s uniform in [-1, 1],
//
//   cos_theta = (1 + g^2 - ((1 - g^2) / (1 + g s))^2) / (2 g)
//             = (2 s + g (3 + s^2) + 2 g^2 s + g^3 (s^2 - 1)) / (2 (1 + g s)^2)
//
// The second form is the first with g divided out: it holds for g = 0 as well, where cos_theta = s. Other phase
// functions of this folder are close to that lobe, and are sampled by it: what they scatter is weighed with
// p(cos_theta) / p_HG(cos_theta), at most 3 / (2 + g^2) for Cornette and Shanks's.
#pragma once

#include "photograd/core/frame.h"
#include "photograd/medium/henyey_greenstein.h"

namespace photograd {

template <class R>
R henyey_greenstein_cosine(R g, R s) {
    const R below = R(1) + g * s;
    const R above = R(2) * s + g * (R(3) + s * s) + R(2) * g * g * s + g * g * g * (s * s - R(1));
    const R c = above / (R(2) * below * below);
    return c < R(-1) ? R(-1) : (c > R(1) ? R(1) : c);
}

/// A unit direction turned from `direction` by an angle of that density.
template <Real R>
Vec3<R> sample_lobe(R g, const Vec3<R>& direction, const Vec2<R>& u2) {
    const Vec2<R> p = square_to_disk(u2);  // |p|^2 is uniform, and so is p's angle
    const R u = p.x * p.x + p.y * p.y;
    const R c = henyey_greenstein_cosine(g, R(1) - R(2) * u);
    const R rest = R(1) - c * c;
    const R scale = rest > R(0) && u > R(0) ? sqrt(rest / u) : R(0);
    return Frame<R>::from_normal(direction).to_world({p.x * scale, p.y * scale, c});
}
template <class R>
R lobe_pdf(R g, R cos_theta) {
    return HenyeyGreenstein<R>{g}.p(cos_theta);
}

}  // namespace photograd
