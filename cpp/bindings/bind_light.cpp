// Every light of light/registry.h, at infinity or placed, behind the one interface of light/sample_light.h: a class of
// static functions on arrays each, and {name: class} as _core.sampled_lights; those at infinity alone as _core.lights.
#include "light_calls.h"
#include "module.h"
#include "photograd/light/registry.h"

namespace photograd {
namespace {

template <template <class> class M>
struct SampledLight {
    template <class R>
    static M<R> checked(ArrayArgs& args, const py::array& parameters, const py::array& constants) {
        const M<R> light = light_of<M<R>, R>(args, parameters, constants);
        check_light<R>(args, light);
        return light;
    }
    static py::tuple sample(const py::array& parameters, const py::array& constants,
                            const py::array& points, const py::array& u2) {
        return dispatch_real("sample", "parameters", parameters, [&](auto real) -> py::tuple {
            using R = decltype(real);
            ArrayArgs args("sample");
            return sample_rows<R>(args, checked<R>(args, parameters, constants), points, u2);
        });
    }
    static py::array radiance(const py::array& parameters, const py::array& constants,
                              const py::array& points, const py::array& w) {
        return dispatch_real("radiance", "parameters", parameters, [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args("radiance");
            return radiance_rows<R>(args, checked<R>(args, parameters, constants), points, w);
        });
    }
    static py::array pdf(const py::array& parameters, const py::array& constants,
                         const py::array& points, const py::array& w) {
        return dispatch_real("pdf", "parameters", parameters, [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args("pdf");
            return pdf_rows<R>(args, checked<R>(args, parameters, constants), points, w);
        });
    }
    template <bool OfSample>
    static py::array backward(const py::array& parameters, const py::array& constants,
                              const py::array& points, const py::array& w,
                              const py::array& d_radiance, py::array d_parameters) {
        const char* name = OfSample ? "sample_backward" : "radiance_backward";
        return dispatch_real(name, "parameters", parameters, [&](auto real) -> py::array {
            using R = decltype(real);
            ArrayArgs args(name);
            const M<R> light = checked<R>(args, parameters, constants);
            add_light_rows<R>(args, light, OfSample, points, w, d_radiance, d_parameters);
            return d_parameters;
        });
    }
    /// Of the radiance of samples: L(point, w), or a delta light's irradiance.
    static py::array jvp(const py::array& parameters, const py::array& constants,
                         const py::array& v, const py::array& points, const py::array& w) {
        using D = Dual<double>;
        ArrayArgs args("jvp");
        const M<double> at = checked<double>(args, parameters, constants);
        const double* tangent =
            args.in<double>("v", v, std::to_string(parameter_count<M<double>>()));
        const double *x = args.in<double>("points", points, "N 3"),
                     *in = args.in<double>("w", w, "N 3");
        M<D> light;
        const auto lift = [&](const auto& from, const auto& to, bool moving) {
            std::vector<double> values;
            for_each_scalar(from, [&](const double& s) { values.push_back(s); }, at);
            std::size_t i = 0;
            for_each_scalar(
                to, [&](D& s) { s = moving ? D(values[i++], *tangent++) : D(values[i++]); }, light);
        };
        lift(M<double>::params, M<D>::params, true);
        lift(M<double>::constants, M<D>::constants, false);
        py::array_t<double> out({args.size("N"), std::int64_t(3)});
        double* value = out.mutable_data();
        for_each_row(args.size("N"), [&](std::int64_t n) {
            const auto vec = [n](const double* p) {
                return Vec3<D>(D(p[3 * n]), D(p[3 * n + 1]), D(p[3 * n + 2]));
            };
            Vec3<D> result;
            if constexpr (requires { light.at(vec(x)); })
                result = light.at(vec(x)).radiance;
            else
                result = light_radiance(light, vec(x), vec(in));
            for (int k = 0; k < 3; ++k) value[3 * n + k] = result[k].tangent;
        });
        return out;
    }
    static py::object bind(py::module_& m) {
        using T = M<double>;
        py::class_<SampledLight> type(
            m, (std::string("sampled_") + T::name).c_str(),
            "A light. parameters (P,), constants (C,); points (N, 3) in the world, directions w "
            "(N, 3) of unit length, from the points.");
        const auto p = py::arg("parameters");
        const auto c = py::arg("constants");
        type.def_static("sample", &sample, p, c, py::arg("points"), py::arg("u2"),
                        "(direction (N, 3), distance (N,), radiance (N, 3), pdf (N,)).")
            .def_static("radiance", &radiance, p, c, py::arg("points"), py::arg("w"),
                        "What arrives at the points from w, (N, 3); 0 of delta lights.")
            .def_static("pdf", &pdf, p, c, py::arg("points"), py::arg("w"),
                        "Density of `sample` over solid angle, (N,); 0 of delta lights.")
            .def_static("radiance_backward", &backward<false>, p, c, py::arg("points"),
                        py::arg("w"), py::arg("d_radiance"), py::arg("d_parameters"),
                        "Adds dL/dparameters to d_parameters (P,) and returns it.")
            .def_static("sample_backward", &backward<true>, p, c, py::arg("points"), py::arg("w"),
                        py::arg("d_radiance"), py::arg("d_parameters"),
                        "The same for the radiance of samples whose directions are w.")
            .def_static("jvp", &jvp, p, c, py::arg("v"), py::arg("points"), py::arg("w"),
                        "Exact derivative of samples' radiance along v (P,), (N, 3), float64.");
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
    py::dict all;
    const auto add = [&]<template <class> class M>() {
        all[M<double>::name] = SampledLight<M>::bind(m);
    };
    Lights::for_each(add);
    m.attr("lights") = all.attr("copy")();
    DeltaLights::for_each(add);
    AreaLights::for_each(add);
    m.attr("sampled_lights") = all;
    bind_environment(m);
}

}  // namespace photograd
