// A multilayer perceptron at a block of inputs, forward and backward. All layers of one block
// follow each other, so that its numbers stay in the cache.
//
// With X (takes, samples) and Z = W X + b, the three products are
//   forward      Z = W X                  backward     d_X = W^T d_Z,   d_W = d_Z X^T
// X^T is written out with a row of ones, whose product with d_Z is the derivative of the bias.
#pragma once

#include "kernels/multiply.inl"
#include "kernels/perceptron.h"
#include "photograd/core/lanes.h"
#include "photograd/ops/activation.h"

namespace photograd::PHOTOGRAD_ISA {

// Columns that are calculated: whole strips of the product.
static inline int columns_of(int samples) { return (samples + 31) / 32 * 32; }

template <class F>
static inline void for_lanes(int rows, int columns, F&& visit) {
    for (int row = 0; row < rows; ++row)
        for (int s = 0; s < columns; s += lane_count) visit(row * perceptron_block + s);
}

static void activate_block(Activation kind, int rows, int columns, float* y) {
    const auto apply = [&](auto&& f) {
        for_lanes(rows, columns, [&](int at) {
            for (int i = 0; i < lane_count; ++i) y[at + i] = f(y[at + i]);
        });
    };
    switch (kind) {
        case Activation::relu: return apply([](float x) { return relu(x); });
        case Activation::softplus: return apply([](float x) { return softplus(x); });
        case Activation::exp: return apply([](float x) { return exponential(x); });
        case Activation::sigmoid: return apply([](float x) { return sigmoid(x); });
        default: return;
    }
}

// d_z = d_y a'(y), in place.
static void activate_block_backward(Activation kind, int rows, int columns, const float* y,
                                    float* d) {
    const auto apply = [&](auto derivative) {
        for_lanes(rows, columns, [&](int at) {
            for (int i = 0; i < lane_count; ++i) d[at + i] = d[at + i] * derivative(y[at + i]);
        });
    };
    switch (kind) {
        case Activation::relu:
            return apply([](float at) { return derivative_at_value(Activation::relu, at); });
        case Activation::softplus:
            return apply([](float at) { return derivative_at_value(Activation::softplus, at); });
        case Activation::exp:
            return apply([](float at) { return derivative_at_value(Activation::exp, at); });
        case Activation::sigmoid:
            return apply([](float at) { return derivative_at_value(Activation::sigmoid, at); });
        default: return;
    }
}

static inline void copy_rows(const float* from, int rows, float* to) {
    for_lanes(rows, perceptron_block, [&](int at) {
        for (int i = 0; i < lane_count; ++i) to[at + i] = from[at + i];
    });
}

// Writes the weights of a layer, gives x takes numbers each, in the order of multiply.
static void perceptron_pack(const PerceptronLayer& layer, float* packed, float* transposed) {
    pack_rows(layer.weights, layer.takes, 1, layer.gives, layer.takes, packed);
    pack_rows(layer.weights, 1, layer.takes, layer.takes, layer.gives, transposed);
}

static void perceptron_forward(const PerceptronBlock& p) {
    const int columns = columns_of(p.samples);
    for (int l = 0; l < p.count; ++l) {
        const PerceptronLayer& layer = p.layers[l];
        float *x = p.workspace + layer.input, *y = p.workspace + layer.output;
        if (layer.takes_input_again)
            copy_rows(p.workspace, p.inputs, x + (layer.takes - p.inputs) * perceptron_block);
        for (int u = 0; u < layer.gives; ++u)
            for (int s = 0; s < columns; ++s) y[u * perceptron_block + s] = layer.biases[u];
        multiply({.rows = layer.gives,
                  .columns = columns,
                  .depth = layer.takes,
                  .a = layer.packed,
                  .a_row = 0,
                  .b = x,
                  .b_row = perceptron_block,
                  .c = y,
                  .c_row = perceptron_block});
        activate_block(Activation(layer.activation), layer.gives, columns, y);
    }
}

// to[s][k] = x[k][s], with ones behind and then zeros up to the end of the row.
static void transpose_block(const float* x, int takes, int samples, int row, float* to) {
    for (int s = 0; s < samples; ++s)
        for (int k = takes; k < row; ++k) to[s * row + k] = k == takes ? 1.0f : 0.0f;
    int k = 0;
    for (; k + 8 <= takes; k += 8)
        for (int s = 0; s < samples; ++s)
            for (int i = 0; i < 8; ++i) to[s * row + k + i] = x[(k + i) * perceptron_block + s];
    for (; k < takes; ++k)
        for (int s = 0; s < samples; ++s) to[s * row + k] = x[k * perceptron_block + s];
}

static void perceptron_backward(const PerceptronBlock& p, const PerceptronBackward& b) {
    const int columns = columns_of(p.samples);
    const std::int64_t block = std::int64_t{b.widest} * perceptron_block;
    float *again = b.scratch, *one = again + block, *two = one + block, *transposed = two + block;
    for_lanes(p.inputs, perceptron_block, [&](int at) {
        for (int i = 0; i < lane_count; ++i) again[at + i] = 0.0f;
    });
    float* d = b.d_output;
    for (int l = p.count - 1; l >= 0; --l) {
        const PerceptronLayer& layer = p.layers[l];
        const float *x = p.workspace + layer.input, *y = p.workspace + layer.output;
        activate_block_backward(Activation(layer.activation), layer.gives, columns, y, d);
        const int row = derivative_row(layer.takes);
        transpose_block(x, layer.takes, p.samples, row, transposed);
        multiply({.rows = layer.gives,
                  .columns = row,
                  .depth = p.samples,
                  .a = d,
                  .a_row = perceptron_block,
                  .b = transposed,
                  .b_row = row,
                  .c = b.d_weights + layer.d_weights,
                  .c_row = row});
        if (l == 0 && !b.d_input) return;
        float* d_x = d == one ? two : one;
        for_lanes(layer.takes, perceptron_block, [&](int at) {
            for (int i = 0; i < lane_count; ++i) d_x[at + i] = 0.0f;
        });
        multiply({.rows = layer.takes,
                  .columns = columns,
                  .depth = layer.gives,
                  .a = layer.packed_transposed,
                  .a_row = 0,
                  .b = d,
                  .b_row = perceptron_block,
                  .c = d_x,
                  .c_row = perceptron_block});
        if (layer.takes_input_again)
            copy_rows(d_x + (layer.takes - p.inputs) * perceptron_block, p.inputs, again);
        d = d_x;
    }
    for_lanes(p.inputs, columns, [&](int at) {
        for (int i = 0; i < lane_count; ++i) b.d_input[at + i] = d[at + i] + again[at + i];
    });
}

}  // namespace photograd::PHOTOGRAD_ISA
