// Direct light: what a camera sees of surfaces lit by the sun and the sky, with shadows.
//
// For a hit with albedo a, one sample of each light (detached: where to look does not depend on a or L),
//
//   sun:  w drawn on the disc,                     contribution f(wo, w) cos L_sun(w) V(w) / pdf(w)
//   sky:  w drawn by the BSDF (cosine lobe),       contribution f(wo, w) cos L_sky(w) V(w) / pdf(w)
//
// where V is 1 if the ray towards w meets nothing. The two are different lights, each with its one good
// sampling, so nothing is counted twice. A pixel is the mean over `spp` samples, stratified over its area,
// the disc of the sun and the lobe (pixel_strata.h);
// radiance is premultiplied: a sample that meets no surface counts as 0 and lowers alpha.
//
// Every term is linear in the albedo and in the lights' radiances, and the adjoint is f_backward and
// L_backward on the same samples. Visibility and positions are held fixed: moving a shadow's edge or a
// silhouette changes the image too, and that part is not in this gradient (interior term only).
#pragma once

#include <cstdint>
#include <span>

#include "photograd/camera/pinhole.h"
#include "photograd/light/sky.h"
#include "photograd/light/sun.h"
#include "photograd/scene/surfaces.h"

namespace photograd {

template <Real R>
struct DirectScene {
    const Bvh* bvh;
    std::span<const AlbedoLayout> layouts;  // one a mesh
    const R* albedo;                        // (A, 3)
    std::int64_t albedo_count;
    Sun<R> sun;
    Sky<R> sky;
};

struct DirectOptions {
    int spp = 64;
    std::uint64_t seed = 0;
};

template <Real R>
struct DirectImage {
    R* radiance;  // (H, W, 3) premultiplied
    R* alpha;     // (H, W)
    R* depth;     // (H, W) mean of hit * distance
};

template <Real R>
void render_direct(const DirectScene<R>& scene, const Pinhole& camera, const DirectOptions& options,
                   const DirectImage<R>& image);

/// Adds to d_albedo (A, 3) and to the lights' radiances, for dL/dradiance (H, W, 3).
template <Real R>
void render_direct_backward(const DirectScene<R>& scene, const Pinhole& camera,
                            const DirectOptions& options, const R* d_radiance, R* d_albedo,
                            Sun<R>& d_sun, Sky<R>& d_sky);

}  // namespace photograd
