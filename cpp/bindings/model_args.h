// Models of a registry as flat functions on arrays: parameters (N, P) or (1, P), one row of P
// scalars a model.
#pragma once

#include <algorithm>
#include <span>

#include "array_args.h"
#include "photograd/core/parallel.h"
#include "photograd/core/params.h"
#include "photograd/core/real.h"
#include "photograd/core/scatter.h"
#include "pybind.h"

namespace photograd {

/// (name, scalars, lo, hi, unit) of each described parameter.
using ParameterRows = std::vector<std::tuple<std::string, int, double, double, std::string>>;

inline ParameterRows parameter_rows(std::span<const ParameterInfo> infos) {
    ParameterRows rows;
    for (const ParameterInfo& q : infos) rows.emplace_back(q.name, q.scalars, q.lo, q.hi, q.unit);
    return rows;
}

inline int scalars_in(std::span<const ParameterInfo> infos) {
    int count = 0;
    for (const ParameterInfo& q : infos) count += q.scalars;
    return count;
}

/// Rows of `count` parameters for N evaluations; one row serves all.
template <class R>
struct ModelRows {
    const R* data;
    std::int64_t step;  // scalars from one row to the next: count, or 0

    static ModelRows read(ArrayArgs& args, const py::array& parameters, int count) {
        const bool single = parameters.ndim() == 2 && parameters.shape(0) == 1;
        const std::string axes = (single ? "1 " : "N ") + std::to_string(count);
        return {args.in<R>("parameters", parameters, axes), single ? 0 : count};
    }
    [[nodiscard]] const R* at(std::int64_t n) const { return data + n * step; }
    [[nodiscard]] bool shared() const { return step == 0; }
    /// Axes of an array that takes the derivatives of all rows.
    [[nodiscard]] std::string axes(int count) const {
        return (shared() ? "1 " : "N ") + std::to_string(count);
    }
};

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

/// A fresh array (N, 3), row n of which is vector(n).
template <class R, class Vector>
py::array vector_rows(const ArrayArgs& args, Vector&& vector) {
    py::array_t<R> out({args.size("N"), std::int64_t(3)});
    R* to = out.mutable_data();
    for_each_row(args.size("N"), [&](std::int64_t n) { put_vec3(to, n, vector(n)); });
    return out;
}
/// A fresh array (N,) of value(n).
template <class R, class Value>
py::array value_rows(const ArrayArgs& args, Value&& value) {
    py::array_t<R> out(args.size("N"));
    R* to = out.mutable_data();
    for_each_row(args.size("N"), [&](std::int64_t n) { to[n] = value(n); });
    return out;
}

inline constexpr int max_row = 64;  // numbers of one model

/// Adds derivatives to d_parameters, `size` numbers a row: derivative(i, d) adds those of
/// evaluation i to zeros d. Row by row, or, where one row of parameters served all, into it, as
/// partial sums of fixed blocks in fixed order.
template <class R, class Derivative>
void add_parameter_rows(int size, std::int64_t count, bool shared, R* d_parameters,
                        Derivative&& derivative) {
    constexpr std::int64_t block_size = 4096;
    const auto row_of = [&](std::int64_t i, auto* out) {
        R d[max_row];
        std::fill_n(d, size, R(0));
        derivative(i, d);
        for (int k = 0; k < size; ++k) out[k] += d[k];
    };
    if (!shared)
        return for_each_row(count, [&](std::int64_t i) { row_of(i, d_parameters + i * size); });
    const py::gil_scoped_release release;
    sum_partials<R>((count + block_size - 1) / block_size,
                    std::span<R>(d_parameters, static_cast<std::size_t>(size)),
                    [&](std::int64_t block, std::span<double> partial) {
                        const std::int64_t end = std::min(count, (block + 1) * block_size);
                        for (std::int64_t i = block * block_size; i < end; ++i)
                            row_of(i, partial.data());
                    });
}

}  // namespace photograd
