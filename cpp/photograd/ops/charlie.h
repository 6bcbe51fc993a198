// The fibers of cloth: a distribution that is largest at the horizon, and its masking
// [Estevez2017].
//
//   D = (2 + q) sin(theta)^q / (2 pi),   q = 1 / alpha    integral of D cos over the hemisphere: 1
//   dD/dq = D (1 / (2 + q) + ln sin(theta)),   dq/dalpha = -1 / alpha^2
//
// Masking was simulated and fitted, for the cosine x of a direction:
//
//   Lambda(x) = exp(L(x)) below x = 0.5, exp(2 L(0.5) - L(1 - x)) above
//   L(x) = a / (1 + b x^c) + d x + e
//
// where each of a to e goes from its value at alpha = 0 to that at alpha = 1 with the weight w = (1
// - alpha)^2 of the first. So, with P = 1 + b x^c,
//
//   dL/da = 1 / P    dL/db = -a x^c / P^2    dL/dc = -a b x^c ln x / P^2    dL/dd = x    dL/de = 1
//   dw/dalpha = -2 (1 - alpha)
//   V = 1 / (4 o_z i_z (1 + Lambda_o + Lambda_i)),   dV/dLambda = -V / (1 + Lambda_o + Lambda_i)
//
// Directions are held constant.
#pragma once

#include "photograd/core/log.h"
#include "photograd/core/vec.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

namespace charlie_detail {

inline constexpr double at_zero[5] = {25.3245, 3.32435, 0.16801, -1.27393, -4.85967};
inline constexpr double at_one[5] = {21.5473, 3.82987, 0.19823, -1.97760, -4.32054};

/// L(x) and dL/dw.
template <class R>
struct Fit {
    R L, slope;

    static Fit of(R x, R w) {
        R k[5];
        for (int i = 0; i < 5; ++i) k[i] = R(at_one[i]) + R(at_zero[i] - at_one[i]) * w;
        const R power = pow(x, k[2]), P = R(1) + k[1] * power;
        const R by[5] = {R(1) / P, -k[0] * power / (P * P), -k[0] * k[1] * power * log(x) / (P * P),
                         x, R(1)};
        R slope = R(0);
        for (int i = 0; i < 5; ++i) slope += by[i] * R(at_zero[i] - at_one[i]);
        return {k[0] / P + k[3] * x + k[4], slope};
    }
};

/// ln Lambda and its derivative with respect to w.
template <class R>
inline Fit<R> log_lambda(R cos_theta, R w) {
    if (cos_theta < R(0.5)) return Fit<R>::of(cos_theta, w);
    // Straight up x = 0, where ln x is infinite and x^c still 0.
    const R x = larger(R(1) - cos_theta, R(1e-12));
    const Fit<R> half = Fit<R>::of(R(0.5), w), low = Fit<R>::of(x, w);
    return {R(2) * half.L - low.L, R(2) * half.slope - low.slope};
}

}  // namespace charlie_detail

/// Density of fibers' normals, per solid angle and area; sin_theta > 0.
template <class R>
inline R charlie_D(R sin_theta, R alpha) {
    const R q = R(1) / alpha;
    return (R(2) + q) * pow(sin_theta, q) * R(0.15915494309189533577);
}
template <class R>
inline void charlie_D_backward(R sin_theta, R alpha, R d_D, R& d_alpha) {
    const R q = R(1) / alpha;
    d_alpha -= d_D * charlie_D(sin_theta, alpha) * (R(1) / (R(2) + q) + log(sin_theta)) * (q * q);
}

template <class R>
inline R charlie_V(R cos_o, R cos_i, R alpha) {
    const R w = (R(1) - alpha) * (R(1) - alpha);
    const R sum = R(1) + exp(charlie_detail::log_lambda(cos_o, w).L) +
                  exp(charlie_detail::log_lambda(cos_i, w).L);
    return R(1) / (R(4) * cos_o * cos_i * sum);
}
template <class R>
inline void charlie_V_backward(R cos_o, R cos_i, R alpha, R d_V, R& d_alpha) {
    const R w = (R(1) - alpha) * (R(1) - alpha);
    const charlie_detail::Fit<R> o = charlie_detail::log_lambda(cos_o, w);
    const charlie_detail::Fit<R> i = charlie_detail::log_lambda(cos_i, w);
    const R lambda_o = exp(o.L), lambda_i = exp(i.L);
    const R d_lambda = -d_V * charlie_V(cos_o, cos_i, alpha) / (R(1) + lambda_o + lambda_i);
    const R d_w = d_lambda * (lambda_o * o.slope + lambda_i * i.slope);
    d_alpha -= d_w * R(2) * (R(1) - alpha);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
