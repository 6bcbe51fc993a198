// Every light at infinity of light/registry.h as a class of static functions on arrays, and {name: class} as
// _core.lights. All lights as a tracer sees them are bound in bind_sampled_lights.cpp.
#include "light_calls.h"
#include "module.h"
#include "photograd/light/registry.h"

namespace photograd {
namespace {

template <template <class> class M>
struct BoundLight {
    static py::array L(const py::array& parameters, const py::array& constants,
                       const py::array& w) {
        return dispatch_real("L", "parameters", parameters, [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args("L");
            const M<R> light = light_of<M<R>, R>(args, parameters, constants);
            const R* in = args.in<R>("w", w, "N 3");
            py::array_t<R> out({args.size("N"), std::int64_t(3)});
            R* value = out.mutable_data();
            for_each_row(args.size("N"),
                         [&](std::int64_t n) { put_vec3(value, n, light.L(vec3_at(in, n))); });
            return out;
        });
    }
    static py::array L_backward(const py::array& parameters, const py::array& constants,
                                const py::array& w, const py::array& d_L, py::array d_parameters) {
        return dispatch_real("L_backward", "parameters", parameters, [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args("L_backward");
            const M<R> light = light_of<M<R>, R>(args, parameters, constants);
            const R *in = args.in<R>("w", w, "N 3"), *d = args.in<R>("d_L", d_L, "N 3");
            R* out =
                args.out<R>("d_parameters", d_parameters, std::to_string(parameter_count<M<R>>()));
            add_parameter_rows<R, M<R>>(args.size("N"), true, out, [&](std::int64_t n) {
                M<R> d_light = zero_model<M<R>, R>();
                light.L_backward(vec3_at(in, n), vec3_at(d, n), d_light);
                return d_light;
            });
            return d_parameters;
        });
    }
    static py::array jvp(const py::array& parameters, const py::array& constants,
                         const py::array& v, const py::array& w) {
        using D = Dual<double>;
        ArrayArgs args("jvp");
        const double* tangent =
            args.in<double>("v", v, std::to_string(parameter_count<M<double>>()));
        const double* in = args.in<double>("w", w, "N 3");
        M<D> dual;
        const double *p = args.in<double>("parameters", parameters,
                                          std::to_string(parameter_count<M<double>>())),
                     *c = args.in<double>("constants", constants,
                                          std::to_string(scalars_in(M<double>::constants)));
        for_each_scalar(M<D>::params, [&](D& x) { x = D(*p++, *tangent++); }, dual);
        for_each_scalar(M<D>::constants, [&](D& x) { x = D(*c++); }, dual);
        py::array_t<double> out({args.size("N"), std::int64_t(3)});
        double* value = out.mutable_data();
        for_each_row(args.size("N"), [&](std::int64_t n) {
            const Vec3<D> result = dual.L({D(in[3 * n]), D(in[3 * n + 1]), D(in[3 * n + 2])});
            for (int k = 0; k < 3; ++k) value[3 * n + k] = result[k].tangent;
        });
        return out;
    }
    static py::array sample(const py::array& parameters, const py::array& constants,
                            const py::array& u2) {
        return dispatch_real("sample", "parameters", parameters, [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args("sample");
            const M<R> light = light_of<M<R>, R>(args, parameters, constants);
            const R* u = args.in<R>("u2", u2, "N 2");
            py::array_t<R> out({args.size("N"), std::int64_t(3)});
            R* w = out.mutable_data();
            for_each_row(args.size("N"), [&](std::int64_t n) {
                put_vec3(w, n, light.sample(Vec2<R>(u[2 * n], u[2 * n + 1])));
            });
            return out;
        });
    }
    static py::array pdf(const py::array& parameters, const py::array& constants,
                         const py::array& w) {
        return dispatch_real("pdf", "parameters", parameters, [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args("pdf");
            const M<R> light = light_of<M<R>, R>(args, parameters, constants);
            const R* in = args.in<R>("w", w, "N 3");
            py::array_t<R> out(args.size("N"));
            R* density = out.mutable_data();
            for_each_row(args.size("N"),
                         [&](std::int64_t n) { density[n] = light.pdf(vec3_at(in, n)); });
            return out;
        });
    }
    static py::object bind(py::module_& m) {
        using T = M<double>;
        py::class_<BoundLight> type(
            m, (std::string("light_") + T::name).c_str(),
            "A light at infinity. parameters (P,), constants (C,); directions "
            "(N, 3) of unit length, towards the light, in the world.");
        type.def_static("L", &L, py::arg("parameters"), py::arg("constants"), py::arg("w"),
                        "Radiance from directions w, (N, 3).")
            .def_static("L_backward", &L_backward, py::arg("parameters"), py::arg("constants"),
                        py::arg("w"), py::arg("d_L"), py::arg("d_parameters"),
                        "Adds dL/dparameters to d_parameters (P,) and returns it.")
            .def_static("jvp", &jvp, py::arg("parameters"), py::arg("constants"), py::arg("v"),
                        py::arg("w"), "Exact derivative of L along v (P,), (N, 3), float64.")
            .def_static("sample", &sample, py::arg("parameters"), py::arg("constants"),
                        py::arg("u2"), "Directions (N, 3) from uniform u2 (N, 2).")
            .def_static("pdf", &pdf, py::arg("parameters"), py::arg("constants"), py::arg("w"),
                        "Density of `sample` over solid angle, (N,).");
        type.def_static(
            "parameters", [] { return parameter_rows(T::params); },
            "(name, scalars, lo, hi, unit) of each differentiated parameter.");
        type.def_static(
            "constants", [] { return parameter_rows(T::constants); },
            "The same of what is not differentiated.");
        return type;
    }
};

}  // namespace

void bind_light(py::module_& m) {
    py::dict registry;
    Lights::for_each(
        [&]<template <class> class M>() { registry[M<double>::name] = BoundLight<M>::bind(m); });
    m.attr("lights") = registry;
    bind_sampled_lights(m);
    bind_mesh_light(m);
    bind_environment(m);
}

}  // namespace photograd
