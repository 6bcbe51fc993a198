// Hierarchies, partitions and distances that are written to be read.
#pragma once

#include <pybind11/pybind11.h>

namespace photograd {

void bind_reference(pybind11::module_& m);
void bind_sdf(pybind11::module_& m);

}  // namespace photograd
