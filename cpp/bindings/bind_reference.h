// Hierarchies, partitions and distances that are written to be read, and single rays to look at.
#pragma once

#include <pybind11/pybind11.h>

namespace photograd {

void bind_reference(pybind11::module_& m);
void bind_sdf(pybind11::module_& m);
void bind_first_hits(pybind11::module_& m);

}  // namespace photograd
