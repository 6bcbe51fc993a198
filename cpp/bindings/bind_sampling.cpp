// The maps of sampling/warp.h on arrays, for lessons and proofs.
#include "model_args.h"
#include "module.h"
#include "photograd/sampling/sobol.h"
#include "photograd/sampling/warp.h"

namespace photograd {
namespace {

/// out (N, Out) = map(in (N, In)), row by row.
template <int In, int Out, class Map>
py::array map_rows(const char* function, const char* argument, const py::array& in, Map&& map) {
    return dispatch_real(function, argument, in, [&](auto real, ArrayArgs& args) -> py::array {
        using R = decltype(real);
        const R* x = args.in<R>(argument, in, "N " + std::to_string(In));
        py::array_t<R> out({args.size("N"), std::int64_t(Out)});
        R* y = out.mutable_data();
        for_each_row(args.size("N"), [&](std::int64_t n) {
            glm::vec<In, R> row;
            for (int k = 0; k < In; ++k) row[k] = x[In * n + k];
            const auto result = map(row);
            for (int k = 0; k < Out; ++k) y[Out * n + k] = result[k];
        });
        return out;
    });
}

template <int In, int Out, class Map>
void bind_map(py::module_& m, const char* name, const char* argument, Map map, const char* about) {
    m.def(
        name, [=](const py::array& in) { return map_rows<In, Out>(name, argument, in, map); },
        py::arg(argument), about);
}

py::array_t<std::uint32_t> sobol_words(std::uint64_t seed, std::uint32_t step, std::uint32_t block,
                                       const py::array& pixel, std::uint32_t first,
                                       std::uint32_t count) {
    ArrayArgs args("sobol_words");
    const std::uint32_t* pixels = args.in<std::uint32_t>("pixel", pixel, "N");
    constexpr std::int64_t most = 1 << 26;
    if (count > most / std::max<std::int64_t>(args.size("N"), 1))
        args.range("count", "at most 2^26 points in all",
                   std::to_string(count) + " of " + std::to_string(args.size("N")) + " pixels");
    py::array_t<std::uint32_t> words({args.size("N"), std::int64_t(count), std::int64_t(4)});
    std::uint32_t* out = words.mutable_data();
    for (std::int64_t i = 0; i < args.size("N"); ++i) {
        const SobolSampler points({seed, step, pixels[i], 0}, block);
        for (std::uint32_t k = 0; k < count; ++k, out += 4) {
            const Philox4 w = points.words(first + k);
            std::copy(w.begin(), w.end(), out);
        }
    }
    return words;
}

}  // namespace

void bind_sampling(py::module_& m) {
    m.def("sobol_words", &sobol_words, py::arg("seed"), py::arg("step"), py::arg("block"),
          py::arg("pixel"), py::arg("first"), py::arg("count"),
          "Words (N, count, 4) uint32 of scrambled Sobol' points first, first + 1, ... of pixels "
          "(N,).");
    bind_map<2, 2>(
        m, "square_to_disk", "u2", [](const auto& u) { return square_to_disk(u); },
        "Uniform points (N, 2) of the unit disk from uniform u2 (N, 2).");
    bind_map<2, 2>(
        m, "disk_to_square", "p", [](const auto& p) { return disk_to_square(p); },
        "The inverse of square_to_disk.");
    bind_map<2, 3>(
        m, "square_to_cosine_hemisphere", "u2",
        [](const auto& u) { return square_to_cosine_hemisphere(u); },
        "Directions (N, 3) around +Z, density cos / pi, from uniform u2 (N, 2).");
    bind_map<3, 2>(
        m, "cosine_hemisphere_to_square", "w",
        [](const auto& w) { return cosine_hemisphere_to_square(w); },
        "The inverse of square_to_cosine_hemisphere.");
    m.def(
        "square_to_cap",
        [](const py::array& u2, double height) {
            return map_rows<2, 3>("square_to_cap", "u2", u2, [=](const auto& u) {
                return square_to_cap(u, static_cast<std::decay_t<decltype(u.x)>>(height));
            });
        },
        py::arg("u2"), py::arg("height"),
        "Uniform directions (N, 3) with z >= 1 - height, from uniform u2 (N, 2).");
    m.def(
        "cap_to_square",
        [](const py::array& w, double height) {
            return map_rows<3, 2>("cap_to_square", "w", w, [=](const auto& v) {
                return cap_to_square(v, static_cast<std::decay_t<decltype(v.x)>>(height));
            });
        },
        py::arg("w"), py::arg("height"), "The inverse of square_to_cap.");
}

}  // namespace photograd
