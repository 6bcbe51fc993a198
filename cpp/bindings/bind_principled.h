// Many evaluations of the principled surface at once.
#pragma once

#include <pybind11/pybind11.h>

namespace photograd {

void bind_principled(pybind11::module_& m);

}  // namespace photograd
