// A perfect mirror: one direction, scaled by a color.
//
//   wi = (-o_x, -o_y, o_z),   weight = reflectance        dweight/dreflectance = 1
#pragma once

#include "photograd/bsdf/delta.h"

namespace photograd {

template <class R>
struct Mirror {
    Vec3<R> reflectance{R(0.9)};

    static constexpr const char* name = "mirror";
    static constexpr std::size_t lobe_count = 1;
    static constexpr auto params = describe(p("reflectance", &Mirror::reflectance, 0.0, 1.0));

    /// The back of a mirror is black.
    std::array<DeltaLobe<R>, 1> lobes(const Vec3<R>& wo) const {
        if (!(wo.z > R(0))) return {};
        return {{{{-wo.x, -wo.y, wo.z}, reflectance}}};
    }
    void lobes_backward(const Vec3<R>& wo, const std::array<DeltaLobe<R>, 1>& d_lobes,
                        Mirror& d_self) const {
        if (wo.z > R(0)) d_self.reflectance += d_lobes[0].weight;
    }
};

static_assert(DeltaBsdf<Mirror>);

}  // namespace photograd
