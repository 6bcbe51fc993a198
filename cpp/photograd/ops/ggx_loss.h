// The light that a mirror of GGX facets loses: under Smith's masking, what meets a second facet is
// dropped. Computed by quadrature for 22 roughnesses and 24 views, and fitted by smooth functions
// (tools/fit_albedo.py), within 0.005 for cosines of 0.03 or more and 0.008 below:
//
//   loss(c, r) = s (1 - s)^2 exp(P(x, y)),   s = c / (c + alpha),  alpha = r^2   (view cosine c)
//   x = 2 t - 1,  t = c (1 + alpha) / (c + alpha),   y = 2 r - 1
//   average(r) = alpha^2 exp(Q(y))           2 int loss c dc of the fit
//
// s, since a smooth surface loses light only within alpha of the horizon. Both are positive,
// whatever the polynomials.
//
//   dln(loss)/dr = 2 r ((2 c / alpha - 1) / (c + alpha) + 2 P_x dt/dalpha) + 2 P_y
//   dt/dalpha = c (c - 1) / (c + alpha)^2         dln(average)/dr = 4 / r + 2 Q'
#pragma once

#include "photograd/core/exp.h"
#include "photograd/ops/polynomial.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

namespace loss_detail {

inline constexpr double local[25] = {
    0.003043, 0.802589,  0.778204, -0.154873, -0.245785, 1.019321, -0.578203, -0.356648, 0.105287,
    0.109118, 0.037322,  1.010323, -0.754162, -0.697965, 0.686379, -0.206006, 0.360689,  -0.443359,
    0.143426, -0.010946, 0.097432, -0.039487, -0.166788, 0.638462, -0.422251};
inline constexpr double average[6] = {0.635419, -1.061316, -0.101745,
                                      0.000251, 0.048617,  -0.049759};

}  // namespace loss_detail

/// A value and its derivative with respect to roughness.
template <class R>
struct Loss {
    R value, slope;
};

template <class R>
inline Loss<R> ggx_loss(R cosine, R roughness) {
    const R alpha = roughness * roughness, sum = cosine + alpha, s = cosine / sum;
    const R t = s * (R(1) + alpha);
    const Polynomial<R> P =
        Polynomial<R>::of(loss_detail::local, 4, 4, R(2) * t - R(1), R(2) * roughness - R(1));
    const R rest = alpha / sum, value = s * rest * rest * exp(P.value);
    const R by_alpha = (R(2) * cosine / alpha - R(1)) / sum +
                       R(2) * P.by_x * cosine * (cosine - R(1)) / (sum * sum);
    return {value, value * (R(2) * roughness * by_alpha + R(2) * P.by_y)};
}

template <class R>
inline Loss<R> ggx_average_loss(R roughness) {
    const R alpha = roughness * roughness;
    const Polynomial<R> Q =
        Polynomial<R>::of(loss_detail::average, 5, 0, R(2) * roughness - R(1), R(0));
    const R value = alpha * alpha * exp(Q.value);
    return {value, value * (R(4) / roughness + R(2) * Q.by_x)};
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
