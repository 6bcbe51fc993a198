// Derivative pictures: how every pixel changes along one direction v of the parameters, in one
// pass.
//
// render/path/adjoint.h writes the radiance of a path as a polynomial in what the scene lets
// change. Its tangent follows the same recursion, from the end of the path to the camera. With t(x)
// the change of x along v, and U_k = Lo_k / c_k the three terms before the weight of the alpha
// test:
//
//   t(U_k) = w_k t(Le_k) + w^l_k (t(f^l_k) T^l L^l_k + f^l_k t(T^l L^l_k))
//            + s_k (t(f_k) Li_k + f_k t(Li_k))
//   t(Lo_k) = c_k t(U_k) + U_k dc_k/dalpha t(alpha)
//   t(T) = sum over events i of (product before i) t(x_i) (product after i)
//
// All weights are detached, as in the adjoint: <d_image, t> is <v, derivative of
// trace_paths_backward> for the same paths. One pass costs little more than a picture and gives one
// parameter's derivative in all pixels, where the adjoint gives all parameters' in one number. In
// double alone: such a picture is looked at and compared, not fitted.
#pragma once

#include "photograd/render/path/path.h"

namespace photograd {

/// Adds samples to both sums: of the picture, and of its change along `along`.
void trace_paths_tangent(const PathScene<double>& scene, const PathScene<double>& along,
                         const ThinLens& camera, const PathOptions& options,
                         const SampleRange& samples, const PathSums& picture,
                         const PathSums& tangent);

}  // namespace photograd
