// Rough dielectric with dispersion: rough_dielectric.h with an index of its own for each channel
// (ops/dispersion.h).
//
//   f_c = f(index_c, roughness)            df_c/dindex_c, df_c/droughness: rough_dielectric.h
//
// A sample follows the lobe of one channel, each as often; its density is the mean of the three. So
// all channels get all samples, weighed by their own f: where the lobes overlap little, of
// roughness 0.1 and strong dispersion, a third of the samples serve a channel.
#pragma once

#include "photograd/bsdf/rough_dielectric.h"
#include "photograd/ops/dispersion.h"

namespace photograd {

template <class R>
struct DispersiveDielectric {
    R eta{R(1.5)}, dispersion{R(0.3)}, roughness{R(0.4)};

    static constexpr const char* name = "dispersive_dielectric";
    static constexpr EnergyClaim energy = RoughDielectric<R>::energy;
    static constexpr bool reciprocal = true, transmits = true;
    static constexpr auto params =
        describe(p("eta", &DispersiveDielectric::eta, 1.2, 2.5),
                 p("dispersion", &DispersiveDielectric::dispersion, 0.0, 2.0),
                 p("roughness", &DispersiveDielectric::roughness, 0.1, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return {of(0).f(wo, wi).x, of(1).f(wo, wi).y, of(2).f(wo, wi).z};
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    DispersiveDielectric& d_self) const {
        Vec3<R> d_index(R(0));
        for (int c = 0; c < 3; ++c) {
            Vec3<R> d(R(0));
            d[c] = d_f[c];
            RoughDielectric<R> d_one{R(0), R(0)};
            of(c).f_backward(wo, wi, d, d_one);
            d_index[c] = d_one.eta;
            d_self.roughness += d_one.roughness;
        }
        channel_indices_backward(eta, dispersion, d_index, d_self.eta, d_self.dispersion);
    }

    Vec3<R> sample(const Vec3<R>& wo, Vec2<R> u2) const {
        int c = 0;
        while (c < 2 && !take_first(R(1) / R(3 - c), u2)) ++c;
        return of(c).sample(wo, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return (of(0).pdf(wo, wi) + of(1).pdf(wo, wi) + of(2).pdf(wo, wi)) * R(1.0 / 3);
    }
    Vec3<R> index_inside() const { return channel_indices(eta, dispersion); }

private:
    RoughDielectric<R> of(int channel) const { return {index_inside()[channel], roughness}; }
};

static_assert(Bsdf<DispersiveDielectric>);

}  // namespace photograd
