// The table of hot loops. One set is chosen when it is first asked for: the widest instruction set
// that the processor has, or the one that the environment variable PHOTOGRAD_ISA names.
#pragma once

#include "kernels/draw_span.h"
#include "kernels/hash_encoding.h"
#include "kernels/march_dense.h"
#include "kernels/march_sparse_sh.h"
#include "kernels/perceptron.h"
#include "kernels/principled.h"
#include "kernels/sample_rgb.h"
#include "kernels/sh_rgb.h"
#include "kernels/ssao_row.h"
#include "photograd/splat/tiles.h"

namespace photograd {

struct Kernels {
    const char* name;
    void (*march_dense_forward)(const MarchDenseArgs&, std::int64_t begin, std::int64_t end);
    std::int64_t (*march_dense_backward)(const MarchDenseArgs&, const MarchDenseBackward&,
                                         std::int64_t begin, std::int64_t end, BrickRun* runs);
    void (*march_dense_gather)(const MarchDenseArgs&, const BrickRun* runs,
                               const std::uint32_t* order, std::int64_t count, const float* d_raw,
                               float* tile);
    bool (*sample_rgb)(const SampleRgbArgs&, std::int64_t begin, std::int64_t end);
    void (*sh_rgb)(const ShRgbArgs&, std::int64_t begin, std::int64_t end, float* colors);
    void (*sh_rgb_backward)(const ShRgbArgs&, const ShRgbBackward&, std::int64_t begin,
                            std::int64_t end);
    void (*blend_tile)(const BlendArgs<float>&, const TilePairs&, int x, int y);
    void (*blend_tile_backward)(const BlendArgs<float>&, const BlendBackward<float>&,
                                const TilePairs&, int x, int y);
    /// Returns the number of samples whose voxels were looked up.
    std::int64_t (*march_sparse_sh_forward)(const MarchSparseShArgs&, std::int64_t begin,
                                            std::int64_t end);
    void (*march_sparse_sh_backward)(const MarchSparseShArgs&, const MarchSparseShBackward&,
                                     std::int64_t begin, std::int64_t end);
    void (*march_sparse_sh_weights)(const MarchSparseShArgs&, const MarchSparseShBackward&,
                                    std::int64_t begin, std::int64_t end);
    void (*march_sparse_sh_gather)(const SparseShGather&);
    void (*draw_span)(const DrawSpan&);
    void (*ssao_row)(const SsaoRows&, std::int64_t y);
    void (*hash_encode)(const HashEncode&, std::int64_t begin, std::int64_t end);
    void (*hash_scatter)(const HashScatter&, std::int64_t begin, std::int64_t end);
    void (*hash_points)(const HashPoints&, std::int64_t begin, std::int64_t end);
    void (*perceptron_pack)(const PerceptronLayer&, float* packed, float* transposed);
    void (*perceptron_forward)(const PerceptronBlock&);
    void (*perceptron_backward)(const PerceptronBlock&, const PerceptronBackward&);
    /// Of the rows [begin, end); of the evaluations, where there is one row, whose derivative is
    /// added to d_parameters (5,) then.
    void (*principled_values)(const PrincipledArgs&, std::int64_t begin, std::int64_t end,
                              float* values);
    void (*principled_values_backward)(const PrincipledArgs&, const float* d_values,
                                       std::int64_t begin, std::int64_t end, float* d_parameters);
};

[[nodiscard]] const Kernels& kernels();

}  // namespace photograd
