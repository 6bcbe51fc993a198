// The error function, from the series that has only positive terms (nothing cancels)
// [Abramowitz1964, Eq. 7.1.6]:
//
//   erf(x) = 2/sqrt(pi) e^(-x^2) sum_n 2^n x^(2n+1) / (1 3 5 ... (2n+1))
//   derf/dx = 2/sqrt(pi) e^(-x^2)
//
// From x = 6 on it is 1 to rounding (1 - erf(6) = 2e-17).
#pragma once

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

inline constexpr double two_over_sqrt_pi = 1.12837916709551257390;

/// erf(x) for x >= 0.
template <class R>
inline R erf(R x) {
    if (x > R(6)) return R(1);
    // A term is at most 2 x^2 / (2n + 3) of the one before; after 120 the rest is below 1e-20 at x
    // = 6.
    R term = x, sum = x;
    for (int n = 1; n < 120 && term > R(1e-18) * sum; ++n) {
        term *= R(2) * x * x / R(2 * n + 1);
        sum += term;
    }
    return R(two_over_sqrt_pi) * exp(-x * x) * sum;
}
template <class R>
inline void erf_backward(R x, R d_y, R& d_x) {
    d_x += d_y * R(two_over_sqrt_pi) * exp(-x * x);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
