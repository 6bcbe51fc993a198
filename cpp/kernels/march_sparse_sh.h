// The fused march through a sparse grid of density and spherical harmonics (float): what the kernel
// gets and gives. The staged form is photograd/field/sparse_sh.h with
// photograd/render/march/march.h; the two are tested to agree bit for bit.
#pragma once

#include "kernels/march_args.h"
#include "photograd/grid/cell_view.h"

namespace photograd {

/// Floats of a ray's basis in memory: Y of degree 3, three times each.
inline constexpr int sh_basis_stride = 48;

struct MarchSparseShArgs : MarchArgs {
    CellView cells;
    const float* density;     // (T, 9, 9, 9) of the tiles' voxels, the background's where none is
    const float* sh;          // (N, K, 3)
    const float* background;  // (1 + 3 K,)
    int degree;
    float color_offset;
    int skip;  // 0 places every sample, also where no voxel is near
};

struct MarchSparseShBackward {
    MarchAdjoint<float> adjoint;
    std::int64_t first_ray;      // of the slab: records count rays from here
    float* basis;                // (rays of the slab, sh_basis_stride), written
    CellRecord<float>* records;  // of this chunk: room for all samples of each ray, ray by ray
    std::int32_t* found;         // (rays of the chunk,) how many records a ray has got, written
    double* d_background;        // (1 + 3 K,) from corners without a row, added to
};

/// Consecutive records of one ray that have corners in one brick.
struct CellRun {
    const CellRecord<float>* records;
    std::int64_t count;
};

/// One brick's share of the records.
struct SparseShGather {
    const CellRun* runs;
    const std::uint32_t* order;  // (count,)
    std::int64_t count;
    const float* basis;        // (rays of the slab, sh_basis_stride)
    const std::int32_t* rows;  // (8, 8, 8) of the brick
    int origin[3];
    int degree;
    float* d_density;
    float* d_sh;
};

}  // namespace photograd
