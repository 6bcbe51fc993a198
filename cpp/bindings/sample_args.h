// Rows of samples that belong together, such as those of a ray or of a network.
#pragma once

#include <algorithm>

#include "array_args.h"
#include "photograd/render/march/sample_rows.h"

namespace photograd {

/// The rows of `offset`, which must rise from 0 to the number of samples, the axis M.
inline SampleRows sample_rows(ArrayArgs& args, const py::array& offset) {
    const auto* at = args.in<std::int64_t>("offset", offset, "O");
    const std::int64_t last = args.size("O") - 1;
    const bool whole = last >= 0 && at[0] == 0 && at[last] == args.size("M");
    if (!whole || !std::is_sorted(at, at + last + 1))
        args.range("offset", "numbers that rise from 0 to " + std::to_string(args.size("M")),
                   "others");
    return {last, at};
}

}  // namespace photograd
