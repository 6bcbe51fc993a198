// The march through a sparse grid of density and spherical harmonics in float, with its stages
// fused in a kernel (kernels/march_sparse_sh.inl). Bit for bit the same as march() with a
// SparseSh<float>; camera adjoints are left to the staged form.
#pragma once

#include "photograd/field/sparse_sh.h"
#include "photograd/render/march/march.h"

namespace photograd {

/// Returns the number of samples whose voxels were looked up. With `skip`, empty space is jumped
/// over.
std::int64_t march_sparse_sh(const SparseSh<float>& field, const RayBatch<float>& rays,
                             const MarchOptions& options, const MarchOutputs<float>& out,
                             bool skip);

void march_sparse_sh_backward(const SparseSh<float>& field, const RayBatch<float>& rays,
                              const MarchOptions& options, const MarchOutputs<float>& out,
                              const MarchAdjoint<float>& adjoint,
                              const SparseShGradients<float>& gradients);

/// Raises max_weight[row] to the largest product of a sample's weight w_k and its trilinear weight
/// at the voxel, over all samples of these rays: how much of a pixel a voxel can change.
void march_sparse_sh_weights(const SparseSh<float>& field, const RayBatch<float>& rays,
                             const MarchOptions& options, float* max_weight);

}  // namespace photograd
