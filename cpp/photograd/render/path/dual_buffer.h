// Unbiased gradients of the squared error between a Monte Carlo picture and a target, from two
// independent pictures (dual buffers).
//
//   loss = sum w (E[I] - t)^2              dloss/dtheta = sum 2 w (E[I] - t) dE[I]/dtheta
//
// A product of two means is not the mean of products, unless their noise is independent. Two
// pictures A and B with independent paths give the dual-buffer estimate [Deng2022]
//
//   loss ~ sum w (A - t) (B - t)      dloss/dtheta ~ sum w ((A - t) dB/dtheta + (B - t) dA/dtheta)
//
// which is unbiased: the cotangent of one buffer is the residual of the other. The cotangent
// d = 2 w (A - t) on the paths of B alone (render/path/path.h) is unbiased, too, but uses half of
// the samples. With both terms the variance is about half as large, for the time of two adjoints
// instead of a picture and an adjoint.
//
// The cotangent of a pixel is known when all its paths of both buffers are; they are cached until
// then.
#pragma once

#include <array>

#include "photograd/render/path/path.h"

namespace photograd {

/// (H, W, 3) each.
struct SquaredError {
    const double *target, *weight;
};

/// Adds derivatives to the sums of all blocks, for `spp` samples a pixel in each picture, or
/// `counts` (H, W), at least 1 each, if that is given. Neither may depend on these paths. `seeds`
/// of the two replace that of the options. The pictures, (2, H, W, 3), are written to `pictures`.
template <Real R>
void dual_buffer_backward(const PathScene<R>& scene, const ThinLens& camera,
                          const PathOptions& options, const std::array<std::uint64_t, 2>& seeds,
                          std::uint32_t spp, const std::uint32_t* counts, const SquaredError& loss,
                          std::span<const GradientBlock<R>> blocks, double* pictures);

}  // namespace photograd
