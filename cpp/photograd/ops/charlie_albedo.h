// The part of the light that white sheen (ops/charlie.h) returns: computed by quadrature for 12
// roughnesses and 25 views, and fitted by a polynomial (tools/fit_albedo.py), within 0.005 for
// cosines of 0.003 or more:
//
//   E(c, r) = sum_ij k_ij x^i y^j,   x = 2 c^(1/4) - 1,   y = 2 r - 1
//
// The fit holds for roughness from 0.3 to 1; beyond, it stays what it is at the end.
#pragma once

#include "photograd/ops/polynomial.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

namespace sheen_detail {

inline constexpr double albedo[24] = {
    0.647412,  0.131019,  0.293992,  -0.274172, -0.611798, 0.326112,  -0.802785, 0.516146,
    -0.317889, 0.043252,  -0.062999, 0.060593,  0.458385,  -0.324041, 0.924447,  -0.617995,
    -0.252369, -0.215939, 0.021138,  0.048583,  0.104572,  0.157538,  -0.275257, 0.186779};

}  // namespace sheen_detail

/// E and its derivative with respect to roughness.
template <class R>
struct SheenAlbedo {
    R value, slope;

    static SheenAlbedo of(R cosine, R roughness) {
        const bool inside = roughness > R(0.3) && roughness < R(1);
        const R r = inside ? roughness : roughness < R(1) ? R(0.3) : R(1);
        const R x = R(2) * sqrt(sqrt(cosine)) - R(1);
        const Polynomial<R> E = Polynomial<R>::of(sheen_detail::albedo, 5, 3, x, R(2) * r - R(1));
        return {E.value, inside ? R(2) * E.by_y : R(0)};
    }
};

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
