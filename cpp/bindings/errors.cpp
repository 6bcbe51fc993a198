// photograd::Error arrives in Python as the class of photograd_course.errors that its kind names.
#include "photograd/core/errors.h"

#include "module.h"

namespace photograd {

void bind_errors(py::module_&) {
    // The signature is pybind11's.
    py::register_exception_translator(
        [](std::exception_ptr pending) {  // NOLINT(performance-unnecessary-value-param)
            try {
                if (pending) std::rethrow_exception(pending);
            } catch (const Error& error) {
                static constexpr const char* names[] = {"Error",      "ShapeError", "RangeError",
                                                        "DtypeError", "IoError",    "SceneError"};
                const py::module_ errors = py::module_::import("photograd_course.errors");
                const py::object type = errors.attr(names[static_cast<int>(error.kind())]);
                py::set_error(type, error.what());
            }
        });
}

}  // namespace photograd
