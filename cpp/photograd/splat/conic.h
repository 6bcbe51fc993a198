// The conic of a splat: the inverse of its screen covariance, after a low-pass filter of l pixel^2.
//
//   blurred = cov2d + l I                          no splat gets thinner than a pixel
//   det     = det(cov2d) + l trace(cov2d) + l^2
//   conic   = (yy + l, -xy, xx + l) / det          A, B, C
//   sigma(d) = (A dx^2 + C dy^2) / 2 + B dx dy
//   compensation = sqrt(max(det(cov2d) / det, floor))
//
// The low-pass spreads a thin splat over more pixels without making it fainter, so it brightens
// when seen from afar. Multiplying its opacity by `compensation` keeps its total [Yu2024]; that is
// the antialiased mode. At the floor the square root is held, and its derivative is zero: a flat
// splat would have an infinite one.
//
// Adjoint. With Q = conic as a matrix and H its derivative (H_xy = d_B / 2), d(S^-1) = -S^-1 dS
// S^-1:
//
//   d_cov2d = -Q H Q, off-diagonal once for each of its two entries
//   d ln compensation = (d ln det(cov2d) - d ln det) / 2,   d ln det(S) = <S^-1, dS>
#pragma once

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// compensation^2 never falls below this: opacity shrinks at most 200 times.
inline constexpr double compensation_floor = 2.5e-5;

template <class R>
struct Conic {
    R abc[3];  // A, B, C
    R compensation;
    R det;
    bool held;  // compensation is at its floor

    /// det <= 0 or not finite: the splat has no extent, or none that numbers can hold.
    [[nodiscard]] bool valid() const { return det > R(0) && det < R(1e30); }
};

template <class R>
inline R determinant(const R* cov2d) {
    // Rounding may push the determinant of a needle below zero.
    return larger(cov2d[0] * cov2d[2] - cov2d[1] * cov2d[1], R(0));
}

template <class R>
inline Conic<R> conic_of(const R* cov2d, R low_pass) {
    Conic<R> out;
    const R sharp = determinant(cov2d);
    out.det = sharp + low_pass * (cov2d[0] + cov2d[2]) + low_pass * low_pass;
    const R inverse = R(1) / out.det;
    out.abc[0] = (cov2d[2] + low_pass) * inverse;
    out.abc[1] = -cov2d[1] * inverse;
    out.abc[2] = (cov2d[0] + low_pass) * inverse;
    const R ratio = sharp * inverse;
    out.held = !(ratio > R(compensation_floor));
    out.compensation = sqrt(out.held ? R(compensation_floor) : ratio);
    return out;
}
/// Adds to d_cov2d[3].
template <class R>
inline void conic_backward(const R* cov2d, const Conic<R>& conic, const R* d_abc, R d_compensation,
                           R* d_cov2d) {
    const R a = conic.abc[0], b = conic.abc[1], c = conic.abc[2], half = R(0.5);
    // K = Q H, then Q H Q.
    const R k00 = a * d_abc[0] + b * half * d_abc[1], k01 = a * half * d_abc[1] + b * d_abc[2];
    const R k10 = b * d_abc[0] + c * half * d_abc[1], k11 = b * half * d_abc[1] + c * d_abc[2];
    d_cov2d[0] -= k00 * a + k01 * b;
    d_cov2d[1] -= (k00 * b + k01 * c) + (k10 * a + k11 * b);
    d_cov2d[2] -= k10 * b + k11 * c;
    if (conic.held) return;
    const R sharp = R(1) / determinant(cov2d), scale = half * conic.compensation * d_compensation;
    d_cov2d[0] += scale * (cov2d[2] * sharp - a);
    d_cov2d[1] += scale * R(2) * (-(cov2d[1] * sharp) - b);
    d_cov2d[2] += scale * (cov2d[0] * sharp - c);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
