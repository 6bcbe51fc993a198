// Every phase function of medium/registry.h as a class of static functions on arrays, and {name: class} as
// _core.phases.
#include "model_args.h"
#include "module.h"
#include "photograd/medium/registry.h"

namespace photograd {
namespace {

template <class T, class R>
T phase_of(ArrayArgs& args, const py::array& parameters) {
    const std::string axes = std::to_string(parameter_count<T>());
    return model_at(T{}, args.in<R>("parameters", parameters, axes));
}

template <template <class> class M>
struct BoundPhase {
    static py::array p(const py::array& parameters, const py::array& cos_theta) {
        return dispatch_real("p", "cos_theta", cos_theta, [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args("p");
            const M<R> phase = phase_of<M<R>, R>(args, parameters);
            const R* c = args.in<R>("cos_theta", cos_theta, "N");
            py::array_t<R> out(args.size("N"));
            R* value = out.mutable_data();
            for_each_row(args.size("N"), [&](std::int64_t n) { value[n] = phase.p(c[n]); });
            return out;
        });
    }
    static void p_backward(const py::array& parameters, const py::array& cos_theta,
                           const py::array& d_p, py::array d_parameters, py::array d_cos_theta) {
        dispatch_real("p_backward", "cos_theta", cos_theta, [&](auto real) {
            using R = decltype(real);
            ArrayArgs args("p_backward");
            const M<R> phase = phase_of<M<R>, R>(args, parameters);
            const R *c = args.in<R>("cos_theta", cos_theta, "N"), *d = args.in<R>("d_p", d_p, "N");
            R* d_model =
                args.out<R>("d_parameters", d_parameters, std::to_string(parameter_count<M<R>>()));
            R* d_c = args.out<R>("d_cos_theta", d_cos_theta, "N");
            add_parameter_rows<R, M<R>>(args.size("N"), true, d_model, [&](std::int64_t n) {
                M<R> d_phase = zero_model<M<R>, R>();
                phase.p_backward(c[n], d[n], d_phase, d_c[n]);
                return d_phase;
            });
        });
    }
    static py::array jvp(const py::array& parameters, const py::array& cos_theta,
                         const py::array& v_parameters, const py::array& v_cos_theta) {
        using D = Dual<double>;
        ArrayArgs args("jvp");
        const std::string axes = std::to_string(parameter_count<M<double>>());
        const double* at = args.in<double>("parameters", parameters, axes);
        const double* tangent = args.in<double>("v_parameters", v_parameters, axes);
        const double* c = args.in<double>("cos_theta", cos_theta, "N");
        const double* v = args.in<double>("v_cos_theta", v_cos_theta, "N");
        M<D> phase;
        for_each_scalar([&](D& x) { x = D(*at++, *tangent++); }, phase);
        py::array_t<double> out(args.size("N"));
        double* value = out.mutable_data();
        for_each_row(args.size("N"),
                     [&](std::int64_t n) { value[n] = phase.p(D(c[n], v[n])).tangent; });
        return out;
    }
    static py::object bind(py::module_& m) {
        using T = M<double>;
        py::class_<BoundPhase> type(
            m, (std::string("phase_") + T::name).c_str(),
            "A phase function. parameters (P,); cos_theta (N,) of the angle by which light turns.");
        type.def_static("p", &p, py::arg("parameters"), py::arg("cos_theta"),
                        "Density over solid angle, (N,) in 1/sr.")
            .def_static("p_backward", &p_backward, py::arg("parameters"), py::arg("cos_theta"),
                        py::arg("d_p"), py::arg("d_parameters"), py::arg("d_cos_theta"),
                        "Adds the derivatives to d_parameters (P,) and d_cos_theta (N,).")
            .def_static("jvp", &jvp, py::arg("parameters"), py::arg("cos_theta"),
                        py::arg("v_parameters"), py::arg("v_cos_theta"),
                        "Exact derivative of p along v_parameters (P,) and v_cos_theta (N,).");
        type.def_static(
            "parameters", [] { return parameter_rows(T::params); },
            "(name, scalars, lo, hi, unit) of each parameter.");
        return type;
    }
};

}  // namespace

void bind_phase(py::module_& m) {
    py::dict registry;
    Phases::for_each(
        [&]<template <class> class M>() { registry[M<double>::name] = BoundPhase<M>::bind(m); });
    m.attr("phases") = registry;
}

}  // namespace photograd
