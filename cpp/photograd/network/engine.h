// Multilayer perceptrons at a block of up to 128 samples: a network, the values of a block, and
// sums of derivatives. Two engines of one form:
//
//   KernelNetwork      float, by the kernel
//   PlainNetwork<R>    the formulas of network/perceptron.h, sample by sample
//
// Numbers of a block lie feature by feature: number f of sample s at [f * perceptron_block + s];
// samples that are not used are zeros in inputs and derivatives.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "kernels/kernels.h"
#include "photograd/network/perceptron.h"

namespace photograd {

class KernelNetwork {
public:
    using Scalar = float;

    KernelNetwork(const PerceptronShape& shape, const float* parameters) : shape_(&shape) {
        std::int64_t at = std::int64_t{shape.inputs} * perceptron_block;
        for (int l = 0; l < shape.layers(); ++l) {
            const int takes = shape.takes(l), gives = shape.width(l);
            const float* W = parameters + shape.offset(l);
            const float* b = W + std::int64_t{gives} * takes;
            const std::int64_t input = l == 0 ? 0 : layers_.back().output;
            const bool again = l > 0 && l == shape.skip;
            const int activation = static_cast<int>(shape.activation(l));
            layers_.push_back(
                {takes, gives, activation, again, W, b, nullptr, nullptr, input, at, derivatives_});
            // Room behind the output for the input, where the next layer takes it again.
            const int behind = l + 1 == shape.skip ? shape.inputs : 0;
            at += std::int64_t{gives + behind} * perceptron_block;
            derivatives_ += std::int64_t{gives} * derivative_row(takes);
            widest_ = std::max({widest_, takes, gives});
        }
        workspace_ = at;
        pack();
    }

    /// Inputs, to be written, and outputs of a block; backward takes what forward left there.
    class Values {
    public:
        float* inputs() { return numbers_.data(); }
        [[nodiscard]] const float* outputs() const { return numbers_.data() + outputs_; }

    private:
        friend KernelNetwork;
        std::vector<float> numbers_;
        std::int64_t outputs_ = 0;
    };
    void resize(Values& v) const {
        v.numbers_.resize(static_cast<std::size_t>(workspace_));
        v.outputs_ = layers_.back().output;
    }
    [[nodiscard]] std::size_t workspace_bytes() const {
        return sizeof(float) * static_cast<std::size_t>(workspace_);
    }
    void forward(Values& v, int samples) const { kernels().perceptron_forward(block(v, samples)); }

    /// Sums of derivatives with respect to the parameters.
    class Gradient {
        friend KernelNetwork;
        std::vector<float> sums_, scratch_;
    };
    void resize(Gradient& g) const {
        g.sums_.assign(static_cast<std::size_t>(derivatives_), 0.0f);
        g.scratch_.resize(
            static_cast<std::size_t>(perceptron_block * (3 * widest_ + derivative_row(widest_))));
    }
    /// Adds to `g`. d_outputs is overwritten; d_inputs is written unless null.
    void backward(const Values& v, int samples, float* d_outputs, Gradient& g,
                  float* d_inputs) const {
        kernels().perceptron_backward(
            block(v, samples), {d_outputs, g.sums_.data(), d_inputs, g.scratch_.data(), widest_});
    }
    /// Moves the sums of `g` to `to`.
    void flush(Gradient& g, std::span<double> to) const {
        std::size_t p = 0;
        for (const PerceptronLayer& layer : layers_) {
            const int row = derivative_row(layer.takes);
            const float* from = g.sums_.data() + layer.d_weights;
            for (int u = 0; u < layer.gives; ++u)
                for (int k = 0; k < layer.takes; ++k)
                    to[p++] += static_cast<double>(from[u * row + k]);
            for (int u = 0; u < layer.gives; ++u)
                to[p++] += static_cast<double>(from[u * row + layer.takes]);
        }
        std::fill(g.sums_.begin(), g.sums_.end(), 0.0f);
    }

    [[nodiscard]] const PerceptronShape& shape() const { return *shape_; }

private:
    void pack() {
        std::size_t weights = 0;
        for (const PerceptronLayer& layer : layers_)
            weights +=
                static_cast<std::size_t>(layer.gives) * static_cast<std::size_t>(layer.takes);
        packed_ = std::make_unique_for_overwrite<float[]>(2 * weights);
        float* to = packed_.get();
        for (PerceptronLayer& layer : layers_) {
            const std::int64_t size = std::int64_t{layer.gives} * layer.takes;
            layer.packed = to;
            layer.packed_transposed = to + size;
            kernels().perceptron_pack(layer, to, to + size);
            to += 2 * size;
        }
    }
    // The backward kernel reads the workspace only.
    PerceptronBlock block(const Values& v, int samples) const {
        return {layers_.data(), shape_->layers(), shape_->inputs, samples,
                const_cast<float*>(v.numbers_.data())};
    }

    const PerceptronShape* shape_;
    std::vector<PerceptronLayer> layers_;
    std::unique_ptr<float[]> packed_;  // the weights of all layers, in both orders
    std::int64_t workspace_ = 0, derivatives_ = 0;
    int widest_ = 0;
};

template <Real R>
class PlainNetwork {
public:
    using Scalar = R;

    PlainNetwork(const PerceptronShape& shape, const R* parameters)
        : shape_(&shape), network_(shape, parameters) {}

    class Values {
    public:
        R* inputs() { return inputs_.data(); }
        [[nodiscard]] const R* outputs() const { return outputs_.data(); }

    private:
        friend PlainNetwork;
        std::vector<R> inputs_, outputs_;
        std::vector<typename Perceptron<R>::Values> samples_;
    };
    void resize(Values& v) const {
        v.inputs_.resize(static_cast<std::size_t>(shape_->inputs * perceptron_block));
        v.outputs_.resize(static_cast<std::size_t>(shape_->outputs() * perceptron_block));
        v.samples_.resize(perceptron_block);
    }
    [[nodiscard]] std::size_t workspace_bytes() const {
        std::size_t numbers = static_cast<std::size_t>(2 * shape_->inputs + shape_->outputs());
        for (int l = 0; l < shape_->layers(); ++l)
            numbers += static_cast<std::size_t>(shape_->takes(l));
        return sizeof(R) * numbers * perceptron_block;
    }
    void forward(Values& v, int samples) const {
        std::vector<R> x(static_cast<std::size_t>(shape_->inputs));
        for (int s = 0; s < samples; ++s) {
            auto& values = v.samples_[static_cast<std::size_t>(s)];
            for (std::size_t f = 0; f < x.size(); ++f) x[f] = v.inputs_[at(f, s)];
            network_.forward(x, values);
            for (std::size_t f = 0; f < values.x.back().size(); ++f)
                v.outputs_[at(f, s)] = values.x.back()[f];
        }
    }

    class Gradient {
        friend PlainNetwork;
        std::vector<R> sums_;
    };
    void resize(Gradient& g) const { g.sums_.assign(shape_->parameters(), R(0)); }
    void backward(const Values& v, int samples, R* d_outputs, Gradient& g, R* d_inputs) const {
        std::vector<R> d_y(static_cast<std::size_t>(shape_->outputs())),
            d_x(d_inputs ? static_cast<std::size_t>(shape_->inputs) : 0);
        for (int s = 0; s < samples; ++s) {
            for (std::size_t f = 0; f < d_y.size(); ++f) d_y[f] = d_outputs[at(f, s)];
            network_.backward(v.samples_[static_cast<std::size_t>(s)], d_y, g.sums_.data(), d_x);
            for (std::size_t f = 0; f < d_x.size(); ++f) d_inputs[at(f, s)] = d_x[f];
        }
    }
    void flush(Gradient& g, std::span<double> to) const {
        for (std::size_t p = 0; p < to.size(); ++p) to[p] += static_cast<double>(g.sums_[p]);
        std::fill(g.sums_.begin(), g.sums_.end(), R(0));
    }

    [[nodiscard]] const PerceptronShape& shape() const { return *shape_; }

private:
    static std::size_t at(std::size_t feature, int sample) {
        return feature * perceptron_block + static_cast<std::size_t>(sample);
    }

    const PerceptronShape* shape_;
    Perceptron<R> network_;
};

/// The engine that the product runs.
template <Real R>
using Network = std::conditional_t<std::is_same_v<R, float>, KernelNetwork, PlainNetwork<R>>;

}  // namespace photograd
