// The metallic-roughness model with KHR_materials_transmission and no volume [Khronos2022]: thin
// sheets. Their two boundaries are so close together that light is not displaced or refracted, only
// scattered by the roughness.
//
//   L = D V of wo and, for what passes, of wi mirrored to wo's side
//       GGX as in gltf.h, alpha_ggx = roughness^2
//   ramp = (1 - <wo, wh>)^5,   F_d = f0 + (1 - f0) ramp,   f0 = ((eta - 1) / (eta + 1))^2
//   F_m = base_color + (1 - base_color) ramp
//
//   mirrored  f = (1 - metalness) (F_d L + (1 - transmission) (1 - F_d) base_color / pi)
//                 + metalness F_m L
//   through   f = (1 - metalness) transmission (1 - F_d) base_color L
//
// Of what the coating leaves, `transmission` passes and the rest reaches the diffuse base layer.
// With transmission 0 and eta 1.5 the front is gltf.h; both sides are alike. A metal lets nothing
// through. White returns at most F_d + (1 - F_d) of L, and with a base layer what gltf.h says: at
// the horizon, for eta 1, 0.972 + 1.
//
// By each parameter, with w = 1 - metalness, on either side of | :
//
//   df/dbase_color = w (1 - transmission) (1 - F_d) / pi + metalness (1 - ramp) L
//       | w transmission (1 - F_d) L
//   df/dtransmission = -w (1 - F_d) base_color / pi           | w (1 - F_d) base_color L
//   df/dF_d = w (L - (1 - transmission) base_color / pi)      | -w transmission base_color L
//   df/dL = w F_d + metalness F_m                             | w transmission (1 - F_d) base_color
#pragma once

#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/ops/fresnel_schlick.h"

namespace photograd {

template <class R>
struct GltfTransmission {
    Vec3<R> base_color{R(0.5)};
    R metalness{R(0)}, roughness{R(0.5)}, transmission{R(1)}, eta{R(1.5)};

    static constexpr const char* name = "gltf_transmission";
    static constexpr EnergyClaim energy{Energy::gains, 1.98};
    static constexpr bool reciprocal = true, transmits = true;
    static constexpr auto params =
        describe(p("base_color", &GltfTransmission::base_color, 0.0, 1.0),
                 p("metalness", &GltfTransmission::metalness, 0.0, 1.0),
                 p("roughness", &GltfTransmission::roughness, least_roughness, 1.0),
                 p("transmission", &GltfTransmission::transmission, 0.0, 1.0),
                 p("eta", &GltfTransmission::eta, 1.0, 2.5));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const Sheet s(wo, wi, roughness, eta);
        if (!s.possible) return Vec3<R>(R(0));
        const R rest = R(1) - metalness;
        if (!s.mirrored) return base_color * (rest * transmission * (R(1) - s.F) * s.lobe);
        return rest * dielectric(s) + metalness * (schlick(base_color, s.cosine) * s.lobe);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    GltfTransmission& d_self) const {
        const Sheet s(wo, wi, roughness, eta);
        if (!s.possible) return;
        const R rest = R(1) - metalness, left = R(1) - s.F, colored = dot(d_f, base_color);
        R d_F = R(0), d_lobe = R(0), fixed_f90 = R(0), fixed_cosine = R(0), d_f0 = R(0);
        if (s.mirrored) {
            const R all = d_f.x + d_f.y + d_f.z, diffuse = (R(1) - transmission) * R(1 / pi);
            const Vec3<R> F_m = schlick(base_color, s.cosine);
            d_self.base_color += d_f * (rest * diffuse * left);
            schlick_backward(s.cosine, d_f * (metalness * s.lobe), d_self.base_color);
            d_self.metalness += dot(d_f, F_m * s.lobe - dielectric(s));
            d_self.transmission -= rest * left * colored * R(1 / pi);
            d_F = rest * (all * s.lobe - diffuse * colored);
            d_lobe = rest * s.F * all + metalness * dot(d_f, F_m);
        } else {
            d_self.base_color += d_f * (rest * transmission * left * s.lobe);
            d_self.metalness -= transmission * left * colored * s.lobe;
            d_self.transmission += rest * left * colored * s.lobe;
            d_F = -rest * transmission * colored * s.lobe;
            d_lobe = rest * transmission * left * colored;
        }
        schlick_backward(schlick_f0(eta), R(1), s.cosine, d_F, d_f0, fixed_f90, fixed_cosine);
        schlick_f0_backward(eta, d_f0, d_self.eta);
        ggx_lobe_backward(s.o, s.i, roughness, d_lobe, d_self.roughness);
    }

    /// Each of the three ways gets some samples, since the derivatives need all of them. A facet
    /// that sends light into the wrong half loses it: a direction in the horizon, of no density.
    Vec3<R> sample(const Vec3<R>& wo, Vec2<R> u2) const {
        const R side = wo.z > R(0) ? R(1) : R(-1);
        const Vec3<R> o(wo.x, wo.y, wo.z * side);
        const bool through = take_first(through_share(), u2);
        const R to_base = through ? R(0) : diffuse_probability() / (R(1) - through_share());
        const Vec3<R> i = sample_base_and_lobe(o, to_base, roughness, u2);
        if (!(i.z > R(0))) return {R(1), R(0), R(0)};
        return {i.x, i.y, through ? -side * i.z : side * i.z};
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (wo.z == R(0) || wi.z == R(0)) return R(0);
        const Vec3<R> o(wo.x, wo.y, absolute(wo.z)), i(wi.x, wi.y, absolute(wi.z));
        const R lobe = ggx_lobe_pdf(o, i, roughness);
        if (!(wo.z * wi.z > R(0))) return through_share() * lobe;
        return diffuse_probability() * cosine_hemisphere_pdf(i) +
               (R(1) - through_share() - diffuse_probability()) * lobe;
    }
    Vec3<R> index_inside() const { return Vec3<R>(R(1)); }

private:
    static R absolute(R x) { return x < R(0) ? -x : x; }
    /// Both directions mirrored above the sheet, and the terms that they determine.
    struct Sheet {
        Vec3<R> o, i;
        R cosine{R(0)}, lobe{R(0)}, F{R(0)};
        bool mirrored, possible;

        Sheet(const Vec3<R>& wo, const Vec3<R>& wi, R roughness, R eta)
            : o(wo.x, wo.y, absolute(wo.z)),
              i(wi.x, wi.y, absolute(wi.z)),
              mirrored(wo.z * wi.z > R(0)),
              possible(both_above(o, i)) {
            if (!possible) return;
            cosine = dot(o, half_vector(o, i));
            lobe = ggx_lobe(o, i, roughness);
            F = schlick(schlick_f0(eta), R(1), cosine);
        }
    };
    Vec3<R> dielectric(const Sheet& s) const {
        return base_color * ((R(1) - transmission) * (R(1) - s.F) * R(1 / pi)) +
               Vec3<R>(s.F * s.lobe);
    }
    [[nodiscard]] R through_share() const {
        return R(0.1) + R(0.6) * (R(1) - metalness) * transmission;
    }
    [[nodiscard]] R diffuse_probability() const {
        return R(0.1) + R(0.4) * (R(1) - metalness) * (R(1) - transmission);
    }
};

static_assert(Bsdf<GltfTransmission>);

}  // namespace photograd
