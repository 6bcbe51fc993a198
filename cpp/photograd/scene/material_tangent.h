// The directional derivative of a material along its parameters: forward mode, the transpose of
// value_backward.
//
//   t(f) = sum_i df/dp_i v_i
//       v: a material of the same model, which holds the change of each parameter
//
// The model runs on dual numbers (core/dual.h). wo, wi and the lobe are held fixed, as
// value_backward holds them: of a refracted lobe only the weight changes.
#pragma once

#include "photograd/scene/textured.h"

namespace photograd {

/// t(value) of `material.value(wo, wi, lobe)` along `along`.
Vec3<double> value_tangent(const Material<double>& material, const Material<double>& along,
                           const Vec3<double>& wo, const Vec3<double>& wi, int lobe);

/// Of `textured`, how the material at one point changes: with p = clamp(value x, lo, hi) for a
/// texture's x,
///   t(p) = t(value) x + value t(x),    0 where p is cut off
Material<double> textured_tangent(const Material<double>& base, const Material<double>& along,
                                  std::span<const TextureUse> uses, const SurfaceTextures& textures,
                                  std::span<const double* const> texels,
                                  std::span<const double* const> along_texels,
                                  const Vec2<double>& uv, const Footprint<double>& footprint);

}  // namespace photograd
