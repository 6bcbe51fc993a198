// The formula of obscurance.h in |v|^2 and v.n, for lanes.
#pragma once

#include "photograd/core/log.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// `squared` is |v|^2, `along` v.n; 0 beyond the radius, and where `along` is too small.
template <class R>
inline R obscurance_terms(R squared, R along, R radius, R falloff, R bias) {
    const R t = R(1) - squared / (radius * radius);
    const bool inside = (t > R(0)) & (squared > R(0));
    const R e = along / sqrt(inside ? squared : R(1)) - bias;
    const R found = e * pow(inside ? t : R(1), falloff);
    return inside & (e > R(0)) ? found : R(0);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
