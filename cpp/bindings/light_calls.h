// Lights as functions on arrays of points and directions, whatever the light: light/sample_light.h,
// row by row.
#pragma once

#include <cmath>

#include "model_args.h"
#include "photograd/light/sample_light.h"

namespace photograd {

void bind_environment(py::module_& m);

/// A light from its flat parameters and constants.
template <class T, class R>
T light_of(ArrayArgs& args, const py::array& parameters, const py::array& constants) {
    T light;
    const R* p = args.in<R>("parameters", parameters, std::to_string(scalars_in(T::params)));
    const R* c = args.in<R>("constants", constants, std::to_string(scalars_in(T::constants)));
    for_each_scalar(T::params, [&](R& x) { x = *p++; }, light);
    for_each_scalar(T::constants, [&](R& x) { x = *c++; }, light);
    return light;
}

/// Refuses colors that are negative, numbers that are not finite, and what the light itself finds
/// wrong.
template <class R, class T>
void check_light(const ArrayArgs& args, const T& light) {
    const auto check = [&](const char* name, const auto& value, bool color) {
        for (int i = 0; i < 3; ++i) {
            R x;
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, R>)
                x = value;
            else
                x = value[i];
            if (!std::isfinite(x) || (color && x < R(0)))
                args.range(name, color ? "finite numbers that are not negative" : "finite numbers",
                           std::to_string(x));
        }
    };
    const auto each = [&](const auto& description, bool parameters) {
        std::apply(
            [&](const auto&... q) {
                (check(q.name, light.*q.member, parameters && value_scalars(q) == 3), ...);
            },
            description);
    };
    each(T::params, true);
    if constexpr (requires { T::constants; }) each(T::constants, false);
    if constexpr (requires { light.fault(); }) {
        const LightFault fault = light.fault();
        if (fault.argument) args.range(fault.argument, fault.expected, "none such");
    }
}

/// (direction (N, 3), distance (N,), radiance (N, 3), pdf (N,)) of one sample for each point.
template <class R, class L>
py::tuple sample_rows(ArrayArgs& args, const L& light, const py::array& points,
                      const py::array& u2) {
    const R* x = args.in<R>("points", points, "N 3");
    const R* u = args.in<R>("u2", u2, "N 2");
    const std::int64_t count = args.size("N");
    py::array_t<R> direction({count, std::int64_t(3)}), radiance({count, std::int64_t(3)});
    py::array_t<R> distance(count), pdf(count);
    R *w = direction.mutable_data(), *color = radiance.mutable_data();
    R *t = distance.mutable_data(), *density = pdf.mutable_data();
    for_each_row(count, [&](std::int64_t n) {
        const LightSample<R> s =
            sample_light(light, vec3_at(x, n), Vec2<R>(u[2 * n], u[2 * n + 1]));
        put_vec3(w, n, s.direction);
        put_vec3(color, n, s.radiance);
        t[n] = s.distance;
        density[n] = s.pdf;
    });
    return py::make_tuple(direction, distance, radiance, pdf);
}

template <class R, class L>
py::array radiance_rows(ArrayArgs& args, const L& light, const py::array& points,
                        const py::array& w) {
    const R *x = args.in<R>("points", points, "N 3"), *in = args.in<R>("w", w, "N 3");
    return vector_rows<R>(
        args, [&](std::int64_t n) { return light_radiance(light, vec3_at(x, n), vec3_at(in, n)); });
}

template <class R, class L>
py::array pdf_rows(ArrayArgs& args, const L& light, const py::array& points, const py::array& w) {
    const R *x = args.in<R>("points", points, "N 3"), *in = args.in<R>("w", w, "N 3");
    return value_rows<R>(
        args, [&](std::int64_t n) { return light_pdf(light, vec3_at(x, n), vec3_at(in, n)); });
}

// The functions above as objects, of a number of their type.
inline constexpr auto call_sample_rows = [](auto real, auto&... given) {
    return sample_rows<decltype(real)>(given...);
};
inline constexpr auto call_radiance_rows = [](auto real, auto&... given) {
    return radiance_rows<decltype(real)>(given...);
};
inline constexpr auto call_pdf_rows = [](auto real, auto&... given) {
    return pdf_rows<decltype(real)>(given...);
};

/// Adds the derivative of one row to d_row, zeros at first; `of_sample`: w is a direction that
/// `sample` gave.
template <class R, class L>
void add_light_row(const L& light, bool of_sample, const Vec3<R>& point, const Vec3<R>& w,
                   const Vec3<R>& d_radiance, R* d_row) {
    L d_light;
    for_each_scalar([](R& x) { x = R(0); }, d_light);
    if (of_sample)
        sample_light_backward(light, point, w, d_radiance, d_light);
    else
        light_radiance_backward(light, point, w, d_radiance, d_light);
    to_row(d_light, d_row);
}
template <class L>
int light_parameters(const L&) {
    return parameter_count<L>();
}

/// Adds dL/dparameters to d_parameters (P,).
template <class R, class L>
void add_light_rows(ArrayArgs& args, const L& light, bool of_sample, const py::array& points,
                    const py::array& w, const py::array& d_radiance, py::array& d_parameters) {
    const R *x = args.in<R>("points", points, "N 3"), *in = args.in<R>("w", w, "N 3");
    const R* d = args.in<R>("d_radiance", d_radiance, "N 3");
    const int size = light_parameters(light);
    R* out = args.out<R>("d_parameters", d_parameters, std::to_string(size));
    add_parameter_rows<R>(size, args.size("N"), true, out, [&](std::int64_t n, R* d_row) {
        add_light_row(light, of_sample, vec3_at(x, n), vec3_at(in, n), vec3_at(d, n), d_row);
    });
}

}  // namespace photograd
