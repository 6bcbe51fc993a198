// Thin glass, a pane: two boundaries so close together that rays are neither displaced nor
// refracted.
//
// r = F(eta, |o_z|) at each boundary, t what one passage of the glass leaves (tint). Light that
// bounces n times inside adds a geometric series [Born1999, Sec. 7.6]:
//
//   through  T = (1 - r)^2 t sum_n (r t)^(2n) = (1 - r)^2 t / q,   q = 1 - r^2 t^2
//   back     B = r + r t T                                  for t = 1: 2 r / (1 + r), and T + B = 1
//
//   dT/dr = 2 (1 - r) t (r t^2 (1 - r) - q) / q^2      dT/dt = (1 - r)^2 (1 + r^2 t^2) / q^2
//   dB/dr = 1 + t T + r t dT/dr                        dB/dt = r T + r t dT/dt
#pragma once

#include "photograd/bsdf/delta.h"
#include "photograd/ops/fresnel_dielectric.h"

namespace photograd {

template <class R>
struct ThinGlass {
    R eta{R(1.5)};
    Vec3<R> tint{R(1)};

    static constexpr const char* name = "thin_glass";
    static constexpr std::size_t lobe_count = 2;
    static constexpr auto params =
        describe(p("eta", &ThinGlass::eta, 1.05, 2.5), p("tint", &ThinGlass::tint, 0.0, 1.0));

    /// Mirrored, then straight on.
    std::array<DeltaLobe<R>, 2> lobes(const Vec3<R>& wo) const {
        const R r = fresnel_dielectric(eta, wo.z > R(0) ? wo.z : -wo.z);
        Vec3<R> back, through;
        for (int c = 0; c < 3; ++c) {
            const R t = tint[c];
            through[c] = (R(1) - r) * (R(1) - r) * t / series(r * t);
            back[c] = r + r * t * through[c];
        }
        return {{{{-wo.x, -wo.y, wo.z}, back}, {-wo, through}}};
    }
    void lobes_backward(const Vec3<R>& wo, const std::array<DeltaLobe<R>, 2>& d_lobes,
                        ThinGlass& d_self) const {
        const R cosine = wo.z > R(0) ? wo.z : -wo.z, r = fresnel_dielectric(eta, cosine);
        const R rest = R(1) - r;
        R d_r = R(0), fixed = R(0);
        for (int c = 0; c < 3; ++c) {
            const R t = tint[c], q = series(r * t), T = rest * rest * t / q;
            const R d_B = d_lobes[0].weight[c], d_T = d_lobes[1].weight[c] + d_B * r * t;
            d_r += d_B * (R(1) + t * T) + d_T * R(2) * rest * t * (r * t * t * rest - q) / (q * q);
            d_self.tint[c] += d_B * r * T + d_T * rest * rest * (R(1) + r * r * t * t) / (q * q);
        }
        fresnel_dielectric_backward(eta, cosine, d_r, d_self.eta, fixed);
    }

private:
    /// q; not 0 at the horizon either, where r = 1 and nothing passes.
    static R series(R rt) { return larger(R(1) - rt * rt, R(1e-20)); }
};

static_assert(DeltaBsdf<ThinGlass>);

}  // namespace photograd
