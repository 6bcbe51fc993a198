// The stages of a march one by one; photograd.fields.leaf_codes puts them together.
#include <algorithm>

#include "march_args.h"
#include "module.h"
#include "sample_args.h"

namespace photograd {
namespace {

template <class T>
py::array_t<T> rows_of(const std::vector<T>& from, py::ssize_t columns) {
    const auto rows = static_cast<py::ssize_t>(from.size()) / columns;
    py::array_t<T> out(columns == 1 ? std::vector<py::ssize_t>{rows}
                                    : std::vector<py::ssize_t>{rows, columns});
    std::copy(from.begin(), from.end(), out.mutable_data());
    return out;
}

py::tuple samples_in(const CellTable& table, const MarchSettings& settings,
                     const RayArrays& ray_arrays) {
    return dispatch_real(
        "visible_samples", "origins", ray_arrays[0], [&](auto real, ArrayArgs& args) -> py::tuple {
            using R = decltype(real);
            const RayBatch<R> rays = ray_batch<R>(args, ray_arrays);
            SparseSh<R> grid;
            grid.table = &table;
            grid.options = settings.field;
            grid.fit_to_box();
            const VisibleSamples<R> found = [&] {
                const py::gil_scoped_release release;
                return visible_samples(grid, rays, static_cast<R>(settings.march.dt));
            }();
            return py::make_tuple(rows_of(found.offset, 1), rows_of(found.t, 1),
                                  rows_of(found.point, 3));
        });
}

py::tuple weights_of(const py::array& offset, const py::array& sigma_t, double dt) {
    return dispatch_real(
        "sample_weights", "sigma_t", sigma_t, [&](auto real, ArrayArgs& args) -> py::tuple {
            using R = decltype(real);
            const R* sigma = args.in<R>("sigma_t", sigma_t, "M");
            const SampleRows rows = sample_rows(args, offset);
            py::array_t<R> weight(args.size("M")), behind(args.size("M")), left(rows.rays);
            R *w = weight.mutable_data(), *b = behind.mutable_data(), *t = left.mutable_data();
            {
                const py::gil_scoped_release release;
                sample_weights(rows, sigma, static_cast<R>(dt), w, b, t);
            }
            return py::make_tuple(weight, behind, left);
        });
}

py::array weights_backward(const py::array& offset, const Arrays<2>& weights, double dt,
                           const Arrays<2>& d_weights) {
    return dispatch_real("sample_weights_backward", "weight", weights[0],
                         [&](auto real, ArrayArgs& args) -> py::array {
                             using R = decltype(real);
                             const R *weight = args.in<R>("weight", weights[0], "M"),
                                     *behind = args.in<R>("behind", weights[1], "M"),
                                     *d_weight = args.in<R>("d_weight", d_weights[0], "M");
                             const SampleRows rows = sample_rows(args, offset);
                             const R* d_left = args.in<R>("d_transmittance", d_weights[1],
                                                          std::to_string(rows.rays));
                             py::array_t<R> d_sigma_t(args.size("M"));
                             R* to = d_sigma_t.mutable_data();
                             {
                                 const py::gil_scoped_release release;
                                 sample_weights_backward(rows, weight, behind, static_cast<R>(dt),
                                                         d_weight, d_left, to);
                             }
                             return d_sigma_t;
                         });
}

py::array blended(const py::array& offset, const py::array& weight, const py::array& values) {
    return dispatch_real("blend_samples", "weight", weight,
                         [&](auto real, ArrayArgs& args) -> py::array {
                             using R = decltype(real);
                             const R *w = args.in<R>("weight", weight, "M"),
                                     *from = args.in<R>("values", values, "M C");
                             const SampleRows rows = sample_rows(args, offset);
                             const std::int64_t channels = args.size("C");
                             py::array_t<R> out({rows.rays, channels});
                             R* to = out.mutable_data();
                             {
                                 const py::gil_scoped_release release;
                                 blend_samples(rows, w, from, static_cast<int>(channels), to);
                             }
                             return out;
                         });
}

}  // namespace

void bind_samples(py::module_& m) {
    m.def("visible_samples", &samples_in, py::arg("table"), py::arg("settings"), py::arg("rays"),
          "offset (R + 1,), t (M,) and points (M, 3) in voxels of the samples of rays that lie in "
          "cells with an active voxel.");
    m.def("sample_weights", &weights_of, py::arg("offset"), py::arg("sigma_t"), py::arg("dt"),
          "weight (M,), transmittance behind each sample (M,), and of each ray (R,).");
    m.def("sample_weights_backward", &weights_backward, py::arg("offset"), py::arg("weights"),
          py::arg("dt"), py::arg("d_weights"),
          "d_sigma_t (M,). weights: weight and behind; d_weights: d_weight, d_transmittance (R,).");
    m.def("blend_samples", &blended, py::arg("offset"), py::arg("weight"), py::arg("values"),
          "(R, C): the sum of weight times values (M, C) over the samples of each ray.");
}

}  // namespace photograd
