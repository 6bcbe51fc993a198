// Phong: a power of the cosine to the mirrored view, over a diffuse base layer.
//
//   r = (-o_x, -o_y, o_z)       wo, mirrored at the normal
//   c = max(<r, wi>, 0)
//   f = diffuse / pi + specular N c^n / m
//
//   cosine cancelled   N = (n + 1) / (2 pi), m = i_z
//       the light's cosine does not dim the highlight [Phong1975]
//   reciprocal         N = (n + 2) / (2 pi), m = 1        "modified Phong" [Lafortune1994, Sec. 3]
//
// Either N makes the highlight's albedo `specular` for a view along the normal, and less from the
// side, where part of the lobe lies below the surface. Nothing keeps diffuse + specular below 1:
// the model is not energy-conserving.
//
//   df/ddiffuse = 1 / pi        df/dspecular = N c^n / m
//   df/dn = specular c^n / m (dN/dn + N ln c),      dN/dn = 1 / (2 pi)
#pragma once

#include "photograd/bsdf/half_vector.h"
#include "photograd/core/frame.h"
#include "photograd/sampling/vndf.h"

namespace photograd {

enum class PhongForm { cosine_cancelled, reciprocal };

template <class R, PhongForm Form>
struct PhongModel {
    Vec3<R> diffuse{R(0.4)}, specular{R(0.4)};
    R exponent{R(20)};

    static constexpr bool reciprocal = Form == PhongForm::reciprocal;
    static constexpr const char* name = reciprocal ? "phong_reciprocal" : "phong";
    static constexpr EnergyClaim energy{Energy::gains, 2.0};
    static constexpr auto params = describe(p("diffuse", &PhongModel::diffuse, 0.0, 1.0),
                                            p("specular", &PhongModel::specular, 0.0, 1.0),
                                            p("exponent", &PhongModel::exponent, 1.0, 200.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        return diffuse * R(1 / pi) + specular * lobe(wo, wi);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    PhongModel& d_self) const {
        if (!both_above(wo, wi)) return;
        d_self.diffuse += d_f * R(1 / pi);
        d_self.specular += d_f * lobe(wo, wi);
        const R c = mirrored_cos(wo, wi);
        if (c > R(0))  // N c^n (ln c + dN/dn / N)
            d_self.exponent += dot(d_f, specular) * lobe(wo, wi) *
                               (log(c) + R(1) / (exponent + R(reciprocal ? 2 : 1)));
    }

    /// Half of the samples for the base layer, half for the highlight.
    Vec3<R> sample(const Vec3<R>& wo, Vec2<R> u2) const {
        if (take_first(R(0.5), u2)) return square_to_cosine_hemisphere(u2);
        const Frame<R> around = Frame<R>::from_normal({-wo.x, -wo.y, wo.z});
        return around.to_world(sample_cosine_power(exponent, u2));
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return R(0);
        return R(0.5) * cosine_hemisphere_pdf(wi) +
               R(0.5) * cosine_power_pdf(exponent, mirrored_cos(wo, wi));
    }

private:
    static R mirrored_cos(const Vec3<R>& wo, const Vec3<R>& wi) {
        return wo.z * wi.z - wo.x * wi.x - wo.y * wi.y;
    }
    R lobe(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const R c = mirrored_cos(wo, wi);
        if (!(c > R(0))) return R(0);
        const R power = pow(c, exponent) * R(0.5 / pi);
        return reciprocal ? power * (exponent + R(2)) : power * (exponent + R(1)) / wi.z;
    }
};

template <class R>
using Phong = PhongModel<R, PhongForm::cosine_cancelled>;
template <class R>
using PhongReciprocal = PhongModel<R, PhongForm::reciprocal>;

static_assert(Bsdf<Phong> && Bsdf<PhongReciprocal>);

}  // namespace photograd
