// The parameters of all layers that a glTF material may have [Khronos2021, Khronos2022]: the
// metallic-roughness core, and KHR_materials_specular, _ior, _anisotropy, _iridescence, _sheen,
// _clearcoat, _transmission and _dispersion. A layer whose factor is 0 is not there.
//
// The tangent of anisotropy is (anisotropy_x, anisotropy_y), of any length, turned by `rotation`: a
// texture of directions scales the two components.
#pragma once

#include "photograd/bsdf/ggx_lobe.h"

namespace photograd {

template <class R>
struct GltfLayers {
    Vec3<R> base_color{R(0.5)};
    R metalness{R(0)}, roughness{R(0.5)}, eta{R(1.5)}, specular_factor{R(1)};
    Vec3<R> specular_color_factor{R(1)};
    R anisotropy{R(0)}, rotation{R(0)}, anisotropy_x{R(1)}, anisotropy_y{R(0)};
    R iridescence_factor{R(0)}, iridescence_ior{R(1.3)}, iridescence_thickness{R(400)};
    Vec3<R> sheen_color_factor{R(0)};
    R sheen_roughness_factor{R(0.5)}, coat{R(0)}, coat_roughness{R(0.1)}, transmission{R(0)};
    R dispersion{R(0)};  // of volumes

    static constexpr auto described(double least_facet_roughness, double least_eta) {
        using L = GltfLayers;
        return describe(
            p("base_color", &L::base_color, 0.0, 1.0), p("metalness", &L::metalness, 0.0, 1.0),
            p("roughness", &L::roughness, least_facet_roughness, 1.0),
            p("eta", &L::eta, least_eta, 2.5), p("specular_factor", &L::specular_factor, 0.0, 1.0),
            p("specular_color_factor", &L::specular_color_factor, 0.0, 2.0),
            p("anisotropy", &L::anisotropy, 0.0, 1.0), p("rotation", &L::rotation, -pi, pi, "rad"),
            p("anisotropy_x", &L::anisotropy_x, -1.0, 1.0),
            p("anisotropy_y", &L::anisotropy_y, -1.0, 1.0),
            p("iridescence_factor", &L::iridescence_factor, 0.0, 1.0),
            p("iridescence_ior", &L::iridescence_ior, 1.1, 2.3),
            p("iridescence_thickness", &L::iridescence_thickness, 0.0, 1000.0, "nm"),
            p("sheen_color_factor", &L::sheen_color_factor, 0.0, 1.0),
            p("sheen_roughness_factor", &L::sheen_roughness_factor, 0.3, 1.0),
            p("coat", &L::coat, 0.0, 1.0),
            p("coat_roughness", &L::coat_roughness, least_roughness, 1.0),
            p("transmission", &L::transmission, 0.0, 1.0));
    }
    static constexpr auto described_volume(double least_facet_roughness, double least_eta) {
        return std::tuple_cat(described(least_facet_roughness, least_eta),
                              describe(p("dispersion", &GltfLayers::dispersion, 0.0, 2.0)));
    }
};

/// Whether x is 0, and stays 0 along its tangent: then a layer of this weight need not be computed.
template <class R>
bool vanishes(const R& x) {
    if constexpr (requires { x.tangent; })
        return x.value == 0.0 && x.tangent == 0.0;
    else
        return x == R(0);
}
template <class R>
bool vanishes(const Vec3<R>& v) {
    return vanishes(v.x) && vanishes(v.y) && vanishes(v.z);
}

/// The channel that is the largest, the first of several.
template <class R>
int largest_channel(const Vec3<R>& v) {
    const int first = v[1] > v[0] ? 1 : 0;
    return v[2] > v[first] ? 2 : first;
}

/// Both directions with wo above: z of both is flipped where it was below.
template <class R>
struct LayeredSides {
    Vec3<R> o, i;
    bool below, mirrored, possible;

    LayeredSides(const Vec3<R>& wo, const Vec3<R>& wi)
        : o(wo), i(wi), below(!(wo.z > R(0))), mirrored(false), possible(false) {
        if (below) {
            o.z = -o.z;
            i.z = -i.z;
        }
        mirrored = i.z > R(0);
        possible = o.z > R(0) && i.z != R(0);
    }
    /// The direction of the light on wo's side.
    [[nodiscard]] Vec3<R> i_above() const { return {i.x, i.y, mirrored ? i.z : -i.z}; }
};

}  // namespace photograd
