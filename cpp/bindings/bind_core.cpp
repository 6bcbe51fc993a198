// Threads, random numbers, the instruction set in use, and exp for its accuracy test.
#include "array_args.h"
#include "kernels/kernels.h"
#include "module.h"
#include "photograd/core/exp.h"
#include "photograd/core/parallel.h"
#include "photograd/core/random.h"

namespace photograd {
namespace {

py::array_t<std::uint32_t> philox(const py::array& counter, const py::array& key) {
    ArrayArgs args("philox4x32");
    const std::uint32_t* c = args.in<std::uint32_t>("counter", counter, "N 4");
    const std::uint32_t* k = args.in<std::uint32_t>("key", key, "N 2");
    py::array_t<std::uint32_t> words({counter.shape(0), py::ssize_t(4)});
    std::uint32_t* out = words.mutable_data();
    for (std::int64_t i = 0; i < args.size("N"); ++i, c += 4, k += 2, out += 4) {
        const Philox4 w = philox4x32({c[0], c[1], c[2], c[3]}, k[0], k[1]);
        std::copy(w.begin(), w.end(), out);
    }
    return words;
}

py::array_t<double> uniform_numbers(std::uint64_t seed, std::uint32_t step, const py::array& pixel,
                                    std::uint32_t sample, std::uint32_t dimension) {
    ArrayArgs args("uniform");
    const std::uint32_t* pixels = args.in<std::uint32_t>("pixel", pixel, "N");
    py::array_t<double> u(pixel.shape(0));
    double* out = u.mutable_data();
    for (std::int64_t i = 0; i < args.size("N"); ++i)
        out[i] = uniform<double>({seed, step, pixels[i], sample}, dimension);
    return u;
}

template <class Function>
py::array map_real(const char* name, const py::array& x, Function&& function) {
    return dispatch_real(name, "x", x, [&](auto real, ArrayArgs& args) -> py::array {
        using R = decltype(real);
        const R* in = args.in<R>("x", x, "N");
        py::array_t<R> y(x.shape(0));
        R* out = y.mutable_data();
        for (std::int64_t i = 0; i < args.size("N"); ++i) out[i] = function(in[i]);
        return y;
    });
}

}  // namespace

void bind_core(py::module_& m) {
    m.def(
        "set_thread_count",
        [](std::int64_t threads) {
            constexpr std::int64_t most = 1 << 12;
            if (threads < 0 || threads > most)
                fail(ErrorKind::range, "set_thread_count", "threads",
                     "0 to " + std::to_string(most), std::to_string(threads));
            set_thread_count(static_cast<int>(threads));
        },
        py::arg("threads"), "Upper limit on threads; 0 restores the default, all cores.");
    m.def("thread_count", &thread_count);
    m.def(
        "instruction_set", [] { return kernels().name; },
        "Name of the kernels in use: baseline, v3 or v4.");
    m.def("philox4x32", &philox, py::arg("counter"), py::arg("key"),
          "Philox4x32-10 words (N, 4) uint32 of counters (N, 4) under keys (N, 2).");
    m.def(
        "uniform", &uniform_numbers, py::arg("seed"), py::arg("step"), py::arg("pixel"),
        py::arg("sample"), py::arg("dimension"),
        "Uniform numbers (N,) in [0, 1) for pixels (N,), as photograd_course.random defines them.");
    m.def(
        "exp", [](const py::array& x) { return map_real("exp", x, [](auto v) { return exp(v); }); },
        py::arg("x"), "The portable exp on a flat array.");
    m.def(
        "expm1",
        [](const py::array& x) { return map_real("expm1", x, [](auto v) { return expm1(v); }); },
        py::arg("x"), "The portable exp(x) - 1 on a flat array.");
    m.def(
        "log1p_unit",
        [](const py::array& x) {
            return map_real("log1p_unit", x, [](auto v) { return log1p_unit(v); });
        },
        py::arg("x"), "The portable ln(1 + x) for x in [0, 1] on a flat array.");
}

}  // namespace photograd
