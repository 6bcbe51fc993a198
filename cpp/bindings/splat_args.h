// Gaussians from arrays, for the bindings of splatting and of ray casting.
#pragma once

#include <string>

#include "array_args.h"
#include "photograd/splat/options.h"

namespace photograd {

/// The second half of bind_splat, which calls it.
void bind_splat_rays(py::module_& m);

inline int degree_of(const ArrayArgs& args) {
    switch (args.size("K")) {
        case 1: return 0;
        case 4: return 1;
        case 9: return 2;
        case 16: return 3;
        default:
            args.range("sh", "1, 4, 9 or 16 coefficients (degree 0 to 3)",
                       std::to_string(args.size("K")));
    }
}

template <class R>
GaussianCloud<R> cloud_of(ArrayArgs& args, const py::array& means, const py::array& log_scales,
                          const py::array& quats, const py::array& opacity_logits,
                          const py::array& sh) {
    GaussianCloud<R> cloud{};
    cloud.means = args.in<R>("means", means, "N 3");
    cloud.log_scales = args.in<R>("log_scales", log_scales, "N 3");
    cloud.quats = args.in<R>("quats", quats, "N 4");
    cloud.opacity_logits = args.in<R>("opacity_logits", opacity_logits, "N");
    cloud.sh = args.in<R>("sh", sh, "N K 3");
    cloud.count = args.size("N");
    if (cloud.count >= std::int64_t{1} << 31)
        args.range("means", "fewer than 2^31 rows", std::to_string(cloud.count));
    cloud.degree = degree_of(args);
    return cloud;
}

}  // namespace photograd
