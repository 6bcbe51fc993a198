// Models of a registry as flat functions on arrays: parameters (N, P) or (1, P), one row of P scalars a model.
#pragma once

#include <pybind11/stl.h>

#include "array_args.h"
#include "photograd/core/parallel.h"
#include "photograd/core/params.h"
#include "photograd/core/real.h"
#include "photograd/core/scatter.h"

namespace photograd {

/// (name, scalars, lo, hi, unit) of each described parameter.
using ParameterRows = std::vector<std::tuple<std::string, int, double, double, std::string>>;

template <class Description>
ParameterRows parameter_rows(const Description& description) {
    ParameterRows rows;
    std::apply(
        [&](const auto&... q) {
            (rows.emplace_back(q.name, value_scalars(q), q.lo, q.hi, q.unit), ...);
        },
        description);
    return rows;
}

/// Rows of parameters for N evaluations; one row serves all.
template <class R>
struct ModelRows {
    const R* data;
    std::int64_t step;  // scalars from one row to the next: P, or 0

    template <class Model>
    static ModelRows read(ArrayArgs& args, const py::array& parameters) {
        constexpr int count = parameter_count<Model>();
        const bool single = parameters.ndim() == 2 && parameters.shape(0) == 1;
        const std::string axes = (single ? "1 " : "N ") + std::to_string(count);
        return {args.in<R>("parameters", parameters, axes), single ? 0 : count};
    }
};

/// A model with parameters from a flat row, its constants taken from `start`.
template <class Model, class R>
Model model_at(const Model& start, const R* row) {
    Model model = start;
    for_each_scalar([&](auto& x) { x = *row++; }, model);
    return model;
}

template <class Model, class R>
Model zero_model() {
    Model model;
    for_each_scalar([](auto& x) { x = R(0); }, model);
    return model;
}

template <class R>
Vec3<R> vec3_at(const R* p, std::int64_t i) {
    return {p[3 * i], p[3 * i + 1], p[3 * i + 2]};
}

template <class R>
void put_vec3(R* p, std::int64_t i, const Vec3<R>& v) {
    for (int k = 0; k < 3; ++k) p[3 * i + k] = v[k];
}

/// body(i) for i in [0, count), in blocks, without the interpreter's lock.
template <class Body>
void for_each_row(std::int64_t count, Body&& body) {
    constexpr std::int64_t block_size = 4096;
    const py::gil_scoped_release release;
    parallel_for((count + block_size - 1) / block_size, [&](std::int64_t block) {
        const std::int64_t end = std::min(count, (block + 1) * block_size);
        for (std::int64_t i = block * block_size; i < end; ++i) body(i);
    });
}

/// Adds each row's derivative to d_parameters: row by row, or, where one row of parameters served all, into
/// it, as partial sums of fixed blocks in fixed order.
template <class R, class Model, class Derivative>
void add_parameter_rows(std::int64_t count, bool shared, R* d_parameters, Derivative&& derivative) {
    constexpr int size = parameter_count<Model>();
    constexpr std::int64_t block_size = 4096;
    const auto row_of = [&](std::int64_t i, auto* out) {
        Model d = derivative(i);
        for_each_scalar([&](auto& x) { *out++ += x; }, d);
    };
    if (!shared)
        return for_each_row(count, [&](std::int64_t i) { row_of(i, d_parameters + i * size); });
    const py::gil_scoped_release release;
    sum_partials<R>((count + block_size - 1) / block_size, std::span<R>(d_parameters, size),
                    [&](std::int64_t block, std::span<double> partial) {
                        const std::int64_t end = std::min(count, (block + 1) * block_size);
                        for (std::int64_t i = block * block_size; i < end; ++i)
                            row_of(i, partial.data());
                    });
}

}  // namespace photograd
