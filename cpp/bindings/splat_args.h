// Gaussians from arrays, for the bindings of splatting and of ray casting.
#pragma once

#include "array_groups.h"
#include "photograd/splat/options.h"

namespace photograd {

/// The second half of bind_splat, which calls it.
void bind_splat_rays(py::module_& m);

using GaussianArrays = Arrays<5>;  // means, log_scales, quats, opacity_logits, sh

template <class R>
GaussianCloud<R> cloud_of(ArrayArgs& args, const GaussianArrays& from) {
    GaussianCloud<R> cloud{};
    cloud.means = args.in<R>("means", from[0], "N 3");
    cloud.log_scales = args.in<R>("log_scales", from[1], "N 3");
    cloud.quats = args.in<R>("quats", from[2], "N 4");
    cloud.opacity_logits = args.in<R>("opacity_logits", from[3], "N");
    cloud.sh = args.in<R>("sh", from[4], "N K 3");
    cloud.count = args.size("N");
    if (cloud.count >= std::int64_t{1} << 31)
        args.range("means", "fewer than 2^31 rows", std::to_string(cloud.count));
    cloud.degree = degree_of(args);
    return cloud;
}
/// The Gaussians of an earlier call, of which there were `count`.
template <class R>
GaussianCloud<R> same_cloud(ArrayArgs& args, const GaussianArrays& from, std::int64_t count) {
    const auto cloud = cloud_of<R>(args, from);
    if (cloud.count != count)
        args.range("means", std::to_string(count) + " rows, as were prepared",
                   std::to_string(cloud.count));
    return cloud;
}

/// Without view and screen.
template <class R>
GaussianGradients<R> gradients_of(ArrayArgs& args, GaussianArrays& to) {
    return {args.out<R>("d_means", to[0], "N 3"),
            args.out<R>("d_log_scales", to[1], "N 3"),
            args.out<R>("d_quats", to[2], "N 4"),
            args.out<R>("d_opacity_logits", to[3], "N"),
            args.out<R>("d_sh", to[4], "N K 3"),
            nullptr,
            nullptr};
}

}  // namespace photograd
