// Fused multiply-add of float, a b + c rounded once, with the same bits on every processor.
//
// Without the instruction, the product and the sum are taken in double and rounded twice. The
// product of two floats is exact there, the sum is not: it is first rounded to odd [Boldo2008].
// That is, its last bit is set where the sum is inexact, and the second rounding is then that of
// the exact sum.
#pragma once

#include "photograd/core/isa.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// Floats in one register.
#if defined(__AVX512F__)
inline constexpr int register_lanes = 16;
#elif defined(__FMA__)
inline constexpr int register_lanes = 8;
#else
inline constexpr int register_lanes = 4;
#endif
using Register = float __attribute__((vector_size(4 * register_lanes), aligned(4), may_alias));

#if defined(__SSE2__) && !defined(__FMA__)
namespace detail {
// Two lanes: a b + c in double, rounded to odd.
inline __m128d fused_in_double(__m128d a, __m128d b, __m128d c) {
    const __m128d product = a * b, sum = product + c;
    // The rounding error of the sum [Knuth1997, Sec. 4.2.2].
    const __m128d back = sum - product, error = (product - (sum - back)) + (c - back);
    // One bit to the side where the exact sum lies; the neighbor of an even number there is odd.
    const __m128i one = _mm_set1_epi64x(1), bits = _mm_castpd_si128(sum);
    const __m128i apart =
        _mm_castpd_si128(_mm_xor_pd(error, sum));  // its sign: whether toward zero
    const __m128i step = _mm_sub_epi64(one, _mm_slli_epi64(_mm_srli_epi64(apart, 63), 1));
    const __m128i inexact = _mm_castpd_si128(_mm_cmpneq_pd(error, _mm_setzero_pd()));
    const __m128i odd = _mm_sub_epi64(_mm_setzero_si128(), _mm_and_si128(bits, one));
    return _mm_castsi128_pd(
        _mm_add_epi64(bits, _mm_andnot_si128(odd, _mm_and_si128(step, inexact))));
}
}  // namespace detail
#endif

/// a b + c in each lane, rounded once. Products and sums beyond the range of float are not served.
inline Register fused_multiply_add(float a, Register b, Register c) {
#if defined(__AVX512F__)
    return Register(_mm512_fmadd_ps(_mm512_set1_ps(a), __m512(b), __m512(c)));
#elif defined(__FMA__)
    return Register(_mm256_fmadd_ps(_mm256_set1_ps(a), __m256(b), __m256(c)));
#elif defined(__SSE2__)
    const __m128d left = _mm_set1_pd(a);
    const __m128 b4 = __m128(b), c4 = __m128(c);
    const __m128 low =
        _mm_cvtpd_ps(detail::fused_in_double(left, _mm_cvtps_pd(b4), _mm_cvtps_pd(c4)));
    const __m128 high = _mm_cvtpd_ps(detail::fused_in_double(
        left, _mm_cvtps_pd(_mm_movehl_ps(b4, b4)), _mm_cvtps_pd(_mm_movehl_ps(c4, c4))));
    return Register(_mm_movelh_ps(low, high));
#else
    Register out;
    for (int i = 0; i < register_lanes; ++i) out[i] = __builtin_fmaf(a, b[i], c[i]);
    return out;
#endif
}

inline Register load(const float* from) { return *reinterpret_cast<const Register*>(from); }
inline void store(Register v, float* to) { *reinterpret_cast<Register*>(to) = v; }

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
