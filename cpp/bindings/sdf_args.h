// Signed distance fields (SDFs) as Python hands them over.
#pragma once

#include <string>

#include "array_args.h"
#include "photograd/geometry/reference/sdf.h"

namespace photograd {

/// The numbers (P,) of a body, none of them useless.
inline const double* checked_numbers(ArrayArgs& args, const Sdf& body, const py::array& numbers) {
    const double* x = args.in<double>("numbers", numbers, std::to_string(body.number_count()));
    if (const char* expected = body.fault(x)) args.range("numbers", expected, "others");
    return x;
}

}  // namespace photograd
