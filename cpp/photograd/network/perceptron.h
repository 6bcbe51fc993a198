// A multilayer perceptron at one input, and its backward pass: the formulas, to be read.
//
//   z_l = W_l x_l + b_l,  x_{l+1} = a_l(z_l)
//
// Adjoint, from the last layer to the first, with d_ for derivatives of the loss:
//   d_z_l = a_l'(z_l) d_x_{l+1},   d_W_l += d_z_l x_l^T,   d_b_l += d_z_l,   d_x_l = W_l^T d_z_l
// The derivative of the activation is taken from its value x_{l+1}; z_l is not kept.
//
// The kernel (kernels/perceptron.inl) does this for many inputs at once. Every sum here runs in the
// kernel's order with fused multiply-adds: in float the two agree bit for bit.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "photograd/core/real.h"
#include "photograd/network/shape.h"

namespace photograd {

template <Real R>
class Perceptron {
public:
    Perceptron(const PerceptronShape& shape, const R* parameters)
        : shape_(shape), parameters_(parameters) {}

    /// The values of all layers at one input, which backward takes.
    struct Values {
        std::vector<std::vector<R>> x;  // what each layer takes, and behind the last the output
    };

    void forward(std::span<const R> input, Values& v) const {
        v.x.assign(static_cast<std::size_t>(shape_.layers()) + 1, {});
        v.x[0].assign(input.begin(), input.end());
        for (int l = 0; l < shape_.layers(); ++l) {
            const std::size_t width = static_cast<std::size_t>(shape_.width(l));
            const std::vector<R>& x = v.x[static_cast<std::size_t>(l)];
            std::vector<R>& y = v.x[static_cast<std::size_t>(l) + 1];
            const R* W = parameters_ + shape_.offset(l);
            const R* b = W + width * x.size();
            for (std::size_t u = 0; u < width; ++u) {
                R z = b[u];
                for (std::size_t k = 0; k < x.size(); ++k)
                    z = std::fma(W[u * x.size() + k], x[k], z);
                y.push_back(activate(shape_.activation(l), z));
            }
            if (l + 1 == shape_.skip) y.insert(y.end(), input.begin(), input.end());
        }
    }

    /// Adds to d_parameters; writes d_input unless it is empty.
    void backward(const Values& v, std::span<const R> d_output, R* d_parameters,
                  std::span<R> d_input) const {
        std::vector<R> d(d_output.begin(), d_output.end()), d_again(v.x[0].size(), R(0));
        for (int l = shape_.layers() - 1; l >= 0; --l) {
            const std::size_t width = static_cast<std::size_t>(shape_.width(l));
            const std::vector<R>& x = v.x[static_cast<std::size_t>(l)];
            const std::vector<R>& y = v.x[static_cast<std::size_t>(l) + 1];
            const R* W = parameters_ + shape_.offset(l);
            R* d_W = d_parameters + shape_.offset(l);
            R* d_b = d_W + width * x.size();
            std::vector<R> d_x(x.size(), R(0));
            for (std::size_t u = 0; u < width; ++u) {
                const R d_z = d[u] * derivative_at_value(shape_.activation(l), y[u]);
                for (std::size_t k = 0; k < x.size(); ++k) {
                    R& d_weight = d_W[u * x.size() + k];
                    d_weight = std::fma(d_z, x[k], d_weight);
                    d_x[k] = std::fma(W[u * x.size() + k], d_z, d_x[k]);
                }
                d_b[u] += d_z;
            }
            if (l > 0 && l == shape_.skip)
                d_again.assign(d_x.end() - static_cast<std::ptrdiff_t>(d_again.size()), d_x.end());
            d.swap(d_x);
        }
        for (std::size_t i = 0; i < d_input.size(); ++i) d_input[i] = d[i] + d_again[i];
    }

private:
    const PerceptronShape& shape_;
    const R* parameters_;
};

}  // namespace photograd
