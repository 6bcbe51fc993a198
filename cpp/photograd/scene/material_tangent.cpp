#include "photograd/scene/material_tangent.h"

namespace photograd {

Vec3<double> value_tangent(const Material<double>& material, const Material<double>& along,
                           const Vec3<double>& wo, const Vec3<double>& wi, int lobe) {
    return bsdf_tangents[material.model].value(material.parameter, along.parameter, wo, wi, lobe);
}

Material<double> textured_tangent(const Material<double>& base, const Material<double>& along,
                                  std::span<const TextureUse> uses, const SurfaceTextures& textures,
                                  std::span<const double* const> texels,
                                  std::span<const double* const> along_texels,
                                  const Vec2<double>& uv, const Footprint<double>& footprint) {
    double value[max_parameters], change[max_parameters];
    base.get(value);
    along.get(change);
    for (const TextureUse& use : uses) {
        const auto t = static_cast<std::size_t>(use.texture);
        const TextureLayout& layout = textures.layouts[t];
        double color[max_channels], d_color[max_channels];
        const double level = layout.level_of(footprint);
        layout.look_up(texels[t], layout.inside(uv), level, color);
        layout.look_up(along_texels[t], layout.inside(uv), level, d_color);
        for (int i = 0; i < use.count; ++i) {
            const int k = use.first + i, c = use.channel + i;
            const double p = value[k] * color[c];
            const bool cut = p < use.lo || p > use.hi;
            change[k] = cut ? 0.0 : change[k] * color[c] + value[k] * d_color[c];
        }
    }
    Material<double> own = along;
    own.set(change);
    return own;
}

}  // namespace photograd
