// A specular boundary of a clear medium: a reflected ray, and a refracted one through a tint.
//
// eta is the index inside over outside; e = eta for a viewer outside (o_z > 0) and 1 / eta inside.
//
//   mirrored    weight = F(e, |o_z|)                        Fresnel
//   refracted   weight = (1 - F) tint / e^2                  wi by Snell
//
// The 1 / e^2: radiance is per solid angle, and a cone of rays widens by e^2 where it enters the
// rarer medium. What a boundary keeps is L / index^2 [Born1999]; there and back again the factors
// cancel.
//
//   dF/deta: ops/fresnel_dielectric.h      dwi/deta: ops/refract.h
//       de/deta = 1, or -1 / eta^2 from inside
//   dweight/dtint = (1 - F) / e^2          dweight/de = -dF/de tint / e^2 - 2 (1 - F) tint / e^3
#pragma once

#include "photograd/bsdf/delta.h"
#include "photograd/ops/refract.h"

namespace photograd {

template <class R>
struct Glass {
    R eta{R(1.5)};
    Vec3<R> tint{R(1)};

    static constexpr const char* name = "glass";
    static constexpr std::size_t lobe_count = 2;
    static constexpr auto params =
        describe(p("eta", &Glass::eta, 1.05, 2.5), p("tint", &Glass::tint, 0.0, 1.0));

    /// Mirrored, then refracted.
    std::array<DeltaLobe<R>, 2> lobes(const Vec3<R>& wo) const {
        const R e = far_over_near(wo), c = wo.z > R(0) ? wo.z : -wo.z;
        const R F = fresnel_dielectric(e, c);
        const Vec3<R> mirrored(-wo.x, -wo.y, wo.z);
        if (!(refracted_cos_squared(e, c) > R(0))) return {{{mirrored, Vec3<R>(F)}, {}}};
        return {{{mirrored, Vec3<R>(F)}, {refract(wo, e), tint * ((R(1) - F) / (e * e))}}};
    }
    void lobes_backward(const Vec3<R>& wo, const std::array<DeltaLobe<R>, 2>& d_lobes,
                        Glass& d_self) const {
        const R e = far_over_near(wo), c = wo.z > R(0) ? wo.z : -wo.z;
        if (!(refracted_cos_squared(e, c) > R(0))) return;  // F = 1, whatever eta
        const R through = (R(1) - fresnel_dielectric(e, c)) / (e * e);
        const Vec3<R>& d_weight = d_lobes[1].weight;
        const R d_through = dot(d_weight, tint);
        d_self.tint += d_weight * through;
        Vec3<R> fixed_o(R(0));
        R d_e = R(-2) * d_through * through / e, fixed_c = R(0);
        const R d_F =
            d_lobes[0].weight.x + d_lobes[0].weight.y + d_lobes[0].weight.z - d_through / (e * e);
        fresnel_dielectric_backward(e, c, d_F, d_e, fixed_c);
        refract_backward(wo, e, d_lobes[1].wi, fixed_o, d_e);
        d_self.eta += wo.z > R(0) ? d_e : -d_e * (e * e);
    }

private:
    R far_over_near(const Vec3<R>& wo) const { return wo.z > R(0) ? eta : R(1) / eta; }
};

static_assert(DeltaBsdf<Glass>);

}  // namespace photograd
