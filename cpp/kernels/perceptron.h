// A multilayer perceptron at a block of inputs, float: what the kernel gets. Plain data only,
// because every instruction set's translation unit includes it. The formulas are in
// network/perceptron.h; both agree bit for bit.
//
// Numbers of a block lie feature by feature: number f of sample s at [f * perceptron_block + s].
#pragma once

#include <cstdint>

namespace photograd {

inline constexpr int perceptron_block = 128;

struct PerceptronLayer {
    int takes, gives;
    int activation;          // of Activation
    bool takes_input_again;  // behind what the layer before gives
    const float *weights, *biases;
    const float *packed, *packed_transposed;  // the weights, as perceptron_pack orders them
    std::int64_t input, output;               // where its block begins in the workspace
    std::int64_t d_weights;                   // where its block of derivatives begins
};

/// Derivatives of a layer's weights lie in rows of this length: the weights, the bias, zeros.
inline constexpr int derivative_row(int takes) { return (takes + 1 + 31) / 32 * 32; }

struct PerceptronBlock {
    const PerceptronLayer* layers;
    int count, inputs;
    int samples;       // used, of perceptron_block; others are zero in inputs and derivatives
    float* workspace;  // begins with the inputs; forward writes all else, backward reads it
};

struct PerceptronBackward {
    float* d_output;   // of the block; overwritten
    float* d_weights;  // added to
    float* d_input;    // of the block, written, or null
    float* scratch;    // 3 * widest * perceptron_block + perceptron_block * longest derivative row
    int widest;        // numbers that a layer takes or gives
};

}  // namespace photograd
