// Tone curves: from linear radiance, without a limit, to what a display shows, linear from 0 to 1.
//
//   extended Reinhard [Reinhard2002, Eq. 4], white w maps to 1:
//     y = x (1 + x / w^2) / (1 + x)
//   rational fit of the ACES reference transform [Narkowicz2016], coefficients a, b, c, d, e:
//     y = x (a x + b) / (x (c x + d) + e)
//   contrast curve of AgX [Sobotka2022], on t = (log2 x - lo) / (hi - lo), with slope s at the
//   pivot (p, q) and the power r of toe and shoulder:
//     u = s |t - p| / k,  h = u / (1 + u^r)^(1/r),  y = q +- k h above or below p,
//     k = s m / b^(1/r),  b = (s m / n)^r - 1,  (m, n) = (1 - p, 1 - q) above and (p, q) below,
//     so that the curve runs from (0, 0) through the pivot to (1, 1). Derivatives:
//     d ln k/ds = -1 / (s b),  d ln k/dr = ln(b) / r^2 - (b + 1) ln(s m / n) / (r b),
//     dh/du = (1 + u^r)^(-1/r - 1),  dh/dr = h (ln(1 + u^r) / r^2 - u^r ln(u) / (r (1 + u^r)))
//
// All are monotone, and 0 at 0. Colors are not limited to 1 by the first two.
#pragma once

#include "photograd/core/log.h"
#include "photograd/core/vec.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

template <class R>
inline R reinhard(R x, R white) {
    return x * (R(1) + x / (white * white)) / (R(1) + x);
}
template <class R>
inline void reinhard_backward(R x, R white, R d_y, R& d_x, R& d_white) {
    const R ratio = x / white;
    d_x += d_y * (R(1) + R(2) * ratio / white + ratio * ratio) / ((R(1) + x) * (R(1) + x));
    d_white -= d_y * R(2) * ratio * ratio / (white * (R(1) + x));
}

/// Coefficients {a, b, c, d, e}.
template <class R>
inline R aces_fit(R x, const R* k) {
    return x * (k[0] * x + k[1]) / (x * (k[2] * x + k[3]) + k[4]);
}
template <class R>
inline void aces_fit_backward(R x, const R* k, R d_y, R& d_x, R* d_k) {
    const R over = R(1) / (x * (k[2] * x + k[3]) + k[4]), y = x * (k[0] * x + k[1]) * over;
    const R d_top = d_y * over, d_bottom = -d_top * y;
    d_x += d_top * (R(2) * k[0] * x + k[1]) + d_bottom * (R(2) * k[2] * x + k[3]);
    d_k[0] += d_top * x * x;
    d_k[1] += d_top * x;
    d_k[2] += d_bottom * x * x;
    d_k[3] += d_bottom * x;
    d_k[4] += d_bottom;
}

inline constexpr double agx_pivot_x = 10.0 / 16.5;         // of log2: 0.18 lies 10 stops above lo
inline constexpr double agx_pivot_y = 0.4894370895738783;  // 0.18^(1/2.4)

/// One side of the pivot, at t from 0 to 1. The slope has to be above 1.3, that of the straight
/// line from the pivot to (1, 1).
template <class R>
struct AgxSide {
    R slope, power, sign, steep, b, k, u, raised, h;

    AgxSide(R t, R s, R r) : slope(s), power(r) {
        const bool below = t < R(agx_pivot_x);
        const R m = below ? R(agx_pivot_x) : R(1 - agx_pivot_x);
        const R n = below ? R(agx_pivot_y) : R(1 - agx_pivot_y);
        sign = below ? R(-1) : R(1);
        steep = slope * m / n;
        b = pow(steep, power) - R(1);
        k = slope * m * pow(b, R(-1) / power);
        u = slope * sign * (t - R(agx_pivot_x)) / k;
        raised = u > R(0) ? pow(u, power) : R(0);
        h = u * pow(R(1) + raised, R(-1) / power);
    }
    R value() const { return R(agx_pivot_y) + sign * k * h; }

    void backward(R d_y, R& d_t, R& d_slope, R& d_power) const {
        const R bent = R(1) + raised, h_by_u = u > R(0) ? h / (u * bent) : R(1);
        const R k_by_slope = R(-1) / (slope * b);  // of ln k
        const R k_by_power = log(b) / (power * power) - (b + R(1)) * log(steep) / (power * b);
        const R h_by_power =
            u > R(0) ? h * (log(bent) / (power * power) - raised * log(u) / (power * bent)) : R(0);
        const R d_side = d_y * sign * k;
        d_t += d_y * slope * h_by_u;
        d_slope += d_side * (k_by_slope * h + h_by_u * u * (R(1) / slope - k_by_slope));
        d_power += d_side * (k_by_power * (h - h_by_u * u) + h_by_power);
    }
};

template <class R>
inline R agx_contrast(R t, R slope, R power) {
    return AgxSide<R>(t, slope, power).value();
}
template <class R>
inline void agx_contrast_backward(R t, R slope, R power, R d_y, R& d_t, R& d_slope, R& d_power) {
    AgxSide<R>(t, slope, power).backward(d_y, d_t, d_slope, d_power);
}

// From Rec. 709 to the primaries in which AgX forms the picture, and back [Sobotka2022].
inline constexpr double agx_inset[3][3] = {
    {0.842479062253094, 0.0784335999999992, 0.0792237451477643},
    {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
    {0.0423756549057051, 0.0784336, 0.879142973793104}};
inline constexpr double agx_outset[3][3] = {
    {1.19687900512017, -0.0980208811401368, -0.0990297440797205},
    {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
    {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}};
inline constexpr double agx_log_lo = -12.47393, agx_log_hi = 4.026069;  // of log2
inline constexpr double agx_display_power = 2.4;

/// A color of linear radiance as AgX shows it, linear; {slope, power} are those of its contrast.
template <class R>
struct AgxColor {
    R inset[3], t[3], curved[3], shown[3], out[3];

    AgxColor(const R* color, const R* params) {
        const R per_stop = R(1 / (0.69314718055994531 * (agx_log_hi - agx_log_lo)));
        const R lo = R(-agx_log_lo / (agx_log_hi - agx_log_lo));
        for (int i = 0; i < 3; ++i) {
            inset[i] = R(0);
            for (int j = 0; j < 3; ++j) inset[i] += R(agx_inset[i][j]) * color[j];
            t[i] = inset[i] > R(0) ? log(inset[i]) * per_stop + lo : R(0);
            const bool inside = t[i] > R(0) && t[i] < R(1);
            curved[i] = inside ? agx_contrast(t[i], params[0], params[1]) : R(t[i] > R(0) ? 1 : 0);
        }
        for (int i = 0; i < 3; ++i) {
            shown[i] = R(0);
            for (int j = 0; j < 3; ++j) shown[i] += R(agx_outset[i][j]) * curved[j];
            out[i] = shown[i] > R(0) ? pow(shown[i], R(agx_display_power)) : R(0);
        }
    }
    void backward(const R* params, const R* d_out, R* d_color, R* d_params) const {
        const R per_stop = R(1 / (0.69314718055994531 * (agx_log_hi - agx_log_lo)));
        R d_curved[3] = {R(0), R(0), R(0)};
        for (int i = 0; i < 3; ++i) {
            if (!(shown[i] > R(0))) continue;
            const R d_shown = d_out[i] * R(agx_display_power) * out[i] / shown[i];
            for (int j = 0; j < 3; ++j) d_curved[j] += R(agx_outset[i][j]) * d_shown;
        }
        for (int i = 0; i < 3; ++i) {
            if (!(t[i] > R(0) && t[i] < R(1))) continue;
            R d_t = R(0);
            agx_contrast_backward(t[i], params[0], params[1], d_curved[i], d_t, d_params[0],
                                  d_params[1]);
            for (int j = 0; j < 3; ++j)
                d_color[j] += R(agx_inset[i][j]) * d_t * per_stop / inset[i];
        }
    }
};

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
