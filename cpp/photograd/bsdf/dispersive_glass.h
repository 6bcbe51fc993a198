// Smooth dielectric with dispersion: one reflected ray for all channels and a refracted ray for
// each.
//
//   mirrored      weight_c = F(e_c, |o_z|)
//   refracted c   weight = (1 - F) tint_c / e^2 in channel c, 0 in the others; wi by Snell
//
// e_c = index_c for a viewer outside and 1 / index_c inside: glass.h for each channel, with its
// derivatives, and the indices of ops/dispersion.h. A path that refracts follows one channel and is
// black in the others from there on. Under total reflection of blue alone, red and green still
// refract.
#pragma once

#include "photograd/bsdf/glass.h"
#include "photograd/ops/dispersion.h"

namespace photograd {

template <class R>
struct DispersiveGlass {
    R eta{R(1.5)}, dispersion{R(0.3)};
    Vec3<R> tint{R(1)};

    static constexpr const char* name = "dispersive_glass";
    static constexpr std::size_t lobe_count = 4;
    static constexpr auto params = describe(p("eta", &DispersiveGlass::eta, 1.05, 2.5),
                                            p("dispersion", &DispersiveGlass::dispersion, 0.0, 2.0),
                                            p("tint", &DispersiveGlass::tint, 0.0, 1.0));

    /// Mirrored, then refracted in red, green and blue.
    std::array<DeltaLobe<R>, 4> lobes(const Vec3<R>& wo) const {
        std::array<DeltaLobe<R>, 4> all{};
        for (int c = 0; c < 3; ++c) {
            const std::array<DeltaLobe<R>, 2> one = of(c).lobes(wo);
            DeltaLobe<R>& through = all[static_cast<std::size_t>(1 + c)];
            all[0].wi = one[0].wi;
            all[0].weight[c] = one[0].weight[c];
            through.wi = one[1].wi;
            through.weight[c] = one[1].weight[c];
        }
        return all;
    }
    void lobes_backward(const Vec3<R>& wo, const std::array<DeltaLobe<R>, 4>& d_lobes,
                        DispersiveGlass& d_self) const {
        Vec3<R> d_index(R(0));
        for (int c = 0; c < 3; ++c) {
            const DeltaLobe<R>& d_through = d_lobes[static_cast<std::size_t>(1 + c)];
            std::array<DeltaLobe<R>, 2> d_one{};
            d_one[0].weight[c] = d_lobes[0].weight[c];
            d_one[1].weight[c] = d_through.weight[c];
            d_one[1].wi = d_through.wi;
            Glass<R> d_glass{R(0), Vec3<R>(R(0))};
            of(c).lobes_backward(wo, d_one, d_glass);
            d_index[c] = d_glass.eta;
            d_self.tint += d_glass.tint;
        }
        channel_indices_backward(eta, dispersion, d_index, d_self.eta, d_self.dispersion);
    }

private:
    Glass<R> of(int channel) const { return {channel_indices(eta, dispersion)[channel], tint}; }
};

static_assert(DeltaBsdf<DispersiveGlass>);

}  // namespace photograd
