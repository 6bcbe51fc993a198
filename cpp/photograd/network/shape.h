// The shape of a multilayer perceptron: how many numbers each layer takes and gives, and where its
// weights lie.
//
//   x_0 = input,  x_{l+1} = activation_l(W_l x_l + b_l),  output = x_L
//
// A skip connection [Park2019] hands the input to layer `skip` once more, behind x_skip. All
// parameters lie in one array: W_0 (row by row), b_0, W_1, b_1, ...
#pragma once

#include <cstddef>
#include <vector>

#include "photograd/ops/activation.h"

namespace photograd {

struct PerceptronShape {
    int inputs = 0;
    std::vector<int> widths;  // numbers that each layer gives; the last are the output
    Activation hidden = Activation::relu, output = Activation::identity;
    int skip = 0;  // the layer that takes the input again; 0 for none

    [[nodiscard]] int layers() const { return static_cast<int>(widths.size()); }
    [[nodiscard]] int outputs() const { return widths.back(); }
    [[nodiscard]] int width(int layer) const { return widths[static_cast<std::size_t>(layer)]; }
    /// Numbers that a layer takes.
    [[nodiscard]] int takes(int layer) const {
        if (layer == 0) return inputs;
        return width(layer - 1) + (layer == skip ? inputs : 0);
    }
    [[nodiscard]] Activation activation(int layer) const {
        return layer + 1 == layers() ? output : hidden;
    }
    /// Parameters of the layers before `layer`.
    [[nodiscard]] std::size_t offset(int layer) const {
        std::size_t sum = 0;
        for (int l = 0; l < layer; ++l)
            sum += static_cast<std::size_t>(width(l)) * static_cast<std::size_t>(takes(l) + 1);
        return sum;
    }
    [[nodiscard]] std::size_t parameters() const { return offset(layers()); }

    bool operator==(const PerceptronShape&) const = default;
};

}  // namespace photograd
