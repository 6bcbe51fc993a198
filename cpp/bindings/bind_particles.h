// Parts of the module that follow light in other ways than bind_path.cpp.
#pragma once

#include <pybind11/pybind11.h>

namespace photograd {

void bind_path_tangent(pybind11::module_& m);
void bind_particles(pybind11::module_& m);

}  // namespace photograd
