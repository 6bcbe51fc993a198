// The base layer of Burley's principled model [Burley2012, Sec. 5.3 and its code]: diffuse
// reflection, its approximation of subsurface scattering, and the hue of a color.
//
//   e = 1 + <wo, wi> = 2 <wi, wh>^2,   m(c) = (1 - c)^5
//   s(c, f90) = 1 + (f90 - 1) m(c),   P(f90) = s(o_z, f90) s(i_z, f90)
//   a = P(1/2 + roughness e)                                              diffuse
//   b = 1.25 (P(roughness e / 2) (1 / (o_z + i_z) - 1/2) + 1/2)    as if from inside [Hanrahan1993]
//   diffuse = (1 - subsurface) a + subsurface b                           times base_color / pi
//
//   dP/df90 = m(o_z) s(i_z) + s(o_z) m(i_z)        ddiffuse/dsubsurface = b - a
//
//   hue = base_color / y,   y = 0.3 red + 0.6 green + 0.1 blue            white for black
//   dhue_c/dbase_k = [c = k] / y - base_c w_k / y^2
#pragma once

#include "photograd/bsdf/half_vector.h"
#include "photograd/ops/fresnel_schlick.h"

namespace photograd::disney {

/// P(f90) and its derivative.
template <class R>
struct Ramps {
    R value, slope;

    static Ramps of(R cos_o, R cos_i, R f90) {
        const R out = schlick(R(1), f90, cos_o), in = schlick(R(1), f90, cos_i);
        return {out * in, schlick_ramp(cos_o) * in + out * schlick_ramp(cos_i)};
    }
};

template <class R>
R diffuse(const Vec3<R>& wo, const Vec3<R>& wi, R roughness, R subsurface) {
    const R e = R(1) + dot(wo, wi), inside = R(1) / (wo.z + wi.z) - R(0.5);
    const R a = Ramps<R>::of(wo.z, wi.z, R(0.5) + roughness * e).value;
    const R b = Ramps<R>::of(wo.z, wi.z, R(0.5) * roughness * e).value;
    return a + subsurface * (R(1.25) * (b * inside + R(0.5)) - a);
}
template <class R>
void diffuse_backward(const Vec3<R>& wo, const Vec3<R>& wi, R roughness, R subsurface, R d_diffuse,
                      R& d_roughness, R& d_subsurface) {
    const R e = R(1) + dot(wo, wi), inside = R(1) / (wo.z + wi.z) - R(0.5);
    const Ramps<R> a = Ramps<R>::of(wo.z, wi.z, R(0.5) + roughness * e);
    const Ramps<R> b = Ramps<R>::of(wo.z, wi.z, R(0.5) * roughness * e);
    d_subsurface += d_diffuse * (R(1.25) * (b.value * inside + R(0.5)) - a.value);
    d_roughness +=
        d_diffuse * e * ((R(1) - subsurface) * a.slope + subsurface * R(0.625) * inside * b.slope);
}

template <class R>
R luminance(const Vec3<R>& color) {
    return R(0.3) * color.x + R(0.6) * color.y + R(0.1) * color.z;
}
template <class R>
Vec3<R> hue(const Vec3<R>& color) {
    const R y = luminance(color);
    return y > R(0) ? color * (R(1) / y) : Vec3<R>(R(1));
}
template <class R>
void hue_backward(const Vec3<R>& color, const Vec3<R>& d_hue, Vec3<R>& d_color) {
    const R y = luminance(color);
    if (!(y > R(0))) return;
    d_color += d_hue * (R(1) / y) - Vec3<R>(R(0.3), R(0.6), R(0.1)) * (dot(d_hue, color) / (y * y));
}

}  // namespace photograd::disney
