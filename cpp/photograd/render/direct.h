// Direct light from a sun and a sky on diffuse surfaces, with shadow rays.
//
// A pixel is the mean over its samples of
//   sum over the two lights of  f(wo, wi) L(w) V cos(theta) / pdf
// where V is 1 if nothing stands in the way. The sun is sampled over its disc, the sky in proportion to the
// cosine. Where a ray misses everything it adds nothing: colours are premultiplied by alpha.
//
// The adjoint is the interior term only: derivatives of the integrand with respect to albedo and radiance,
// with visibility, positions and samples held constant. These are exact, as no edge depends on them. There
// are no derivatives with respect to geometry, the camera or the sun's direction, which move edges.
#pragma once

#include <cstdint>

#include "photograd/light/sky.h"
#include "photograd/light/sun.h"
#include "photograd/scene/scene.h"

namespace photograd {

/// A pinhole camera; axes as OpenCV has them, pixel centres at + 1/2.
struct PinholeView {
    int width, height;
    double fx, fy, cx, cy;
    double world_from_camera[12];  // three rows of four
};

struct DirectOptions {
    std::uint32_t samples;  // a pixel
    std::uint64_t seed;
};

template <class R>
struct DirectLights {
    Sun<R> sun;
    Sky<R> sky;
};

template <class R>
struct DirectOutputs {
    R* radiance;  // (H, W, 3) linear, premultiplied
    R* alpha;     // (H, W) the part of the samples that hit anything
    R* depth;     // (H, W) mean distance of those from the camera, infinite without any
};

/// The same bits for any number of threads; O(1) memory a ray.
template <Real R>
void render_direct(const Scene& scene, const R* colors, const DirectLights<R>& lights,
                   const PinholeView& view, const DirectOptions& options, const DirectOutputs<R>& out);

/// Adds to d_colors (A, 3) and to the radiances of d_lights; traces the same rays again.
template <Real R>
void render_direct_backward(const Scene& scene, const R* colors, const DirectLights<R>& lights,
                            const PinholeView& view, const DirectOptions& options,
                            const R* d_radiance, R* d_colors, DirectLights<R>& d_lights);

}  // namespace photograd
