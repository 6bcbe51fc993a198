// NumPy arrays in, checked. The only place that looks at dtype, contiguity, rank and axis sizes.
//
//   ArrayArgs args("composite_backward");
//   const float* sigma_t = args.in<float>("sigma_t", a, "R S");  // the first array to name an axis
//   float* d_sigma_t = args.out<float>("d_sigma_t", b, "R S");   // fixes its size for the others
//
// A number in the list is a fixed size: "N 3". Nothing is converted: the Python faces do that,
// visibly.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "photograd/core/errors.h"
#include "photograd/core/parallel.h"
#include "photograd/core/world_limit.h"
#include "pybind.h"

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

    /// `in`, and throws RangeError unless every number lies within [-most, most].
    template <class T>
    const T* within(const char* name, const py::array& array, std::string_view axes, double most) {
        const T* values = in<T>(name, array, axes);
        const T limit = static_cast<T>(std::min(most, double(std::numeric_limits<T>::max())));
        constexpr std::int64_t piece = 1 << 16;
        std::atomic<std::int64_t> bad = 0;
        parallel_for((array.size() + piece - 1) / piece, [&](std::int64_t p) {
            int count = 0;  // a sum of integers turns into lanes
            for (std::int64_t i = p * piece; i < std::min(array.size(), (p + 1) * piece); ++i)
                count += !(std::abs(values[i]) <= limit);
            bad += count;
        });
        if (bad > 0)
            refuse_numbers(name, array, bad, most,
                           [&](std::int64_t i) { return !(std::abs(values[i]) <= limit); });
        return values;
    }
    template <class T>
    const T* finite(const char* name, const py::array& array, std::string_view axes) {
        return within<T>(name, array, axes, std::numeric_limits<double>::max());
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
    template <class Bad>
    [[noreturn]] void refuse_numbers(const char* name, const py::array& array, std::int64_t count,
                                     double most, Bad&& bad) const {
        std::int64_t first = 0;
        while (!bad(first)) ++first;
        const std::int64_t row_size = array.size() / std::max<std::int64_t>(array.shape(0), 1);
        const bool any = most >= std::numeric_limits<double>::max();
        range(name,
              any ? "finite numbers"
                  : "numbers from " + number_text(-most) + " to " + number_text(most),
              std::to_string(count) + " that are not, the first in row " +
                  std::to_string(first / row_size));
    }
    void check(const char* name, const py::array& array, std::string_view axes,
               const py::dtype& type);

    std::string function_;
    std::map<std::string, std::pair<std::int64_t, std::string>>
        sizes_;  // axis -> size, who fixed it
};

/// Samples [first, first + count) have numbers of 32 bits.
inline void check_samples(const ArrayArgs& args, std::uint32_t first, std::uint32_t count) {
    if (count > std::numeric_limits<std::uint32_t>::max() - first)
        args.range("first, count", "numbers of samples below 2^32",
                   std::to_string(first) + " + " + std::to_string(count));
}

/// Calls visit(float{}, args) or visit(double{}, args) according to the dtype of `array`; refuses
/// others by name. `args` are those of `function`.
template <class Visit>
decltype(auto) dispatch_real(const char* function, const char* argument, const py::array& array,
                             Visit&& visit) {
    ArrayArgs args(function);
    if (array.dtype().is(py::dtype::of<float>())) return visit(float{}, args);
    if (array.dtype().is(py::dtype::of<double>())) return visit(double{}, args);
    fail(ErrorKind::dtype, function, argument, "dtype float32 or float64",
         "dtype " + std::string(py::str(array.dtype())),
         "convert with numpy.asarray(..., numpy.float32)");
}

/// An entry of a tuple or a list as a T, refused by name if it is something else.
template <class T>
T entry_as(const char* function, const char* argument, const char* expected,
           const py::handle& entry) {
    try {
        return entry.cast<T>();
    } catch (const py::cast_error&) {
        fail(ErrorKind::dtype, function, argument, expected,
             std::string(py::str(py::type::of(entry))));
    }
}

/// A fresh zero-filled array.
template <class T>
py::array_t<T> zeros(const std::vector<py::ssize_t>& shape) {
    py::array_t<T> array(shape);
    std::fill_n(array.mutable_data(), array.size(), T(0));
    return array;
}

}  // namespace photograd
