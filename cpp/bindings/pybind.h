// pybind11, whose code runs once a call: optimized little, for the sake of the time to compile it.
#pragma once

#pragma GCC push_options
#pragma GCC optimize("O1")
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#pragma GCC pop_options
