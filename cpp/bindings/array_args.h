// NumPy arrays in, checked. The only place that looks at dtype, contiguity, rank and axis sizes.
//
//   ArrayArgs args("composite_backward");
//   const float* sigma_t = args.in<float>("sigma_t", a, "R S");      // the first array to name an axis
//   float* d_sigma_t = args.out<float>("d_sigma_t", b, "R S");       // fixes its size for the others
//
// A number in the list is a fixed size: "N 3". Nothing is converted: the Python faces do that, visibly.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "photograd/core/errors.h"

namespace photograd {

namespace py = pybind11;

/// Sizes of all axes, as NumPy prints them.
std::string shape_text(const py::array& array);

class ArrayArgs {
public:
    explicit ArrayArgs(std::string function) : function_(std::move(function)) {}

    /// Read-only data of `array`, which must be C-contiguous, of dtype T, with the named axes.
    template <class T>
    const T* in(const char* name, const py::array& array, std::string_view axes) {
        check(name, array, axes, py::dtype::of<T>());
        return static_cast<const T*>(array.data());
    }

    /// Writable data of `array`, under the same conditions.
    template <class T>
    T* out(const char* name, py::array& array, std::string_view axes) {
        check(name, array, axes, py::dtype::of<T>());
        if (!array.writeable())
            fail(ErrorKind::range, function_, name, "a writable array", "a read-only one",
                 "pass a copy");
        return static_cast<T*>(array.mutable_data());
    }

    /// Size of an axis that an earlier array has named.
    [[nodiscard]] std::int64_t size(const std::string& axis) const { return sizes_.at(axis).first; }

    [[noreturn]] void range(std::string_view argument, std::string_view expected,
                            std::string_view got, std::string_view remedy = {}) const {
        fail(ErrorKind::range, function_, argument, expected, got, remedy);
    }

private:
    void check(const char* name, const py::array& array, std::string_view axes,
               const py::dtype& type);

    std::string function_;
    std::map<std::string, std::pair<std::int64_t, std::string>>
        sizes_;  // axis -> size, who fixed it
};

/// Calls visit(float{}) or visit(double{}) according to the dtype of `array`; refuses others by name.
template <class Visit>
decltype(auto) dispatch_real(const char* function, const char* argument, const py::array& array,
                             Visit&& visit) {
    if (array.dtype().is(py::dtype::of<float>())) return visit(float{});
    if (array.dtype().is(py::dtype::of<double>())) return visit(double{});
    fail(ErrorKind::dtype, function, argument, "dtype float32 or float64",
         "dtype " + std::string(py::str(array.dtype())),
         "convert with numpy.asarray(..., numpy.float32)");
}

/// A fresh zero-filled array.
template <class T>
py::array_t<T> zeros(const std::vector<py::ssize_t>& shape) {
    py::array_t<T> array(shape);
    std::fill_n(array.mutable_data(), array.size(), T(0));
    return array;
}

}  // namespace photograd
