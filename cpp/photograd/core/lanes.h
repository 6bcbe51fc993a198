// Lanes: W numbers that are treated alike, written as plain loops that the compiler vectorizes.
//
// The order of every operation is fixed by this file, not by the compiler, so that a loop over
// lanes compiled for SSE2, AVX2 or AVX-512, and a scalar program that follows the same order, agree
// bit for bit. That is why sums across lanes go through `sum` (a fixed tree) and never through a
// plain loop that one compiler might reassociate and another not.
#pragma once

#include "photograd/core/isa.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// Samples along a ray are handled in sub-blocks of this many.
inline constexpr int lane_count = 16;

template <class R>
struct alignas(lane_count * 4) Lanes {
    R v[lane_count];

    R& operator[](int i) { return v[i]; }
    const R& operator[](int i) const { return v[i]; }

    static Lanes filled(R x) {
        Lanes out;
        for (int i = 0; i < lane_count; ++i) out.v[i] = x;
        return out;
    }
};

/// Sum over lanes as a tree: pairs 8 apart, then 4, 2, 1.
template <class R>
inline R sum(const Lanes<R>& x) {
    R a[8];
    for (int i = 0; i < 8; ++i) a[i] = x[i] + x[i + 8];
    for (int i = 0; i < 4; ++i) a[i] = a[i] + a[i + 4];
    return (a[0] + a[2]) + (a[1] + a[3]);
}

/// Running sum within the lanes: out[i] = x[0] + ... + x[i]. Four groups of four: inside a group in
/// order, then the groups' totals in order; short chains instead of one chain of sixteen additions.
template <class R>
inline Lanes<R> running_sum(const Lanes<R>& x) {
    Lanes<R> y;
    for (int g = 0; g < lane_count; g += 4) {
        const R ab = x[g] + x[g + 1];
        y[g] = x[g];
        y[g + 1] = ab;
        y[g + 2] = ab + x[g + 2];
        y[g + 3] = ab + (x[g + 2] + x[g + 3]);
    }
    R before = y[3];
    for (int g = 4; g < lane_count; g += 4) {
        const R total = y[g + 3];
        for (int i = 0; i < 4; ++i) y[g + i] = before + y[g + i];
        before = before + total;
    }
    return y;
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
