// Lambert's diffuse reflection: equal radiance in all directions.
//
//   f = albedo / pi             the integral of f cos over the hemisphere is albedo
//   df/dalbedo = 1 / pi         each channel on its own
#pragma once

#include "photograd/bsdf/bsdf.h"
#include "photograd/sampling/warp.h"

namespace photograd {

template <class R>
struct Lambert {
    Vec3<R> albedo{R(0.5)};

    static constexpr const char* name = "lambert";
    static constexpr EnergyClaim energy{Energy::conserving, 1.0};
    static constexpr bool reciprocal = true;
    static constexpr auto params = describe(p("albedo", &Lambert::albedo, 0.0, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const bool lit = wo.z > R(0) && wi.z > R(0);
        return albedo * (lit ? R(1 / pi) : R(0));
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    Lambert& d_self) const {
        const bool lit = wo.z > R(0) && wi.z > R(0);
        d_self.albedo += d_f * (lit ? R(1 / pi) : R(0));
    }

    /// In proportion to the cosine, hence to f cos: every sample has the weight albedo.
    Vec3<R> sample(const Vec3<R>&, const Vec2<R>& u2) const {
        return square_to_cosine_hemisphere(u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return wo.z > R(0) ? cosine_hemisphere_pdf(wi) : R(0);
    }
};

static_assert(Bsdf<Lambert>);

}  // namespace photograd
