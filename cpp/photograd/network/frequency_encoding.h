// Frequency (positional) encoding [Mildenhall2020, Eq. 4] of D numbers with L octaves:
//
//   p, then sin(2^k pi p_a) for k = 0 .. L - 1 and each a, then the cosines in the same order
//
// Angles are reduced in half turns before they are multiplied by pi: 2^k p is exact, and so is what
// is left of it after whole turns.
//
// Adjoint: d_p_a += d_identity + sum_k 2^k pi (cos d_sin - sin d_cos).
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "photograd/core/real.h"
#include "photograd/core/sincos.h"

namespace photograd {

struct FrequencyEncoding {
    int dimensions, octaves;

    [[nodiscard]] int features() const { return dimensions * (1 + 2 * octaves); }

    /// visit(a, k, place of the sine, its angle) for all octaves k of all numbers p[a].
    template <class R, class Visit>
    void for_octaves(const R* p, Visit&& visit) const {
        for (int k = 0; k < octaves; ++k)
            for (int a = 0; a < dimensions; ++a) {
                const R half_turns = std::ldexp(p[a], k);
                const R rest = half_turns - R(2) * std::nearbyint(R(0.5) * half_turns);
                visit(a, k, dimensions * (1 + k) + a, std::numbers::pi_v<R> * rest);
            }
    }

    /// Feature f is written to out[f * stride].
    template <Real R>
    void encode(const R* p, std::int64_t stride, R* out) const {
        for (int a = 0; a < dimensions; ++a) out[a * stride] = p[a];
        for_octaves(p, [&](int, int, int at, R angle) {
            const SinCos<R> value = sin_cos(angle);
            out[at * stride] = value.sin;
            out[(at + dimensions * octaves) * stride] = value.cos;
        });
    }

    template <Real R>
    void backward(const R* p, std::int64_t stride, const R* d_out, R* d_p) const {
        for (int a = 0; a < dimensions; ++a) d_p[a] += d_out[a * stride];
        for_octaves(p, [&](int a, int k, int at, R angle) {
            const SinCos<R> value = sin_cos(angle);
            const R d_sin = d_out[at * stride], d_cos = d_out[(at + dimensions * octaves) * stride];
            const R rate = std::numbers::pi_v<R> * std::ldexp(R(1), k);
            d_p[a] += rate * (value.cos * d_sin - value.sin * d_cos);
        });
    }
};

}  // namespace photograd
