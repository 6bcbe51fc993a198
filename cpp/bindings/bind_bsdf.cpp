// Every model of bsdf/registry.h as a class of static functions on arrays, and {name: class} as _core.bsdfs; the same
// for perfectly smooth ones as _core.delta_bsdfs.
#include "bind_delta.h"
#include "model_args.h"
#include "module.h"
#include "photograd/bsdf/registry.h"

namespace photograd {
namespace {

template <template <class> class M>
struct BoundBsdf {
    static py::array f(const py::array& parameters, const py::array& wo, const py::array& wi) {
        return dispatch_real("f", "parameters", parameters, [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args("f");
            const R *o = args.in<R>("wo", wo, "N 3"), *i = args.in<R>("wi", wi, "N 3");
            const auto rows = ModelRows<R>::template read<M<R>>(args, parameters);
            py::array_t<R> out({args.size("N"), std::int64_t(3)});
            R* value = out.mutable_data();
            for_each_row(args.size("N"), [&](std::int64_t n) {
                const M<R> model = model_at(M<R>{}, rows.data + n * rows.step);
                put_vec3(value, n, model.f(vec3_at(o, n), vec3_at(i, n)));
            });
            return out;
        });
    }
    static py::array f_backward(const py::array& parameters, const py::array& wo,
                                const py::array& wi, const py::array& d_f, py::array d_parameters) {
        return dispatch_real("f_backward", "parameters", parameters, [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args("f_backward");
            const R *o = args.in<R>("wo", wo, "N 3"), *i = args.in<R>("wi", wi, "N 3");
            const R* d = args.in<R>("d_f", d_f, "N 3");
            const auto rows = ModelRows<R>::template read<M<R>>(args, parameters);
            const std::string axes =
                (rows.step ? "N " : "1 ") + std::to_string(parameter_count<M<R>>());
            R* out = args.out<R>("d_parameters", d_parameters, axes);
            add_parameter_rows<R, M<R>>(args.size("N"), rows.step == 0, out, [&](std::int64_t n) {
                M<R> d_model = zero_model<M<R>, R>();
                model_at(M<R>{}, rows.data + n * rows.step)
                    .f_backward(vec3_at(o, n), vec3_at(i, n), vec3_at(d, n), d_model);
                return d_model;
            });
            return d_parameters;
        });
    }
    static py::array jvp(const py::array& parameters, const py::array& v, const py::array& wo,
                         const py::array& wi) {
        using D = Dual<double>;
        ArrayArgs args("jvp");
        const double *o = args.in<double>("wo", wo, "N 3"), *i = args.in<double>("wi", wi, "N 3");
        const auto rows = ModelRows<double>::read<M<double>>(args, parameters);
        const auto tangents = ModelRows<double>::read<M<double>>(args, v);
        py::array_t<double> out({args.size("N"), std::int64_t(3)});
        double* value = out.mutable_data();
        for_each_row(args.size("N"), [&](std::int64_t n) {
            const double *row = rows.data + n * rows.step,
                         *tangent = tangents.data + n * tangents.step;
            M<D> model;
            for_each_scalar([&](D& x) { x = D(*row++, *tangent++); }, model);
            const auto lift = [n](const double* p) {
                return Vec3<D>(D(p[3 * n]), D(p[3 * n + 1]), D(p[3 * n + 2]));
            };
            const Vec3<D> result = model.f(lift(o), lift(i));
            for (int k = 0; k < 3; ++k) value[3 * n + k] = result[k].tangent;
        });
        return out;
    }
    static py::array sample(const py::array& parameters, const py::array& wo, const py::array& u2) {
        return dispatch_real("sample", "parameters", parameters, [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args("sample");
            const R *o = args.in<R>("wo", wo, "N 3"), *u = args.in<R>("u2", u2, "N 2");
            const auto rows = ModelRows<R>::template read<M<R>>(args, parameters);
            py::array_t<R> out({args.size("N"), std::int64_t(3)});
            R* wi = out.mutable_data();
            for_each_row(args.size("N"), [&](std::int64_t n) {
                const M<R> model = model_at(M<R>{}, rows.data + n * rows.step);
                put_vec3(wi, n, model.sample(vec3_at(o, n), Vec2<R>(u[2 * n], u[2 * n + 1])));
            });
            return out;
        });
    }
    static py::array pdf(const py::array& parameters, const py::array& wo, const py::array& wi) {
        return dispatch_real("pdf", "parameters", parameters, [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args("pdf");
            const R *o = args.in<R>("wo", wo, "N 3"), *i = args.in<R>("wi", wi, "N 3");
            const auto rows = ModelRows<R>::template read<M<R>>(args, parameters);
            py::array_t<R> out(args.size("N"));
            R* density = out.mutable_data();
            for_each_row(args.size("N"), [&](std::int64_t n) {
                const M<R> model = model_at(M<R>{}, rows.data + n * rows.step);
                density[n] = model.pdf(vec3_at(o, n), vec3_at(i, n));
            });
            return out;
        });
    }
    static py::array index_inside(const py::array& parameters) {
        ArrayArgs args("index_inside");
        const auto count = static_cast<std::int64_t>(parameter_count<M<double>>());
        const double* rows =
            args.in<double>("parameters", parameters, "N " + std::to_string(count));
        py::array_t<double> out({args.size("N"), std::int64_t(3)});
        for (std::int64_t n = 0; n < args.size("N"); ++n) {
            Vec3<double> index(1.0);
            if constexpr (transmits<M<double>>())
                index = model_at(M<double>{}, rows + n * count).index_inside();
            put_vec3(out.mutable_data(), n, index);
        }
        return out;
    }
    static py::object bind(py::module_& m) {
        using T = M<double>;
        static constexpr const char* energies[] = {"conserving", "lossy", "gains"};
        py::class_<BoundBsdf> type(
            m, (std::string("bsdf_") + T::name).c_str(),
            "A reflectance model. Parameters (N, P), or (1, P) for all rows; "
            "directions (N, 3) in the shading frame, normal +Z.");
        type.def_static("f", &f, py::arg("parameters"), py::arg("wo"), py::arg("wi"),
                        "Value without the cosine, (N, 3).")
            .def_static("f_backward", &f_backward, py::arg("parameters"), py::arg("wo"),
                        py::arg("wi"), py::arg("d_f"), py::arg("d_parameters"),
                        "Adds dL/dparameters to d_parameters, shaped like parameters; returns it.")
            .def_static("jvp", &jvp, py::arg("parameters"), py::arg("v"), py::arg("wo"),
                        py::arg("wi"), "Exact derivative of f along v, (N, 3), float64.")
            .def_static("sample", &sample, py::arg("parameters"), py::arg("wo"), py::arg("u2"),
                        "wi (N, 3) from uniform u2 (N, 2).")
            .def_static("pdf", &pdf, py::arg("parameters"), py::arg("wo"), py::arg("wi"),
                        "Density of `sample` over solid angle, (N,).");
        type.def_static(
            "parameters", [] { return parameter_rows(T::params); },
            "(name, scalars, lo, hi, unit) of each parameter, in the order of a row.");
        type.def_static(
            "energy",
            [] {
                return std::pair<std::string, double>(energies[static_cast<int>(T::energy.kind)],
                                                      T::energy.most);
            },
            "What is claimed of the directional albedo: (conserving, lossy or gains; its bound).");
        type.def_static(
            "reciprocal", [] { return T::reciprocal; },
            "Whether f(wo, wi) / index(wo)^2 = f(wi, wo) / index(wi)^2; outside the index is 1.");
        type.def_static("index_inside", &index_inside, py::arg("parameters"),
                        "Refractive index below the surface over that above, per channel (N, 3), "
                        "of parameters (N, P) float64.");
        type.def_static(
            "transmits", [] { return transmits<T>(); }, "Whether light may pass the surface.");
        return type;
    }
};

}  // namespace

void bind_bsdf(py::module_& m) {
    py::dict registry;
    Bsdfs::for_each(
        [&]<template <class> class M>() { registry[M<double>::name] = BoundBsdf<M>::bind(m); });
    m.attr("bsdfs") = registry;
    py::dict deltas;
    DeltaBsdfs::for_each(
        [&]<template <class> class M>() { deltas[M<double>::name] = BoundDelta<M>::bind(m); });
    m.attr("delta_bsdfs") = deltas;
}

}  // namespace photograd
