// A direction of unit length, and the adjoint.
//
//   n = d / |d|,   d_d = (d_n - n <n, d_n>) / |d|      no part along d
#pragma once

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// n[3] = d / |d|; returns 1 / |d|. d must not be zero.
template <class R>
inline R unit_direction(const R* d, R* n) {
    const R inverse = R(1) / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int i = 0; i < 3; ++i) n[i] = d[i] * inverse;
    return inverse;
}
/// Adds to d_d[3].
template <class R>
inline void unit_direction_backward(const R* n, R inverse, const R* d_n, R* d_d) {
    const R along = n[0] * d_n[0] + n[1] * d_n[1] + n[2] * d_n[2];
    for (int i = 0; i < 3; ++i) d_d[i] += (d_n[i] - n[i] * along) * inverse;
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
