// Every light of light/registry.h behind the one interface of light/sample_light.h: {name:
// SampledLight} as _core.sampled_lights; those at infinity alone as _core.lights.
#include <variant>

#include "light_calls.h"
#include "module.h"
#include "photograd/light/registry.h"

namespace photograd {
namespace {

template <class R, class Infinite, class Delta, class Area>
struct RegisteredVariant;
template <class R, template <class> class... Infinite, template <class> class... Delta,
          template <class> class... Area>
struct RegisteredVariant<R, ModelList<Infinite...>, ModelList<Delta...>, ModelList<Area...>> {
    using type = std::variant<Infinite<R>..., Delta<R>..., Area<R>...>;
};

/// A light of the registry, whichever.
template <class R>
struct RegisteredLight {
    typename RegisteredVariant<R, Lights, DeltaLights, AreaLights>::type model;
};

template <class R>
LightSample<R> sample_light(const RegisteredLight<R>& any, const Vec3<R>& x, const Vec2<R>& u2) {
    return std::visit([&](const auto& light) { return sample_light(light, x, u2); }, any.model);
}
template <class R>
Vec3<R> light_radiance(const RegisteredLight<R>& any, const Vec3<R>& x, const Vec3<R>& w) {
    return std::visit([&](const auto& light) { return light_radiance(light, x, w); }, any.model);
}
template <class R>
R light_pdf(const RegisteredLight<R>& any, const Vec3<R>& x, const Vec3<R>& w) {
    return std::visit([&](const auto& light) { return light_pdf(light, x, w); }, any.model);
}
template <class R>
void add_light_row(const RegisteredLight<R>& any, bool of_sample, const Vec3<R>& x,
                   const Vec3<R>& w, const Vec3<R>& d_radiance, R* d_row) {
    std::visit([&](const auto& light) { add_light_row(light, of_sample, x, w, d_radiance, d_row); },
               any.model);
}
template <class R>
int light_parameters(const RegisteredLight<R>& any) {
    return std::visit([](const auto& light) { return light_parameters(light); }, any.model);
}

/// A light without numbers, as Python holds it.
struct SampledLight {
    std::string id;
    ParameterRows described, described_constants;
    std::tuple<RegisteredLight<float>, RegisteredLight<double>> of;

    template <class R>
    RegisteredLight<R> checked(ArrayArgs& args, const py::array& p, const py::array& c) const {
        return std::visit(
            [&]<class L>(const L&) -> RegisteredLight<R> {
                const L light = light_of<L, R>(args, p, c);
                check_light<R>(args, light);
                return {light};
            },
            std::get<RegisteredLight<R>>(of).model);
    }
};

/// rows(real, args, light, points, w or u2) as a method.
template <class Rows>
auto light_rows(const char* name, Rows rows) {
    return [=](const SampledLight& bound, const py::array& parameters, const py::array& constants,
               const py::array& points, const py::array& w) {
        return dispatch_real(name, "parameters", parameters, [&](auto real, ArrayArgs& args) {
            const auto light = bound.checked<decltype(real)>(args, parameters, constants);
            return rows(real, args, light, points, w);
        });
    };
}

template <bool of_sample>
py::array light_backward(const SampledLight& bound, const py::array& parameters,
                         const py::array& constants, const py::array& points, const py::array& w,
                         const py::array& d_radiance, py::array d_parameters) {
    const char* name = of_sample ? "sample_backward" : "radiance_backward";
    return dispatch_real(name, "parameters", parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const auto light = bound.checked<R>(args, parameters, constants);
        add_light_rows<R>(args, light, of_sample, points, w, d_radiance, d_parameters);
        return d_parameters;
    });
}

/// A light on dual numbers, of the parameters of `light` and their change `v`.
template <template <class> class M>
M<Dual<double>> dual_light(const M<double>& light, const double* v) {
    using D = Dual<double>;
    M<D> dual;
    double values[max_row];
    std::size_t i = 0;
    for_each_scalar(M<double>::params, [&](const double& x) { values[i++] = x; }, light);
    i = 0;
    for_each_scalar(M<D>::params, [&](D& x) { x = D(values[i++], *v++); }, dual);
    i = 0;
    for_each_scalar(M<double>::constants, [&](const double& x) { values[i++] = x; }, light);
    i = 0;
    for_each_scalar(M<D>::constants, [&](D& x) { x = D(values[i++]); }, dual);
    return dual;
}

/// Of the radiance of samples: L(point, w), or a delta light's irradiance.
py::array light_jvp(const SampledLight& bound, const py::array& parameters,
                    const py::array& constants, const py::array& v, const py::array& points,
                    const py::array& w) {
    using D = Dual<double>;
    ArrayArgs args("jvp");
    const auto any = bound.checked<double>(args, parameters, constants);
    const double* tangent = args.in<double>("v", v, std::to_string(light_parameters(any)));
    const double *x = args.in<double>("points", points, "N 3"),
                 *in = args.in<double>("w", w, "N 3");
    return std::visit(
        [&]<template <class> class M>(const M<double>& at) {
            const M<D> dual = dual_light<M>(at, tangent);
            return vector_rows<double>(args, [&](std::int64_t n) {
                const auto vec = [n](const double* p) {
                    return Vec3<D>(D(p[3 * n]), D(p[3 * n + 1]), D(p[3 * n + 2]));
                };
                Vec3<D> result;
                if constexpr (is_delta(M<D>::kind))
                    result = dual.at(vec(x)).radiance;
                else
                    result = light_radiance(dual, vec(x), vec(in));
                return Vec3<double>(result.x.tangent, result.y.tangent, result.z.tangent);
            });
        },
        any.model);
}

void bind_sampled_light(py::module_& m) {
    const auto p = py::arg("parameters");
    const auto c = py::arg("constants");
    py::class_<SampledLight>(
        m, "SampledLight",
        "A light. parameters (P,), constants (C,); points (N, 3) in the world, directions w "
        "(N, 3) of unit length, from the points.")
        .def("sample", light_rows("sample", call_sample_rows), p, c, py::arg("points"),
             py::arg("u2"), "(direction (N, 3), distance (N,), radiance (N, 3), pdf (N,)).")
        .def("radiance", light_rows("radiance", call_radiance_rows), p, c, py::arg("points"),
             py::arg("w"), "What arrives at the points from w, (N, 3); 0 of delta lights.")
        .def("pdf", light_rows("pdf", call_pdf_rows), p, c, py::arg("points"), py::arg("w"),
             "Density of `sample` over solid angle, (N,); 0 of delta lights.")
        .def("radiance_backward", &light_backward<false>, p, c, py::arg("points"), py::arg("w"),
             py::arg("d_radiance"), py::arg("d_parameters"),
             "Adds dL/dparameters to d_parameters (P,) and returns it.")
        .def("sample_backward", &light_backward<true>, p, c, py::arg("points"), py::arg("w"),
             py::arg("d_radiance"), py::arg("d_parameters"),
             "As radiance_backward, of the radiance of samples whose directions are w.")
        .def("jvp", &light_jvp, p, c, py::arg("v"), py::arg("points"), py::arg("w"),
             "Exact derivative of samples' radiance along v (P,), (N, 3), float64.")
        .def(
            "parameters", [](const SampledLight& light) { return light.described; },
            "(name, scalars, lo, hi, unit) of each differentiated parameter.")
        .def(
            "constants", [](const SampledLight& light) { return light.described_constants; },
            "The same of what is not differentiated.")
        .def("__repr__", [](const SampledLight& light) { return "<" + light.id + ">"; });
}

}  // namespace

void bind_light(py::module_& m) {
    bind_sampled_light(m);
    py::dict all;
    const auto add = [&]<template <class> class M>() {
        all[M<double>::name] = SampledLight{
            M<double>::name,
            parameter_rows(parameter_infos(M<double>::params)),
            parameter_rows(parameter_infos(M<double>::constants)),
            {RegisteredLight<float>{M<float>{}}, RegisteredLight<double>{M<double>{}}}};
    };
    Lights::for_each(add);
    m.attr("lights") = all.attr("copy")();
    DeltaLights::for_each(add);
    AreaLights::for_each(add);
    m.attr("sampled_lights") = all;
    bind_environment(m);
}

}  // namespace photograd
