// Every model of bsdf/delta_registry.h as a class of static functions on arrays.
#pragma once

#include "model_args.h"
#include "photograd/bsdf/delta_registry.h"

namespace photograd {

template <template <class> class M>
struct BoundDelta {
    static constexpr auto lobe_count = static_cast<std::int64_t>(M<double>::lobe_count);
    template <class R>
    using Lobes = std::array<DeltaLobe<R>, M<R>::lobe_count>;

    static std::string lobe_axes() { return "N " + std::to_string(lobe_count) + " 3"; }

    static py::tuple lobes(const py::array& parameters, const py::array& wo) {
        py::array weight;
        const py::array wi =
            dispatch_real("lobes", "parameters", parameters, [&](auto real) -> py::array {
                using R = decltype(real);
                ArrayArgs args("lobes");
                const R* o = args.in<R>("wo", wo, "N 3");
                const auto rows = ModelRows<R>::template read<M<R>>(args, parameters);
                py::array_t<R> directions({args.size("N"), lobe_count, std::int64_t(3)});
                py::array_t<R> weights({args.size("N"), lobe_count, std::int64_t(3)});
                R *to = directions.mutable_data(), *w = weights.mutable_data();
                for_each_row(args.size("N"), [&](std::int64_t n) {
                    const auto found =
                        model_at(M<R>{}, rows.data + n * rows.step).lobes(vec3_at(o, n));
                    for (std::int64_t k = 0; k < lobe_count; ++k) {
                        put_vec3(to, n * lobe_count + k, found[static_cast<std::size_t>(k)].wi);
                        put_vec3(w, n * lobe_count + k, found[static_cast<std::size_t>(k)].weight);
                    }
                });
                weight = weights;
                return directions;
            });
        return py::make_tuple(wi, weight);
    }
    static py::array lobes_backward(const py::array& parameters, const py::array& wo,
                                    const py::array& d_wi, const py::array& d_weight,
                                    py::array d_parameters) {
        const auto typed = [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args("lobes_backward");
            const R* o = args.in<R>("wo", wo, "N 3");
            const R* d_to = args.in<R>("d_wi", d_wi, lobe_axes());
            const R* d_w = args.in<R>("d_weight", d_weight, lobe_axes());
            const auto rows = ModelRows<R>::template read<M<R>>(args, parameters);
            const std::string axes =
                (rows.step ? "N " : "1 ") + std::to_string(parameter_count<M<R>>());
            R* out = args.out<R>("d_parameters", d_parameters, axes);
            add_parameter_rows<R, M<R>>(args.size("N"), rows.step == 0, out, [&](std::int64_t n) {
                Lobes<R> d_lobes;
                for (std::int64_t k = 0; k < lobe_count; ++k)
                    d_lobes[static_cast<std::size_t>(k)] = {vec3_at(d_to, n * lobe_count + k),
                                                            vec3_at(d_w, n * lobe_count + k)};
                M<R> d_model = zero_model<M<R>, R>();
                model_at(M<R>{}, rows.data + n * rows.step)
                    .lobes_backward(vec3_at(o, n), d_lobes, d_model);
                return d_model;
            });
            return d_parameters;
        };
        return dispatch_real("lobes_backward", "parameters", parameters, typed);
    }
    static py::tuple jvp(const py::array& parameters, const py::array& v, const py::array& wo) {
        using D = Dual<double>;
        ArrayArgs args("jvp");
        const double* o = args.in<double>("wo", wo, "N 3");
        const auto rows = ModelRows<double>::read<M<double>>(args, parameters);
        const auto tangents = ModelRows<double>::read<M<double>>(args, v);
        py::array_t<double> wi({args.size("N"), lobe_count, std::int64_t(3)});
        py::array_t<double> weight({args.size("N"), lobe_count, std::int64_t(3)});
        double *to = wi.mutable_data(), *w = weight.mutable_data();
        for_each_row(args.size("N"), [&](std::int64_t n) {
            const double *row = rows.data + n * rows.step,
                         *tangent = tangents.data + n * tangents.step;
            M<D> model;
            for_each_scalar([&](D& x) { x = D(*row++, *tangent++); }, model);
            const Lobes<D> found =
                model.lobes(Vec3<D>(D(o[3 * n]), D(o[3 * n + 1]), D(o[3 * n + 2])));
            for (std::int64_t k = 0; k < lobe_count; ++k)
                for (int c = 0; c < 3; ++c) {
                    const DeltaLobe<D>& lobe = found[static_cast<std::size_t>(k)];
                    to[3 * (n * lobe_count + k) + c] = lobe.wi[c].tangent;
                    w[3 * (n * lobe_count + k) + c] = lobe.weight[c].tangent;
                }
        });
        return py::make_tuple(wi, weight);
    }
    static py::object bind(py::module_& m) {
        using T = M<double>;
        py::class_<BoundDelta> type(
            m, (std::string("delta_bsdf_") + T::name).c_str(),
            py::module_local(),  // tests load a second module with the same models
            "A perfectly smooth surface. Parameters (N, P), or (1, P) for all rows; "
            "wo (N, 3) in the shading frame, normal +Z, on either side.");
        type.def_static("lobes", &lobes, py::arg("parameters"), py::arg("wo"),
                        "(wi, weight), (N, L, 3) each: L(wo) is the sum of weight L(wi).")
            .def_static("lobes_backward", &lobes_backward, py::arg("parameters"), py::arg("wo"),
                        py::arg("d_wi"), py::arg("d_weight"), py::arg("d_parameters"),
                        "Adds dL/dparameters to d_parameters, shaped like parameters; returns it.")
            .def_static("jvp", &jvp, py::arg("parameters"), py::arg("v"), py::arg("wo"),
                        "Exact derivatives of (wi, weight) along v, float64.")
            .def_static(
                "lobe_count", [] { return lobe_count; }, "L.")
            .def_static(
                "parameters", [] { return parameter_rows(T::params); },
                "(name, scalars, lo, hi, unit) of each parameter, in the order of a row.");
        return type;
    }
};

}  // namespace photograd
