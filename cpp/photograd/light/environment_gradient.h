// The adjoint of many lookups in an environment map, on all threads: each texel's derivatives are
// added by its owner, in the order of the directions, so that the sum has the same bits however
// many threads there are.
#pragma once

#include "photograd/light/environment.h"

namespace photograd {

/// d_texels (H, 2 H, 3) += derivative of sum_n <d_L[n], L(w[n])>; w and d_L (N, 3).
template <Real R>
void environment_backward(const Environment<R>& environment, const R* w, const R* d_L,
                          std::int64_t count, R* d_texels);

}  // namespace photograd
