// The derivative of a squared difference between a picture and another, when the picture is only known with noise.
//
//   loss = sum w (E[I] - t)^2              dloss/dtheta = sum 2 w (E[I] - t) dE[I]/dtheta
//
// A product of two means is not the mean of products, unless the noise of one has nothing to do with that of the other.
// Two pictures A and B with paths of their own give [Deng2022]
//
//   loss ~ sum w (A - t) (B - t)           dloss/dtheta ~ sum w ((A - t) dB/dtheta + (B - t) dA/dtheta)
//
// which is right on average: each tells the other what the loss asks for. Taking d = 2 w (A - t) to the paths of B alone
// (path.h) is right, too, but it uses half of what is known: the noise of the picture comes from A, that of the derivative
// from B. Here both have the paths of both, and the variance is about half as large, for the time of two adjoints
// instead of a picture and an adjoint.
//
// The cotangent of a pixel is known when all its paths of both pictures are; they are kept until then.
#pragma once

#include <array>

#include "photograd/render/path.h"

namespace photograd {

/// (H, W, 3) each.
struct SquaredError {
    const double *target, *weight;
};

/// Adds the derivatives for `spp` samples a pixel in each picture, or `counts` (H, W), at least 1 each, if that is given.
/// Neither may depend on these paths. `seeds` of the two replace that of the options. The pictures, (2, H, W, 3), are
/// written to `pictures`.
template <Real R>
void trace_pairs_backward(const PathScene<R>& scene, const ThinLens& camera,
                          const PathOptions& options, const std::array<std::uint64_t, 2>& seeds,
                          std::uint32_t spp, const std::uint32_t* counts, const SquaredError& loss,
                          const PathDerivatives<R>& out, double* pictures);

}  // namespace photograd
