// Real spherical harmonics up to degree 4: functions of direction, and color as a sum of them.
//
// Y_lm stands at index l (l + 1) + m, m from -l to l. They are written as homogeneous polynomials
// of degree l in (x, y, z), with r^2 = x^2 + y^2 + z^2 where others write 1 [Sloan2013, App. A2]:
// on the unit sphere that is the same, and off it the derivative is that of one formula instead of
// a branch. They are orthonormal: the integral of Y_i Y_j over the sphere is 1 for i = j, else 0.
//
//   color_c = sum_k Y_k(d) C_kc          dL/dC_kc = Y_k d_color_c
//                                        dL/dY_k  = sum_c C_kc d_color_c
//                                        dL/dd    = sum_k dL/dY_k dY_k/dd
//
// Signs: those of Plenoxels and Gaussian splatting, which keep the Condon-Shortley phase (-1)^m, so
// that Y_1 is (-y, z, -x) times 0.4886. Without the phase (graphics textbooks) functions of odd m
// change sign; the order is the same in both.
#pragma once

#include "photograd/core/isa.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

inline constexpr int sh_max_degree = 4;

constexpr int sh_count(int degree) { return (degree + 1) * (degree + 1); }

/// visit.template operator()<Degree>() for a degree known at run time, 0 to 3.
template <class Visit>
inline void with_sh_degree(int degree, Visit&& visit) {
    switch (degree) {
        case 0: visit.template operator()<0>(); break;
        case 1: visit.template operator()<1>(); break;
        case 2: visit.template operator()<2>(); break;
        default: visit.template operator()<3>();
    }
}

/// The constants of each band; sqrt of rationals over pi, to double precision.
namespace sh_constants {
inline constexpr double y00 = 0.28209479177387814;  // 1/2 sqrt(1/pi)
inline constexpr double y1 = 0.48860251190291992;   // 1/2 sqrt(3/pi)
inline constexpr double y2_xy = 1.0925484305920792, y2_zz = 0.31539156525252005,
                        y2_xx = 0.54627421529603959;
inline constexpr double y3_3 = 0.59004358992664352, y3_2 = 2.8906114426405538,
                        y3_1 = 0.45704579946446572, y3_0 = 0.37317633259011546,
                        y3_z = 1.4453057213202769;
inline constexpr double y4_4 = 2.5033429417967046, y4_3 = 1.7701307697799304,
                        y4_2 = 0.94617469575756008, y4_1 = 0.66904654355728921,
                        y4_0 = 0.10578554691520431, y4_x2 = 0.47308734787878004,
                        y4_x4 = 0.62583573544917614;
}  // namespace sh_constants

/// Y[0 .. sh_count(Degree)) at the direction (x, y, z), of unit length.
template <int Degree, class R>
inline void sh_basis(R x, R y, R z, R* Y) {
    static_assert(0 <= Degree && Degree <= sh_max_degree);
    using namespace sh_constants;
    Y[0] = R(y00);
    if constexpr (Degree >= 1) {
        Y[1] = R(-y1) * y;
        Y[2] = R(y1) * z;
        Y[3] = R(-y1) * x;
    }
    if constexpr (Degree >= 2) {
        const R xx = x * x, yy = y * y, zz = z * z;
        Y[4] = R(y2_xy) * (x * y);
        Y[5] = R(-y2_xy) * (y * z);
        Y[6] = R(y2_zz) * (R(2) * zz - xx - yy);
        Y[7] = R(-y2_xy) * (x * z);
        Y[8] = R(y2_xx) * (xx - yy);
        if constexpr (Degree >= 3) {
            const R four_zz = R(4) * zz - xx - yy;
            Y[9] = R(-y3_3) * y * (R(3) * xx - yy);
            Y[10] = R(y3_2) * (x * y) * z;
            Y[11] = R(-y3_1) * y * four_zz;
            Y[12] = R(y3_0) * z * (R(2) * zz - R(3) * xx - R(3) * yy);
            Y[13] = R(-y3_1) * x * four_zz;
            Y[14] = R(y3_z) * z * (xx - yy);
            Y[15] = R(-y3_3) * x * (xx - R(3) * yy);
        }
        if constexpr (Degree >= 4) {
            const R rr = xx + yy + zz, six_zz = R(7) * zz - rr, four_zz = R(7) * zz - R(3) * rr;
            Y[16] = R(y4_4) * (x * y) * (xx - yy);
            Y[17] = R(-y4_3) * (y * z) * (R(3) * xx - yy);
            Y[18] = R(y4_2) * (x * y) * six_zz;
            Y[19] = R(-y4_1) * (y * z) * four_zz;
            Y[20] = R(y4_0) * (R(35) * zz * zz - R(30) * zz * rr + R(3) * rr * rr);
            Y[21] = R(-y4_1) * (x * z) * four_zz;
            Y[22] = R(y4_x2) * (xx - yy) * six_zz;
            Y[23] = R(-y4_3) * (x * z) * (xx - R(3) * yy);
            Y[24] = R(y4_x4) * (xx * (xx - R(3) * yy) - yy * (R(3) * xx - yy));
        }
    }
}
/// Adds sum_k d_Y[k] dY_k/d(x, y, z) to d_direction. Each line is the gradient of the line above
/// it.
template <int Degree, class R>
inline void sh_basis_backward(R x, R y, R z, const R* d_Y, R* d_direction) {
    static_assert(0 <= Degree && Degree <= sh_max_degree);
    using namespace sh_constants;
    R dx = R(0), dy = R(0), dz = R(0);
    if constexpr (Degree >= 1) {
        dy += R(-y1) * d_Y[1];
        dz += R(y1) * d_Y[2];
        dx += R(-y1) * d_Y[3];
    }
    if constexpr (Degree >= 2) {
        const R xx = x * x, yy = y * y, zz = z * z;
        const R g4 = R(y2_xy) * d_Y[4], g5 = R(-y2_xy) * d_Y[5], g6 = R(y2_zz) * d_Y[6],
                g7 = R(-y2_xy) * d_Y[7], g8 = R(y2_xx) * d_Y[8];
        dx += g4 * y - R(2) * g6 * x + g7 * z + R(2) * g8 * x;
        dy += g4 * x + g5 * z - R(2) * g6 * y - R(2) * g8 * y;
        dz += g5 * y + R(4) * g6 * z + g7 * x;
        if constexpr (Degree >= 3) {
            const R g9 = R(-y3_3) * d_Y[9], g10 = R(y3_2) * d_Y[10], g11 = R(-y3_1) * d_Y[11],
                    g12 = R(y3_0) * d_Y[12], g13 = R(-y3_1) * d_Y[13], g14 = R(y3_z) * d_Y[14],
                    g15 = R(-y3_3) * d_Y[15];
            const R xy = x * y, yz = y * z, xz = x * z, xx_yy = xx - yy;
            dx += R(6) * g9 * xy + g10 * yz - R(2) * g11 * xy - R(6) * g12 * xz +
                  g13 * (R(4) * zz - R(3) * xx - yy) + R(2) * g14 * xz + R(3) * g15 * xx_yy;
            dy += R(3) * g9 * xx_yy + g10 * xz + g11 * (R(4) * zz - xx - R(3) * yy) -
                  R(6) * g12 * yz - R(2) * g13 * xy - R(2) * g14 * yz - R(6) * g15 * xy;
            dz += g10 * xy + R(8) * g11 * yz + R(3) * g12 * (R(2) * zz - xx - yy) +
                  R(8) * g13 * xz + g14 * xx_yy;
        }
        if constexpr (Degree >= 4) {
            const R rr = xx + yy + zz, six_zz = R(7) * zz - rr, four_zz = R(7) * zz - R(3) * rr;
            const R g16 = R(y4_4) * d_Y[16], g17 = R(-y4_3) * d_Y[17], g18 = R(y4_2) * d_Y[18],
                    g19 = R(-y4_1) * d_Y[19], g20 = R(y4_0) * d_Y[20], g21 = R(-y4_1) * d_Y[21],
                    g22 = R(y4_x2) * d_Y[22], g23 = R(-y4_3) * d_Y[23], g24 = R(y4_x4) * d_Y[24];
            const R xy = x * y, xx_yy = xx - yy;
            // d six_zz = (-2x, -2y, 12z), d four_zz = (-6x, -6y, 8z).
            const R slope20 = R(12) * rr - R(60) * zz;  // of the zonal term, over x or y
            dx += g16 * y * (R(3) * xx - yy) + R(6) * g17 * xy * z +
                  g18 * y * (six_zz - R(2) * xx) - R(6) * g19 * xy * z + g20 * x * slope20 +
                  g21 * z * (four_zz - R(6) * xx) + R(2) * g22 * x * (six_zz - xx_yy) +
                  R(3) * g23 * z * xx_yy + R(4) * g24 * x * (xx - R(3) * yy);
            dy += g16 * x * (xx - R(3) * yy) + R(3) * g17 * z * xx_yy +
                  g18 * x * (six_zz - R(2) * yy) + g19 * z * (four_zz - R(6) * yy) +
                  g20 * y * slope20 - R(6) * g21 * xy * z - R(2) * g22 * y * (six_zz + xx_yy) -
                  R(6) * g23 * xy * z + R(4) * g24 * y * (yy - R(3) * xx);
            dz += g17 * y * (R(3) * xx - yy) + R(12) * g18 * xy * z +
                  g19 * y * (four_zz + R(8) * zz) + g20 * z * (R(80) * zz - R(48) * rr) +
                  g21 * x * (four_zz + R(8) * zz) + R(12) * g22 * z * xx_yy +
                  g23 * x * (xx - R(3) * yy);
        }
    }
    d_direction[0] += dx;
    d_direction[1] += dy;
    d_direction[2] += dz;
}

/// color[c] = sum_k Y[k] coefficients[k Channels + c]
template <int Degree, int Channels, class R>
inline void sh_color(const R* Y, const R* coefficients, R* color) {
    for (int c = 0; c < Channels; ++c) color[c] = R(0);
    for (int k = 0; k < sh_count(Degree); ++k)
        for (int c = 0; c < Channels; ++c) color[c] += Y[k] * coefficients[k * Channels + c];
}
template <int Degree, int Channels, class R>
inline void sh_color_backward(const R* Y, const R* coefficients, const R* d_color, R* d_Y,
                              R* d_coefficients) {
    for (int k = 0; k < sh_count(Degree); ++k) {
        for (int c = 0; c < Channels; ++c) {
            d_Y[k] += coefficients[k * Channels + c] * d_color[c];
            d_coefficients[k * Channels + c] += Y[k] * d_color[c];
        }
    }
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
