// Gaussian splatting [Kerbl2023]: project, sort, bin, blend; and the adjoint of all of it.
//
// Backward is owner-computes: a tile writes what it has for each of its splats to a place of that pair's
// own, then a splat adds up its pairs in their order. No two threads write one number, and the sums do
// not depend on the number of threads.
#pragma once

#include <vector>

#include "photograd/splat/bin.h"
#include "photograd/splat/project.h"

namespace photograd {

/// What both passes share: splats of all Gaussians and the lists of the tiles.
template <class R>
struct SplatFrame {
    SplatView<R> view;
    R background[3];
    std::vector<ScreenSplat<R>> splats;
    TileLists lists;
};

/// Refuses parameters that are no numbers; splats, sorts and bins.
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
