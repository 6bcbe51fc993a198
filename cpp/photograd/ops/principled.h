// Burley's principled surface without its extra lobes: a base layer, coated, that turns into a
// metal [Burley2012, Sec. 5].
//
//   f = (1 - metalness) (diffuse + F_d L) + metalness (base + (1 - base) ramp) L = base P + Q
//       in each channel
//
//   P = (1 - metalness) S / pi + metalness (1 - ramp) L
//       Q = L ((1 - metalness) F_d + metalness ramp)
//
//   c = <wo, wh>, ramp = (1 - c)^5, F_d = Fresnel's reflectance at c, index 1.5
//       [Born1999, Sec. 1.5.2]
//   S = s(o_z) s(i_z), s(z) = 1 + (2 roughness c^2 - 1/2) (1 - z)^5
//       burley_diffuse.h, for albedo 1, times pi
//   L = D G1(wo) G1(wi) / (4 o_z i_z)     GGX, A = alpha^2 = roughness^4       [Walter2007, Eq. 33]
//
// Here masking and shadowing are independent, unlike in ggx.h: G1 = 2 z / (z + |w|), |w|^2 = A (x^2
// + y^2) + z^2. With w = wo + wi (not normalized), X = w_x^2 + w_y^2, Z = w_z^2 and n = X + Z, L
// needs no half vector and one division:
//
//   L = A n^2 / (pi (X + A Z)^2 (o_z + |o|) (i_z + |i|))
//
//   dL/dA = L (1 / A - 2 Z / (X + A Z) - |o|' / (o_z + |o|) - |i|' / (i_z + |i|)),
//       |w|' = (x^2 + y^2) / (2 |w|)
//   dP/dmetalness = (1 - ramp) L - S / pi              dQ/dmetalness = L (ramp - F_d)
//   dP/dL = metalness (1 - ramp)                       dQ/dL = (1 - metalness) F_d + metalness ramp
//   dP/droughness = dP/dL dL/dA 4 roughness^3 + (1 - metalness) / pi dS/droughness,
//       Q without the base layer's term
//   dS/droughness = 2 c^2 ((1 - o_z)^5 s(i_z) + (1 - i_z)^5 s(o_z))
//
// Directions are held constant; both lie above the surface.
#pragma once

#include "photograd/ops/fresnel_dielectric.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

/// What depends on directions alone.
template <class R>
struct PrincipledAngles {
    R o_z, i_z, o_side, i_side;  // side: x^2 + y^2
    R X, Z;                      // of wo + wi
    R two_c2, ramp, F_d;         // 2 c^2
    R o_ramp, i_ramp;            // (1 - z)^5

    static R fifth_power(R m) { return (m * m) * (m * m) * m; }

    static PrincipledAngles of(R o_x, R o_y, R o_z, R i_x, R i_y, R i_z) {
        PrincipledAngles w;
        const R x = o_x + i_x, y = o_y + i_y, z = o_z + i_z;
        w.o_z = o_z;
        w.i_z = i_z;
        w.o_side = o_x * o_x + o_y * o_y;
        w.i_side = i_x * i_x + i_y * i_y;
        w.X = x * x + y * y;
        w.Z = z * z;
        // Half the length of wo + wi is the cosine, for unit vectors.
        const R c2 = R(0.25) * (w.X + w.Z), c = sqrt(c2);
        w.two_c2 = R(2) * c2;
        w.ramp = fifth_power(R(1) - c);
        w.F_d = fresnel_dielectric(R(1.5), c);
        w.o_ramp = fifth_power(R(1) - o_z);
        w.i_ramp = fifth_power(R(1) - i_z);
        return w;
    }
};

/// f = base P + Q.
template <class R>
struct PrincipledTerms {
    R P, Q;
};

template <class R>
inline R principled_lobe(const PrincipledAngles<R>& w, R A) {
    const R o = w.o_z + sqrt(A * w.o_side + w.o_z * w.o_z);
    const R i = w.i_z + sqrt(A * w.i_side + w.i_z * w.i_z);
    const R n = w.X + w.Z, q = w.X + A * w.Z;
    return A * (n * n) * R(0.31830988618379067154) / (q * q * (o * i));
}

template <class R>
inline PrincipledTerms<R> principled(const PrincipledAngles<R>& w, R metalness, R roughness) {
    const R r2 = roughness * roughness, L = principled_lobe(w, r2 * r2), rest = R(1) - metalness;
    const R rise = roughness * w.two_c2 - R(0.5);
    const R S = (R(1) + rise * w.o_ramp) * (R(1) + rise * w.i_ramp);
    return {rest * S * R(0.31830988618379067154) + metalness * (R(1) - w.ramp) * L,
            L * (rest * w.F_d + metalness * w.ramp)};
}
template <class R>
inline void principled_backward(const PrincipledAngles<R>& w, R metalness, R roughness, R d_P,
                                R d_Q, R& d_metalness, R& d_roughness) {
    const R r2 = roughness * roughness, A = r2 * r2, rest = R(1) - metalness;
    const R o_length = sqrt(A * w.o_side + w.o_z * w.o_z);
    const R i_length = sqrt(A * w.i_side + w.i_z * w.i_z);
    const R n = w.X + w.Z, q = w.X + A * w.Z;
    const R L = A * (n * n) * R(0.31830988618379067154) /
                (q * q * ((w.o_z + o_length) * (w.i_z + i_length)));
    const R rise = roughness * w.two_c2 - R(0.5);
    const R s_o = R(1) + rise * w.o_ramp, s_i = R(1) + rise * w.i_ramp;
    d_metalness += d_P * ((R(1) - w.ramp) * L - s_o * s_i * R(0.31830988618379067154)) +
                   d_Q * (L * (w.ramp - w.F_d));
    const R d_L = d_P * metalness * (R(1) - w.ramp) + d_Q * (rest * w.F_d + metalness * w.ramp);
    // A dL/dA / L; dA/droughness = 4 A / roughness.
    const R slope =
        R(1) - A * (R(2) * w.Z / q + R(0.5) * w.o_side / (o_length * (w.o_z + o_length)) +
                    R(0.5) * w.i_side / (i_length * (w.i_z + i_length)));
    d_roughness += d_L * L * slope * R(4) / roughness + d_P * rest * R(0.31830988618379067154) *
                                                            w.two_c2 *
                                                            (w.o_ramp * s_i + w.i_ramp * s_o);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
