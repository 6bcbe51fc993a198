// Gaussian splatting [Kerbl2023]: project, sort, bin, blend; and the adjoint of all of it.
//
// The backward pass is owner-computes: a tile writes the partial derivatives of each of its splats
// to the slot of that pair, then a splat sums its slots in their order. No two threads write one
// number, and the sums do not depend on the number of threads.
#pragma once

#include <vector>

#include "photograd/splat/bin.h"
#include "photograd/splat/project.h"

namespace photograd {

/// State of both passes: the splats of all Gaussians and the lists of the tiles.
template <class R>
struct SplatFrame {
    SplatView<R> view;
    R background[3];
    std::vector<ScreenSplat<R>> splats;
    TileLists lists;
};

/// Projects, sorts and bins; throws RangeError for parameters that are not finite.
template <class R>
SplatFrame<R> prepare_splats(const GaussianCloud<R>& cloud, const SplatImage& image,
                             const SplatOptions& options, const R* camera_from_world,
                             const R* background);

template <class R>
void blend_splats(const SplatFrame<R>& frame, const RenderedImage<R>& out);
/// Adds to `out` and to d_background[3]; `image` is what blend_splats wrote.
template <class R>
void splats_backward(const GaussianCloud<R>& cloud, const SplatFrame<R>& frame,
                     const RenderedImage<R>& image, const ImageCotangents<R>& d_image,
                     const GaussianGradients<R>& out, R* d_background);

}  // namespace photograd
