// The arguments that both fused marches share.
#pragma once

#include <algorithm>

#include "kernels/march_args.h"
#include "photograd/render/march/march.h"

namespace photograd {

/// Args with the members of MarchArgs set; F is DenseGrid<float> or SparseSh<float>.
template <class Args, class F>
Args kernel_args(const F& field, const RayBatch<float>& rays, const MarchOptions& options,
                 const MarchOutputs<float>& out) {
    Args a{};
    a.rays = rays;
    a.out = out;
    std::copy_n(field.lo, 3, a.lo);
    std::copy_n(field.scale, 3, a.scale);
    a.density_activation = static_cast<int>(field.options.density_activation);
    a.color_activation = static_cast<int>(field.options.color_activation);
    a.quadrature = static_cast<int>(options.quadrature);
    a.density_scale = field.density_scale;
    a.dt = static_cast<float>(options.dt);
    a.tau_stop = static_cast<float>(options.tau_stop());
    return a;
}

}  // namespace photograd
