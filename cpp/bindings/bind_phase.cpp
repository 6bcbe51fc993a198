// Every phase function of medium/registry.h on arrays: {name: PhaseFunction} as _core.phases.
#include "model_args.h"
#include "module.h"
#include "photograd/medium/any_phase_tangent.h"

namespace photograd {
namespace {

struct PhaseFunction {
    std::string id;
    ParameterRows described;

    template <class R>
    [[nodiscard]] AnyPhase<R> read(ArrayArgs& args, const char* argument,
                                   const py::array& row) const {
        AnyPhase<R> phase = AnyPhase<R>::named(id);
        const R* next = args.in<R>(argument, row, std::to_string(phase.parameter_count()));
        phase.for_each([&](R& x) { x = *next++; });
        return phase;
    }
};

py::array phase_p(const PhaseFunction& function, const py::array& parameters,
                  const py::array& cos_theta) {
    return dispatch_real("p", "cos_theta", cos_theta, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const auto phase = function.read<R>(args, "parameters", parameters);
        const R* c = args.in<R>("cos_theta", cos_theta, "N");
        return value_rows<R>(args, [&](std::int64_t n) { return phase.p(c[n]); });
    });
}

void phase_p_backward(const PhaseFunction& function, const py::array& parameters,
                      const py::array& cos_theta, const py::array& d_p, py::array d_parameters,
                      py::array d_cos_theta) {
    dispatch_real("p_backward", "cos_theta", cos_theta, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const auto phase = function.read<R>(args, "parameters", parameters);
        const R *c = args.in<R>("cos_theta", cos_theta, "N"), *d = args.in<R>("d_p", d_p, "N");
        const int size = phase.parameter_count();
        R* d_model = args.out<R>("d_parameters", d_parameters, std::to_string(size));
        R* d_c = args.out<R>("d_cos_theta", d_cos_theta, "N");
        AnyPhase<R> zero = phase;
        zero.for_each([](R& x) { x = R(0); });
        add_parameter_rows<R>(size, args.size("N"), true, d_model, [&](std::int64_t n, R* d_row) {
            AnyPhase<R> d_phase = zero;
            phase.p_backward(c[n], d[n], d_phase, d_c[n]);
            d_phase.for_each([&](const R& x) { *d_row++ = x; });
        });
    });
}

py::array phase_jvp(const PhaseFunction& function, const py::array& parameters,
                    const py::array& cos_theta, const py::array& v_parameters,
                    const py::array& v_cos_theta) {
    ArrayArgs args("jvp");
    const auto phase = function.read<double>(args, "parameters", parameters);
    const auto along = function.read<double>(args, "v_parameters", v_parameters);
    const double* c = args.in<double>("cos_theta", cos_theta, "N");
    const double* v = args.in<double>("v_cos_theta", v_cos_theta, "N");
    return value_rows<double>(
        args, [&](std::int64_t n) { return phase_tangent(phase, along, c[n], v[n]); });
}

}  // namespace

void bind_phase(py::module_& m) {
    py::class_<PhaseFunction>(
        m, "PhaseFunction",
        "A phase function. parameters (P,); cos_theta (N,) of the angle by which light turns.")
        .def("p", &phase_p, py::arg("parameters"), py::arg("cos_theta"),
             "Density over solid angle, (N,) in 1/sr.")
        .def("p_backward", &phase_p_backward, py::arg("parameters"), py::arg("cos_theta"),
             py::arg("d_p"), py::arg("d_parameters"), py::arg("d_cos_theta"),
             "Adds the derivatives to d_parameters (P,) and d_cos_theta (N,).")
        .def("jvp", &phase_jvp, py::arg("parameters"), py::arg("cos_theta"),
             py::arg("v_parameters"), py::arg("v_cos_theta"),
             "Exact derivative of p along v_parameters (P,) and v_cos_theta (N,).")
        .def(
            "parameters", [](const PhaseFunction& function) { return function.described; },
            "(name, scalars, lo, hi, unit) of each parameter.")
        .def("__repr__", [](const PhaseFunction& function) { return "<" + function.id + ">"; });
    py::dict registry;
    Phases::for_each([&]<template <class> class M>() {
        registry[M<double>::name] =
            PhaseFunction{M<double>::name, parameter_rows(parameter_infos(M<double>::params))};
    });
    m.attr("phases") = registry;
}

}  // namespace photograd
