// The fields that the marcher renders from one array of parameters. A new field: one header and one
// line here.
//
// A field whose parameters lie in several arrays (field/sparse_sh.h) has bindings of its own.
#pragma once

#include "photograd/core/params.h"
#include "photograd/field/dense_grid.h"
#include "photograd/field/tiny_network.h"

namespace photograd {

/// A field that is made from one array: `axes` names the array's axes as array_args.h reads them,
/// `shape` holds their sizes, and `expected` says which of them `fits` accepts.
template <class F>
concept ArrayField = Field<F> && requires(const typename F::Scalar* parameters,
                                          const std::int64_t* shape, const FieldOptions& options) {
    { F::axes } -> std::convertible_to<const char*>;
    { F::expected() } -> std::convertible_to<std::string>;
    { F::fits(shape) } -> std::convertible_to<bool>;
    { F::over(parameters, shape, options) } -> std::same_as<F>;
};

template <ArrayField... F>
using FieldList = TypeList<F...>;

template <Real R>
using Fields = FieldList<DenseGrid<R>, TinyNetwork<R>>;

}  // namespace photograd
