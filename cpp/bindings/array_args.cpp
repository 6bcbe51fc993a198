#include "array_args.h"

#include <charconv>

namespace photograd {
namespace {

std::vector<std::string> split(std::string_view axes) {
    std::vector<std::string> names;
    while (!axes.empty()) {
        const std::size_t end = std::min(axes.find(' '), axes.size());
        names.emplace_back(axes.substr(0, end));
        axes.remove_prefix(std::min(end + 1, axes.size()));
    }
    return names;
}

std::string wanted_shape(const std::vector<std::string>& names) {
    std::string text = "shape (";
    for (std::size_t i = 0; i < names.size(); ++i) text += (i ? ", " : "") + names[i];
    return text + (names.size() == 1 ? ",)" : ")");
}

}  // namespace

std::string shape_text(const py::array& array) {
    std::string text = "(";
    for (py::ssize_t i = 0; i < array.ndim(); ++i)
        text += (i ? ", " : "") + std::to_string(array.shape(i));
    return text + (array.ndim() == 1 ? ",)" : ")");
}

void ArrayArgs::check(const char* name, const py::array& array, std::string_view axes,
                      const py::dtype& type) {
    if (!array.dtype().is(type))
        fail(ErrorKind::dtype, function_, name, "dtype " + std::string(py::str(type)),
             "dtype " + std::string(py::str(array.dtype())),
             "convert it first, nothing is converted here");
    const std::vector<std::string> names = split(axes);
    if (array.ndim() != static_cast<py::ssize_t>(names.size()))
        fail(ErrorKind::shape, function_, name, wanted_shape(names), shape_text(array));
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string& axis = names[i];
        const std::int64_t size = array.shape(static_cast<py::ssize_t>(i));
        std::int64_t fixed = 0;
        const char* end = axis.data() + axis.size();
        if (std::from_chars(axis.data(), end, fixed).ptr == end) {
            if (size != fixed)
                fail(ErrorKind::shape, function_, name, wanted_shape(names), shape_text(array));
            continue;
        }
        const auto [known, inserted] = sizes_.try_emplace(axis, size, name);
        if (!inserted && known->second.first != size)
            fail(ErrorKind::shape, function_, name,
                 wanted_shape(names) + " with " + axis + " = " +
                     std::to_string(known->second.first) + " as in " + known->second.second,
                 shape_text(array));
    }
    constexpr int aligned = py::detail::npy_api::NPY_ARRAY_ALIGNED_;
    if (!(array.flags() & aligned))
        fail(ErrorKind::shape, function_, name, "an aligned array", "one at an odd address",
             "pass a copy");
    if (!(array.flags() & py::array::c_style))
        fail(ErrorKind::shape, function_, name, "a C-contiguous array", "a strided one",
             "pass numpy.ascontiguousarray(...)");
}

}  // namespace photograd
