// Camera and policies of splatting, and the arrays of Gaussians. Plain data.
#pragma once

#include <cstdint>

namespace photograd {

struct SplatOptions {
    double low_pass = 0.3;     // pixel^2, added to the screen covariance
    bool antialiased = false;  // opacity compensation for the low-pass
    double alpha_min = 1.0 / 255.0;
    double alpha_max = 0.999;
    bool pass_clamped = false;   // derivative at alpha_max: 1 instead of 0
    double extent_sigmas = 0.0;  // half-size of a splat's box, in standard deviations; 0: off
    double stop = 1e-4;
    double near = 0.01;            // meters; what is closer, or behind the camera, is culled
    double frustum_margin = 0.15;  // widens the field of view, in image sizes, for the Jacobian
};

struct SplatImage {
    int width, height;
    double fx, fy, cx, cy;  // pixels
};

/// N Gaussians, each with K spherical-harmonic coefficients of three channels.
template <class R>
struct GaussianCloud {
    std::int64_t count;
    int degree;               // K = (degree + 1)^2
    const R* means;           // (N, 3)
    const R* log_scales;      // (N, 3)
    const R* quats;           // (N, 4), w x y z, any length
    const R* opacity_logits;  // (N,)
    const R* sh;              // (N, K, 3)
};

/// Derivatives, added to.
template <class R>
struct GaussianGradients {
    R* means;
    R* log_scales;
    R* quats;
    R* opacity_logits;
    R* sh;
    R* view;    // (3, 4) of camera_from_world, as twelve free numbers
    R* screen;  // (N, 2) of the screen means, per pixel: grad2d of density control
};

}  // namespace photograd
