// Natural logarithm and real powers with the same bits on every processor, like exp.h.
//
//   x = 2^n m,  sqrt(1/2) <= m < sqrt(2)
//   ln x = n ln2 + 2 atanh(s),   s = (m - 1) / (m + 1),  |s| <= 0.172
//
// The series s + s^3/3 + s^5/5 + ... is cut where the rest is below rounding: at s^11 for float
// (4e-10), at s^23 for double (2e-20). Near x = 1 n is 0 and s exact, so ln x keeps its relative
// accuracy there.
#pragma once

#include <bit>
#include <cstdint>

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// ln x for x > 0, relative error below 3e-7 (float) and 5e-16 (double). 0 gives about -88 and
/// -709, where exp saturates as well.
inline float log(float x) {
    const auto bits = std::bit_cast<std::int32_t>(x);
    const std::int32_t n = (bits - 0x3f3504f3) >> 23;  // subtracts sqrt(1/2), keeps the exponent
    const float m = std::bit_cast<float>(bits - (n << 23));
    const float s = (m - 1.0f) / (m + 1.0f), z = s * s;
    float p = 1.0f / 11.0f;
    for (int k = 9; k >= 3; k -= 2) p = p * z + 1.0f / static_cast<float>(k);
    const auto exponent = static_cast<float>(n);
    // ln2 in two parts, as in exp.h: the first has few bits, so n * part is exact.
    return exponent * 0.693359375f + (2.0f * (s + s * (p * z)) - exponent * 2.12194440e-4f);
}
inline double log(double x) {
    const auto bits = std::bit_cast<std::int64_t>(x);
    const std::int64_t n = (bits - 0x3fe6a09e667f3bcd) >> 52;
    const double m = std::bit_cast<double>(bits - (n << 52));
    const double s = (m - 1.0) / (m + 1.0), z = s * s;
    double p = 1.0 / 23.0;
    for (int k = 21; k >= 3; k -= 2) p = p * z + 1.0 / k;
    const auto exponent = static_cast<double>(n);
    return exponent * 6.93147180369123816490e-1 +
           (2.0 * (s + s * (p * z)) + exponent * 1.90821492927058770002e-10);
}
template <class T>
inline Dual<T> log(Dual<T> x) {
    return {log(x.value), x.tangent / x.value};
}

/// x^y for x > 0, by y ln x: relative error grows with |y ln x|, to 1e-13 (double) and 5e-5 (float)
/// at 700.
template <class R>
inline R pow(R x, R y) {
    return exp(y * log(x));
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
