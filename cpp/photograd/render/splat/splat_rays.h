// Gaussians along any rays, not only those of a pinhole camera [MoenneLoccoz2024], and the adjoint.
//
// Both passes walk a ray with splat/ray_walk.h and store nothing of it. The backward pass has two
// owners. A ray owns the derivatives with respect to its origin and direction. A Gaussian owns
// those with respect to its parameters: the ray's second walk leaves a record of three numbers for
// each crossing, the records of a slab of rays are sorted by Gaussian, and each Gaussian sums its
// records in the order of the rays. No sum depends on the number of threads.
#pragma once

#include <span>
#include <vector>

#include "photograd/splat/ray_cloud.h"
#include "photograd/splat/rendered_image.h"

namespace photograd {

/// State of both passes. Holds copies of rays and shapes, so that the second walk cannot differ
/// from the first.
template <class R>
struct RayFrame {
    RayCloud<R> cloud;
    R background[3];
    std::vector<R> origins, directions;    // (R, 3)
    std::vector<std::uint32_t> crossings;  // (R,) number of Gaussians that each ray blended

    [[nodiscard]] std::int64_t rays() const { return static_cast<std::int64_t>(crossings.size()); }
};

/// Gradients, added to; those of the rays only where the pointers are not null.
template <class R>
struct RayGradients {
    GaussianGradients<R> gaussians;  // without view and screen
    R* background;                   // (3,)
    R *origins, *directions;         // (R, 3)
};

/// Renders into `out` and counts the crossings of frame.
template <class R>
void blend_rays(const GaussianCloud<R>& cloud, RayFrame<R>& frame, const RenderedImage<R>& out);
/// `image` is what blend_rays wrote.
template <class R>
void blend_rays_backward(const GaussianCloud<R>& cloud, const RayFrame<R>& frame,
                         const RenderedImage<R>& image, const ImageCotangents<R>& d_image,
                         const RayGradients<R>& out);

}  // namespace photograd
