// Blinn-Phong: a power of the cosine between normal and half vector, over a diffuse base
// layer [Blinn1977].
//
//   c = h_z,  f = diffuse / pi + specular N c^n
//
//   exact     N = (n + 2) (n + 4) / (8 pi (2^(-n/2) + n))
//       makes the highlight's albedo `specular` for a view along the normal; see below
//   fitted    N = (n + 8) / (8 pi)      shorter, up to 7.6 % too bright [AkenineMoeller2008, Ch. 7]
//
// The integral for a view along the normal: with t = h_z, i_z = 2 t^2 - 1 and
// dwi = 4 t dwh = 8 pi t dt,
//
//   1/N = 8 pi int_{1/sqrt 2}^1 t^n (2 t^2 - 1) t dt = 8 pi (n + 2^(-n/2)) / ((n + 2) (n + 4))
//
// To look as wide as a highlight of Phong's, n must be about four times his: the half vector turns
// half as far. Nothing keeps diffuse + specular below 1: the sum can double light.
//
//   df/dn = specular N c^n (ln c + dlnN/dn)
//   exact     dlnN/dn = 1 / (n + 2) + 1 / (n + 4) - (1 - (ln2 / 2) 2^(-n/2)) / (2^(-n/2) + n)
//   fitted    dlnN/dn = 1 / (n + 8)
#pragma once

#include "photograd/bsdf/half_vector.h"
#include "photograd/sampling/vndf.h"

namespace photograd {

enum class BlinnNorm { exact, fitted };

template <class R, BlinnNorm Norm>
struct BlinnPhongModel {
    Vec3<R> diffuse{R(0.4)}, specular{R(0.4)};
    R exponent{R(80)};

    static constexpr bool exact = Norm == BlinnNorm::exact;
    static constexpr const char* name = exact ? "blinn_phong" : "blinn_phong_fitted";
    static constexpr EnergyClaim energy{Energy::gains, exact ? 2.0 : 2.08};
    static constexpr bool reciprocal = true;
    static constexpr auto params = describe(p("diffuse", &BlinnPhongModel::diffuse, 0.0, 1.0),
                                            p("specular", &BlinnPhongModel::specular, 0.0, 1.0),
                                            p("exponent", &BlinnPhongModel::exponent, 1.0, 800.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        return diffuse * R(1 / pi) + specular * lobe(half_vector(wo, wi));
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    BlinnPhongModel& d_self) const {
        if (!both_above(wo, wi)) return;
        const Vec3<R> wh = half_vector(wo, wi);
        const R value = lobe(wh);
        d_self.diffuse += d_f * R(1 / pi);
        d_self.specular += d_f * value;
        d_self.exponent += dot(d_f, specular) * value * (log(wh.z) + log_norm_slope());
    }

    /// Half of the samples for the base layer, half for the highlight.
    Vec3<R> sample(const Vec3<R>& wo, Vec2<R> u2) const {
        if (take_first(R(0.5), u2)) return square_to_cosine_hemisphere(u2);
        return reflect(wo, sample_cosine_power(exponent, u2));
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return R(0);
        const Vec3<R> wh = half_vector(wo, wi);
        return R(0.5) * cosine_hemisphere_pdf(wi) +
               R(0.5) * reflected_pdf(wo, wh, cosine_power_pdf(exponent, wh.z));
    }

private:
    [[nodiscard]] R half_power() const { return exp(R(-0.5 * ln2) * exponent); }  // 2^(-n/2)
    R lobe(const Vec3<R>& wh) const {
        const R n = exponent, power = pow(wh.z, n) * R(0.125 / pi);
        return power * (exact ? (n + R(2)) * (n + R(4)) / (half_power() + n) : n + R(8));
    }
    [[nodiscard]] R log_norm_slope() const {
        const R n = exponent, small = half_power();
        return exact ? R(1) / (n + R(2)) + R(1) / (n + R(4)) -
                           (R(1) - R(0.5 * ln2) * small) / (small + n)
                     : R(1) / (n + R(8));
    }
    static constexpr double ln2 = 0.69314718055994530942;
};

template <class R>
using BlinnPhong = BlinnPhongModel<R, BlinnNorm::exact>;
template <class R>
using BlinnPhongFitted = BlinnPhongModel<R, BlinnNorm::fitted>;

static_assert(Bsdf<BlinnPhong> && Bsdf<BlinnPhongFitted>);

}  // namespace photograd
