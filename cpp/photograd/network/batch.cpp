#include "photograd/network/batch.h"

#include <cstdint>

#include "photograd/core/scatter.h"
#include "photograd/network/engine.h"

namespace photograd {
namespace {

constexpr std::int64_t run = 1024;  // samples whose derivatives are added up in R
static_assert(run % perceptron_block == 0);

// visit(first, count) for pieces of [begin, end) with at most `size` samples.
template <class Visit>
void for_pieces(std::int64_t begin, std::int64_t end, std::int64_t size, Visit&& visit) {
    for (std::int64_t at = begin; at < end; at += size) visit(at, std::min(size, end - at));
}

// block[f * perceptron_block + s] = rows[s * width + f], with zeros behind the last sample.
template <class R>
void to_block(const R* rows, std::int64_t samples, int width, R* block) {
    for (int f = 0; f < width; ++f)
        for (std::int64_t s = 0; s < perceptron_block; ++s)
            block[f * perceptron_block + s] = s < samples ? rows[s * width + f] : R(0);
}
template <class R>
void from_block(const R* block, std::int64_t samples, int width, R* rows) {
    for (std::int64_t s = 0; s < samples; ++s)
        for (int f = 0; f < width; ++f) rows[s * width + f] = block[f * perceptron_block + s];
}

// Chunks of samples whose sums are kept apart: whole runs, at most 32 of them.
struct Chunks {
    std::int64_t size, count;
    explicit Chunks(std::int64_t samples) {
        const std::int64_t runs = (samples + run - 1) / run;
        size = std::max<std::int64_t>((runs + 31) / 32, 1) * run;
        count = (samples + size - 1) / size;
    }
};

// Where the numbers of the block that begins with sample `first` are kept, or `own`.
template <class Values>
Values& values_of(PerceptronValues* kept, std::int64_t first, Values& own) {
    if constexpr (std::is_same_v<Values, KernelNetwork::Values>)
        if (kept) return kept->blocks[static_cast<std::size_t>(first / perceptron_block)];
    return own;
}

template <class Engine, class R = typename Engine::Scalar>
void forward_chunk(const Engine& network, std::int64_t begin, std::int64_t end, const R* inputs,
                   R* outputs, PerceptronValues* kept) {
    const int takes = network.shape().inputs, gives = network.shape().outputs();
    typename Engine::Values own;
    for_pieces(begin, end, perceptron_block, [&](std::int64_t first, std::int64_t n) {
        auto& values = values_of(kept, first, own);
        network.resize(values);
        to_block(inputs + first * takes, n, takes, values.inputs());
        network.forward(values, static_cast<int>(n));
        from_block(values.outputs(), n, gives, outputs + first * gives);
    });
}

template <class Engine, class R = typename Engine::Scalar>
void backward_chunk(const Engine& network, std::int64_t begin, std::int64_t end, const R* inputs,
                    const R* d_outputs, std::span<double> sums, R* d_inputs,
                    PerceptronValues* kept) {
    const int takes = network.shape().inputs, gives = network.shape().outputs();
    typename Engine::Values own;
    typename Engine::Gradient gradient;
    network.resize(gradient);
    std::vector<R> d_out(static_cast<std::size_t>(gives * perceptron_block)),
        d_in(static_cast<std::size_t>(takes * perceptron_block));
    for_pieces(begin, end, run, [&](std::int64_t from, std::int64_t count) {
        for_pieces(from, from + count, perceptron_block, [&](std::int64_t first, std::int64_t n) {
            auto& values = values_of(kept, first, own);
            if (!kept) {
                network.resize(values);
                to_block(inputs + first * takes, n, takes, values.inputs());
                network.forward(values, static_cast<int>(n));
            }
            to_block(d_outputs + first * gives, n, gives, d_out.data());
            network.backward(values, static_cast<int>(n), d_out.data(), gradient,
                             d_inputs ? d_in.data() : nullptr);
            if (d_inputs) from_block(d_in.data(), n, takes, d_inputs + first * takes);
        });
        network.flush(gradient, sums);
    });
}

/// use(engine) with the product's, or with the plain formulas.
template <class R, class Use>
void with_engine(const PerceptronShape& shape, const R* parameters, bool plain, Use&& use) {
    if (plain)
        use(PlainNetwork<R>(shape, parameters));
    else
        use(Network<R>(shape, parameters));
}

/// use(engine, first sample, end, number of its first parameter) for each network with samples.
template <class R, class Use>
void for_networks(const PerceptronShape& shape, const R* parameters,
                  std::span<const std::int64_t> offset, Use&& use) {
    parallel_for(static_cast<std::int64_t>(offset.size()) - 1, [&](std::int64_t n) {
        const std::int64_t begin = offset[static_cast<std::size_t>(n)],
                           end = offset[static_cast<std::size_t>(n) + 1],
                           first = n * static_cast<std::int64_t>(shape.parameters());
        if (begin < end) use(Network<R>(shape, parameters + first), begin, end, first);
    });
}

}  // namespace

template <class R>
void perceptron_forward(const PerceptronShape& shape, const R* parameters, std::int64_t samples,
                        const R* inputs, R* outputs, bool plain, PerceptronValues* values) {
    if (values) {
        const std::int64_t blocks = (samples + perceptron_block - 1) / perceptron_block;
        values->blocks.resize(static_cast<std::size_t>(blocks));
        values->samples = samples;
        values->parameters = shape.parameters();
    }
    with_engine(shape, parameters, plain, [&](const auto& network) {
        parallel_for((samples + run - 1) / run, [&](std::int64_t k) {
            forward_chunk(network, k * run, std::min((k + 1) * run, samples), inputs, outputs,
                          values);
        });
    });
}

template <class R>
void perceptron_backward(const PerceptronShape& shape, const R* parameters, std::int64_t samples,
                         const R* inputs, const R* d_outputs, R* d_parameters, R* d_inputs,
                         bool plain, PerceptronValues* values) {
    const Chunks chunks(samples);
    with_engine(shape, parameters, plain, [&](const auto& network) {
        sum_partials<R>(chunks.count, {d_parameters, shape.parameters()},
                        [&](std::int64_t k, std::span<double> sums) {
                            backward_chunk(network, k * chunks.size,
                                           std::min((k + 1) * chunks.size, samples), inputs,
                                           d_outputs, sums, d_inputs, values);
                        });
    });
}

template <class R>
void perceptrons_forward(const PerceptronShape& shape, const R* parameters,
                         std::span<const std::int64_t> offset, const R* inputs, R* outputs) {
    for_networks(shape, parameters, offset,
                 [&](const auto& network, std::int64_t begin, std::int64_t end, std::int64_t) {
                     forward_chunk(network, begin, end, inputs, outputs, nullptr);
                 });
}

template <class R>
void perceptrons_backward(const PerceptronShape& shape, const R* parameters,
                          std::span<const std::int64_t> offset, const R* inputs, const R* d_outputs,
                          R* d_parameters, R* d_inputs) {
    for_networks(
        shape, parameters, offset,
        [&](const auto& network, std::int64_t begin, std::int64_t end, std::int64_t first) {
            std::vector<double> sums(static_cast<std::size_t>(shape.parameters()));
            backward_chunk(network, begin, end, inputs, d_outputs, sums, d_inputs, nullptr);
            for (const double sum : sums) d_parameters[first++] += static_cast<R>(sum);
        });
}

template void perceptron_forward(const PerceptronShape&, const float*, std::int64_t, const float*,
                                 float*, bool, PerceptronValues*);
template void perceptron_forward(const PerceptronShape&, const double*, std::int64_t, const double*,
                                 double*, bool, PerceptronValues*);
template void perceptron_backward(const PerceptronShape&, const float*, std::int64_t, const float*,
                                  const float*, float*, float*, bool, PerceptronValues*);
template void perceptron_backward(const PerceptronShape&, const double*, std::int64_t,
                                  const double*, const double*, double*, double*, bool,
                                  PerceptronValues*);

template void perceptrons_forward(const PerceptronShape&, const float*,
                                  std::span<const std::int64_t>, const float*, float*);
template void perceptrons_backward(const PerceptronShape&, const float*,
                                   std::span<const std::int64_t>, const float*, const float*,
                                   float*, float*);
template void perceptrons_forward(const PerceptronShape&, const double*,
                                  std::span<const std::int64_t>, const double*, double*);
template void perceptrons_backward(const PerceptronShape&, const double*,
                                   std::span<const std::int64_t>, const double*, const double*,
                                   double*, double*);

}  // namespace photograd
