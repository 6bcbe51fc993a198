// A multilayer perceptron at many inputs: blocks of samples on all threads.
//
// Derivatives with respect to the weights are sums over all samples. Runs of 1024 samples are added
// up in R, the runs of a chunk in double, and the chunks in order; which samples are in a run
// depends on their number alone.
#pragma once

#include <cstdint>

#include "photograd/network/shape.h"

namespace photograd {

/// Writes outputs (samples, shape.outputs()) of inputs (samples, shape.inputs). R: float, double.
/// `plain` takes the formulas of network/perceptron.h in float, too, in place of the kernel.
template <class R>
void perceptron_forward(const PerceptronShape& shape, const R* parameters, std::int64_t samples,
                        const R* inputs, R* outputs, bool plain = false);

/// Adds to d_parameters (shape.parameters()); writes d_inputs (samples, shape.inputs) unless null.
template <class R>
void perceptron_backward(const PerceptronShape& shape, const R* parameters, std::int64_t samples,
                         const R* inputs, const R* d_outputs, R* d_parameters, R* d_inputs,
                         bool plain = false);

}  // namespace photograd
