// A two-layer network as a radiance field: the smallest field whose parameters every sample
// touches.
//
//   h = softplus(W1 p + b1)              16 hidden units
//   o = W2 h + b2                        4 outputs
//   rgb = sigmoid(o[0..2]),  sigma_t = softplus(o[3])
//
// Adjoint: d_o from the activations; d_W2 = d_o h^T, d_b2 = d_o; d_h = W2^T d_o; d_a = d_h
// sigmoid(a) with a = W1 p + b1; d_W1 = d_a p^T, d_b1 = d_a, d_p = W1^T d_a.
//
// It shows that the marcher serves fields that are not grids, and proves the path for shared
// parameters. It is no match for an image: real coordinate networks need an encoding.
#pragma once

#include <array>
#include <string>

#include "photograd/core/scatter.h"
#include "photograd/field/samples.h"

namespace photograd {

template <Real R>
struct TinyNetwork {
    using Scalar = R;
    static constexpr const char* name = "tiny_network";
    static constexpr const char* axes = "P";
    static constexpr int hidden = 16;
    // Parameters in one flat array: W1 (16, 3), b1 (16), W2 (4, 16), b2 (4).
    static constexpr int at_b1 = 3 * hidden, at_w2 = at_b1 + hidden, at_b2 = at_w2 + 4 * hidden;
    static constexpr int parameter_count = at_b2 + 4;

    const R* parameters = nullptr;

    static std::string expected() { return std::to_string(parameter_count) + " numbers"; }
    static bool fits(const std::int64_t* shape) { return shape[0] == parameter_count; }
    static TinyNetwork over(const R* parameters, const std::int64_t* /*shape*/,
                            const FieldOptions& /*options*/) {
        TinyNetwork network;
        network.parameters = parameters;
        return network;
    }

    struct Cache {
        std::vector<std::array<Lanes<R>, hidden>> before;  // a = W1 p + b1
        std::vector<std::array<Lanes<R>, 4>> out;          // o
    };

    void eval(const SampleBatch<R>& batch, Cache& cache, SampleValues<R>& values) const {
        cache.before.resize(batch.groups());
        cache.out.resize(batch.groups());
        const R *w1 = parameters, *b1 = w1 + at_b1, *w2 = w1 + at_w2, *b2 = w1 + at_b2;
        for (std::size_t g = 0; g < batch.groups(); ++g)
            for (int i = 0; i < lane_count; ++i) {
                R h[hidden];
                for (int u = 0; u < hidden; ++u) {
                    R a = b1[u];
                    for (int axis = 0; axis < 3; ++axis)
                        a += w1[3 * u + axis] * batch.position[axis][g][i];
                    cache.before[g][static_cast<std::size_t>(u)][i] = a;
                    h[u] = softplus(a);
                }
                for (int c = 0; c < 4; ++c) {
                    R o = b2[c];
                    for (int u = 0; u < hidden; ++u) o += w2[c * hidden + u] * h[u];
                    cache.out[g][static_cast<std::size_t>(c)][i] = o;
                    if (c < 3)
                        values.rgb[c][g][i] = sigmoid(o);
                    else
                        values.sigma_t[g][i] = softplus(o);
                }
            }
    }

    /// Partial sums in double, one per chunk of rays, added in order.
    struct Sink {
        Sink(const TinyNetwork& /*field*/, R* d_parameters) : gradient(d_parameters) {}

        R* gradient;
        std::vector<std::array<double, parameter_count>> partials;

        void begin(int chunks) { partials.assign(static_cast<std::size_t>(chunks), {}); }
        void finish() {
            for (std::size_t p = 0; p < parameter_count; ++p) {
                double total = 0.0;
                for (const auto& partial : partials) total += partial[p];
                gradient[p] += static_cast<R>(total);
            }
        }
    };

    void backward(const SampleBatch<R>& batch, const Cache& cache, const SampleValues<R>& d_values,
                  Sink& sink, int chunk, std::vector<Lanes<R>>* d_position,
                  std::vector<R>* /*d_direction*/) const {
        double* d = sink.partials[static_cast<std::size_t>(chunk)].data();
        const R *w1 = parameters, *w2 = w1 + at_w2;
        for (std::size_t g = 0; g < batch.groups(); ++g)
            for (int i = 0; i < batch.used[g]; ++i) {
                R d_o[4] = {R(0), R(0), R(0), R(0)};
                for (std::size_t c = 0; c < 3; ++c)
                    sigmoid_backward(cache.out[g][c][i], d_values.rgb[c][g][i], d_o[c]);
                softplus_backward(cache.out[g][3][i], d_values.sigma_t[g][i], d_o[3]);
                for (int c = 0; c < 4; ++c) d[at_b2 + c] += static_cast<double>(d_o[c]);
                for (int u = 0; u < hidden; ++u) {
                    const R a = cache.before[g][static_cast<std::size_t>(u)][i];
                    const R h = softplus(a);
                    R d_h = R(0), d_a = R(0);
                    for (int c = 0; c < 4; ++c) {
                        d[at_w2 + c * hidden + u] += static_cast<double>(d_o[c] * h);
                        d_h += w2[c * hidden + u] * d_o[c];
                    }
                    softplus_backward(a, d_h, d_a);
                    d[at_b1 + u] += static_cast<double>(d_a);
                    for (int axis = 0; axis < 3; ++axis) {
                        d[3 * u + axis] += static_cast<double>(d_a * batch.position[axis][g][i]);
                        if (d_position) d_position[axis][g][i] += w1[3 * u + axis] * d_a;
                    }
                }
            }
    }
};

static_assert(Field<TinyNetwork<float>> && Field<TinyNetwork<double>>);

}  // namespace photograd
