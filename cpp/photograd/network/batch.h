// A multilayer perceptron at many inputs: blocks of samples on all threads.
//
// Derivatives with respect to the weights are sums over all samples. Runs of 1024 samples are added
// up in R, the runs of a chunk in double, and the chunks in order; which samples are in a run
// depends on their number alone.
#pragma once

#include <cstdint>
#include <span>

#include "photograd/network/engine.h"
#include "photograd/network/shape.h"

namespace photograd {

/// The numbers of all layers at all inputs, which a forward pass of the kernel leaves for the
/// backward pass at the same inputs and parameters. Without them that one evaluates the layers
/// again.
struct PerceptronValues {
    std::vector<KernelNetwork::Values> blocks;
    std::int64_t samples = 0;
    std::size_t parameters = 0;  // of the shape that they belong to
};

/// Writes outputs (samples, shape.outputs()) of inputs (samples, shape.inputs). R: float, double.
/// `plain` takes the formulas of network/perceptron.h in float, too, in place of the kernel.
/// Fills `values` unless null, which the plain formulas and double ask for.
template <class R>
void perceptron_forward(const PerceptronShape& shape, const R* parameters, std::int64_t samples,
                        const R* inputs, R* outputs, bool plain = false,
                        PerceptronValues* values = nullptr);

/// Adds to d_parameters (shape.parameters()); writes d_inputs (samples, shape.inputs) unless null.
template <class R>
void perceptron_backward(const PerceptronShape& shape, const R* parameters, std::int64_t samples,
                         const R* inputs, const R* d_outputs, R* d_parameters, R* d_inputs,
                         bool plain = false, PerceptronValues* values = nullptr);

/// Networks of one shape, each at samples of its own: network n has the samples offset[n] to
/// offset[n + 1], and a row of parameters (networks, shape.parameters()) [Reiser2021]. A network
/// runs on one thread. Writes outputs (samples, shape.outputs()).
template <class R>
void perceptrons_forward(const PerceptronShape& shape, const R* parameters,
                         std::span<const std::int64_t> offset, const R* inputs, R* outputs);

/// Evaluates the layers again. Adds to d_parameters; writes d_inputs.
template <class R>
void perceptrons_backward(const PerceptronShape& shape, const R* parameters,
                          std::span<const std::int64_t> offset, const R* inputs, const R* d_outputs,
                          R* d_parameters, R* d_inputs);

}  // namespace photograd
