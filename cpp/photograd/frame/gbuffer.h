// The G-buffer: what each pixel's surface is, kept to be lit later [Saito1990]; filled from a
// visibility buffer by the path tracer's own hits, textures, normal maps and materials.
#pragma once

#include <cstdint>

#include "photograd/camera/pinhole.h"
#include "photograd/scene/path_scene.h"

namespace photograd {

/// One entry a pixel. `normal` is geometric, turned to the viewer unless light may pass; `shading`
/// on the same side; `tangent` 0 where the material has no direction. A row holds the parameters of
/// the material, textures included; without rows all pixels of a material have its own.
template <class T>
struct GBuffer {
    std::int32_t* material;  // -1 where nothing is seen
    T *position, *normal, *shading, *tangent, *emission, *alpha;
    T* rows;
    int row_size;  // 0 for none
};

/// Which face each pixel sees (H, W), below 0 for none; and of each face (F,) the shape, and its
/// primitive there.
struct FaceTable {
    const std::int32_t *face, *shape, *primitive;
};

/// All of `out` is written.
template <Real R>
void fill_gbuffer(const PathScene<R>& scene, const Pinhole& camera, const FaceTable& table,
                  const GBuffer<R>& out);

/// Light that arrives: from wi (N, 3), a unit vector of the world, as irradiance (N, 3) of what
/// faces it. Adds f cos irradiance to out (N, 3); black rows cost nothing.
template <Real R>
void light_gbuffer(const PathScene<R>& scene, const Vec3<R>& eye, std::int64_t count,
                   const GBuffer<R>& in, const R* wi, const R* irradiance, R* out);

/// The same of parallel light that all surfaces see alike, from each of the directions wi (D, 3)
/// with its irradiance (D, 3), times the part `visible` (N,) of all of it.
template <Real R>
void light_gbuffer_parallel(const PathScene<R>& scene, const Vec3<R>& eye, std::int64_t count,
                            const GBuffer<R>& in, std::int64_t directions, const R* wi,
                            const R* irradiance, const R* visible, R* out);

/// Directions that the reflectance of the surfaces would choose, from u (N, 3): wi (N, 3), weight
/// f cos / pdf (N, 3), and pdf (N,), per steradian, 0 of specular surfaces. Weight 0 where a sample
/// fails.
template <Real R>
void sample_gbuffer(const PathScene<R>& scene, const Vec3<R>& eye, std::int64_t count,
                    const GBuffer<R>& in, const R* u, R* wi, R* weight, R* pdf);

/// The density (N,) with which `sample_gbuffer` chooses wi (N, 3).
template <Real R>
void gbuffer_pdf(const PathScene<R>& scene, const Vec3<R>& eye, std::int64_t count,
                 const GBuffer<R>& in, const R* wi, R* pdf);

}  // namespace photograd
