// The march through a dense grid in float, with its stages fused in a kernel
// (kernels/march_dense.inl). Bit for bit the same as march() with a DenseGrid<float>, and many
// times faster; camera adjoints are left to the staged form.
#pragma once

#include "photograd/field/dense_grid.h"
#include "photograd/render/march/march.h"

namespace photograd {

void march_dense(const DenseGrid<float>& grid, const RayBatch<float>& rays,
                 const MarchOptions& options, const MarchOutputs<float>& out);

/// d_values (X, Y, Z, 4) is added to.
void march_dense_backward(const DenseGrid<float>& grid, const RayBatch<float>& rays,
                          const MarchOptions& options, const MarchOutputs<float>& out,
                          const MarchAdjoint<float>& adjoint, float* d_values);

}  // namespace photograd
