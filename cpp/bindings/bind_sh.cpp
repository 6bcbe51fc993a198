// Spherical harmonics of many directions; photograd.sh is the typed face.
#include "array_args.h"
#include "kernels/kernels.h"
#include "module.h"
#include "photograd/ops/sh_batch.h"

namespace photograd {
namespace {

/// visit(degree, channels) as constants, for K = (degree + 1)^2 coefficients of C channels.
template <class Visit>
void with_sizes(const ArrayArgs& args, Visit&& visit) {
    const auto by_channels = [&](auto degree) {
        switch (args.size("C")) {
            case 1: return visit(degree, std::integral_constant<int, 1>{});
            case 3: return visit(degree, std::integral_constant<int, 3>{});
            default: args.range("coefficients", "1 or 3 channels", std::to_string(args.size("C")));
        }
    };
    switch (args.size("K")) {
        case 1: return by_channels(std::integral_constant<int, 0>{});
        case 4: return by_channels(std::integral_constant<int, 1>{});
        case 9: return by_channels(std::integral_constant<int, 2>{});
        case 16: return by_channels(std::integral_constant<int, 3>{});
        case 25: return by_channels(std::integral_constant<int, 4>{});
        default:
            args.range("coefficients", "1, 4, 9, 16 or 25 of them (degree 0 to 4)",
                       std::to_string(args.size("K")));
    }
}

template <class R>
ShRows<R> rows_of(ArrayArgs& args, const py::array& directions, const py::array& coefficients) {
    ShRows<R> rows{};
    rows.directions = args.in<R>("directions", directions, "N 3");
    rows.coefficients = args.in<R>("coefficients", coefficients, "N K C");
    rows.count = args.size("N");
    return rows;
}

/// Whether the kernel computes this: floats in three channels, of degree 1 at least. It agrees with
/// the scalar form of ops/sh_batch.h bit for bit.
template <class R>
constexpr bool has_kernel(int degree, int channels) {
    return std::is_same_v<R, float> && degree > 0 && channels == 3;
}

void colors(const py::array& directions, const py::array& coefficients, py::array out, bool fused) {
    dispatch_real("sh_colors", "directions", directions, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const ShRows<R> rows = rows_of<R>(args, directions, coefficients);
        R* to = args.out<R>("colors", out, "N C");
        with_sizes(args, [&](auto degree, auto channels) {
            const py::gil_scoped_release release;
            if constexpr (has_kernel<R>(degree.value, channels.value))
                if (fused) {
                    const ShRgbArgs a{degree.value, rows.directions, rows.coefficients};
                    return for_sh_rows(rows.count, [&](std::int64_t first, std::int64_t end) {
                        kernels().sh_rgb(a, first, end, to);
                    });
                }
            sh_colors<degree.value, channels.value>(rows, to);
        });
    });
}

void colors_backward(const py::array& directions, const py::array& coefficients,
                     const py::array& d_colors, py::array d_directions, py::array d_coefficients,
                     bool add, bool fused) {
    dispatch_real("sh_colors_backward", "directions", directions, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const ShRows<R> rows = rows_of<R>(args, directions, coefficients);
        const R* d_out = args.in<R>("d_colors", d_colors, "N C");
        R* to_directions = args.out<R>("d_directions", d_directions, "N 3");
        R* to_coefficients = args.out<R>("d_coefficients", d_coefficients, "N K C");
        with_sizes(args, [&](auto degree, auto channels) {
            const py::gil_scoped_release release;
            if constexpr (has_kernel<R>(degree.value, channels.value))
                if (fused) {
                    const ShRgbArgs a{degree.value, rows.directions, rows.coefficients};
                    const ShRgbBackward b{d_out, to_directions, to_coefficients, add};
                    return for_sh_rows(rows.count, [&](std::int64_t first, std::int64_t end) {
                        kernels().sh_rgb_backward(a, b, first, end);
                    });
                }
            sh_colors_backward<degree.value, channels.value>(rows, d_out, to_directions,
                                                             to_coefficients, add);
        });
    });
}

}  // namespace

void bind_sh(py::module_& m) {
    m.def(
        "sh_colors", &colors, py::arg("directions"), py::arg("coefficients"), py::arg("colors"),
        py::arg("fused") = true,
        "Writes sum_k Y_k(directions) coefficients[:, k] to colors (N, C). fused=False forces the "
        "scalar form, the oracle of the kernel.");
    m.def(
        "sh_colors_backward", &colors_backward, py::arg("directions"), py::arg("coefficients"),
        py::arg("d_colors"), py::arg("d_directions"), py::arg("d_coefficients"),
        py::arg("add") = true, py::arg("fused") = true,
        "Adds the derivatives to d_directions (N, 3) and d_coefficients (N, K, C); with add=False "
        "overwrites what stands there, without reading it.");
}

}  // namespace photograd
