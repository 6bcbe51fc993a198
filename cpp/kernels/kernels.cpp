// Compiled once per instruction set (see cpp/CMakeLists.txt): this file and all it includes live in
// the namespace that PHOTOGRAD_ISA names.
#include "kernels/kernels.h"

#include "kernels/blend_splats.inl"
#include "kernels/draw_span.inl"
#include "kernels/gather_sparse_sh.inl"
#include "kernels/hash_encoding.inl"
#include "kernels/march_dense.inl"
#include "kernels/march_sparse_sh.inl"
#include "kernels/perceptron.inl"
#include "kernels/principled.inl"
#include "kernels/sample_rgb.inl"
#include "kernels/sh_rgb.inl"
#include "kernels/ssao_row.inl"

namespace photograd::PHOTOGRAD_ISA {

#define PHOTOGRAD_TEXT_(x) #x
#define PHOTOGRAD_TEXT(x) PHOTOGRAD_TEXT_(x)
extern const Kernels table{
    .name = PHOTOGRAD_TEXT(PHOTOGRAD_ISA),
    .march_dense_forward = &march_dense_forward,
    .march_dense_backward = &march_dense_backward,
    .march_dense_gather = &march_dense_gather,
    .sample_rgb = &sample_rgb,
    .sh_rgb = &sh_rgb,
    .sh_rgb_backward = &sh_rgb_backward,
    .blend_tile = &blend_tile_float,
    .blend_tile_backward = &blend_tile_backward_float,
    .march_sparse_sh_forward = &march_sparse_sh_forward,
    .march_sparse_sh_backward = &march_sparse_sh_backward,
    .march_sparse_sh_weights = &march_sparse_sh_weights,
    .march_sparse_sh_gather = &march_sparse_sh_gather,
    .draw_span = &draw_span,
    .ssao_row = &ssao_row,
    .hash_encode = &hash_encode,
    .hash_scatter = &hash_scatter,
    .hash_points = &hash_points,
    .perceptron_pack = &perceptron_pack,
    .perceptron_forward = &perceptron_forward,
    .perceptron_backward = &perceptron_backward,
    .principled_values = &principled_values,
    .principled_values_backward = &principled_values_backward,
};

}  // namespace photograd::PHOTOGRAD_ISA
