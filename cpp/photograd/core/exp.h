// exp, expm1 and log1p that give the same bits on every processor.
//
// libm picks a different expf for processors with fused multiply-add, so its results are not
// portable bit for bit, and a call into it cannot be vectorized. These are straight-line code that
// a compiler turns into lanes.
//
// Range reduction: x = n ln2 + r with |r| <= ln2 / 2 and exp(x) = 2^n (1 + q(r)). Here
// q(r) = exp(r) - 1 is a Taylor polynomial: to r^7 for float (remainder 5e-9), to r^13 for double
// (remainder 4e-18). Keeping q apart from the 1 gives expm1 without cancellation:
// expm1(x) = (2^n - 1) + 2^n q(r).
#pragma once

#include "photograd/core/isa.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

namespace exp_detail {

template <class R>
struct ScaledExp {
    R scale;  // 2^n
    R q;      // exp(r) - 1
};

inline ScaledExp<float> scaled_exp(float x) {
    // Clamp so that 2^n stays a normal number; exp(-87) = 1.6e-38 is as good as zero for radiance.
    x = clamped(x, -87.0f, 88.0f);
    // Adding 1.5 * 2^23 rounds to the nearest integer, which then sits in the low mantissa bits.
    const float shifted = x * 1.44269504f + 12582912.0f;
    const float n = shifted - 12582912.0f;
    // ln2 in two parts (Cody and Waite): the first has few bits, so n * part is exact.
    const float r = (x - n * 0.693359375f) + n * 2.12194440e-4f;
    float p = 1.98412698e-4f;
    p = p * r + 1.38888889e-3f;
    p = p * r + 8.33333333e-3f;
    p = p * r + 4.16666667e-2f;
    p = p * r + 1.66666667e-1f;
    p = p * r + 0.5f;
    const float q = p * (r * r) + r;
    union {
        int bits;
        float value;
    } scale;
    scale.bits = (static_cast<int>(n) + 127) << 23;
    return {scale.value, q};
}

inline ScaledExp<double> scaled_exp(double x) {
    x = clamped(x, -708.0, 709.0);
    const double shifted = x * 1.4426950408889634 + 6755399441055744.0;
    const double n = shifted - 6755399441055744.0;
    const double r = (x - n * 6.93147180369123816490e-1) - n * 1.90821492927058770002e-10;
    double p = 1.0 / 6227020800.0;
    p = p * r + 1.0 / 479001600.0;
    p = p * r + 1.0 / 39916800.0;
    p = p * r + 1.0 / 3628800.0;
    p = p * r + 1.0 / 362880.0;
    p = p * r + 1.0 / 40320.0;
    p = p * r + 1.0 / 5040.0;
    p = p * r + 1.0 / 720.0;
    p = p * r + 1.0 / 120.0;
    p = p * r + 1.0 / 24.0;
    p = p * r + 1.0 / 6.0;
    p = p * r + 0.5;
    const double q = p * (r * r) + r;
    union {
        long long bits;
        double value;
    } scale;
    scale.bits = (static_cast<long long>(n) + 1023) << 52;
    return {scale.value, q};
}

}  // namespace exp_detail

/// e^x, relative error below 2e-7 (float) and 4e-16 (double); saturates instead of overflowing.
template <class R>
inline R exp(R x) {
    const exp_detail::ScaledExp<R> e = exp_detail::scaled_exp(x);
    return e.scale * e.q + e.scale;
}

/// e^x - 1 without cancellation for small x.
template <class R>
inline R expm1(R x) {
    const exp_detail::ScaledExp<R> e = exp_detail::scaled_exp(x);
    return e.scale * e.q + (e.scale - R(1));
}

/// ln(1 + x) for 0 <= x <= 1, from the series of 2 atanh(s), s = x / (2 + x) <= 1/3.
/// Full relative accuracy down to x = 0: softplus of a very negative number must not become zero.
inline float log1p_unit(float x) {
    const float s = x / (2.0f + x);
    const float z = s * s;
    float p = 1.0f / 13.0f;
    p = p * z + 1.0f / 11.0f;
    p = p * z + 1.0f / 9.0f;
    p = p * z + 1.0f / 7.0f;
    p = p * z + 1.0f / 5.0f;
    p = p * z + 1.0f / 3.0f;
    return 2.0f * (s + s * (p * z));
}

inline double log1p_unit(double x) {
    const double s = x / (2.0 + x);
    const double z = s * s;
    double p = 1.0 / 33.0;
    for (int k = 31; k >= 3; k -= 2) p = p * z + 1.0 / k;
    return 2.0 * (s + s * (p * z));
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
