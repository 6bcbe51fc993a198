// The maps of sampling/warp.h on arrays, for lessons and proofs.
#include "model_args.h"
#include "module.h"
#include "photograd/sampling/warp.h"

namespace photograd {
namespace {

/// out (N, Out) = map(in (N, In)), row by row.
template <int In, int Out, class Map>
py::array map_rows(const char* function, const char* argument, const py::array& in, Map&& map) {
    return dispatch_real(function, argument, in, [&](auto real) -> py::array {
        using R = decltype(real);
        ArrayArgs args(function);
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

}  // namespace

void bind_sampling(py::module_& m) {
    m.def(
        "square_to_disk",
        [](const py::array& u2) {
            return map_rows<2, 2>("square_to_disk", "u2", u2,
                                  [](const auto& u) { return square_to_disk(u); });
        },
        py::arg("u2"), "Uniform points (N, 2) of the unit disk from uniform u2 (N, 2).");
    m.def(
        "disk_to_square",
        [](const py::array& p) {
            return map_rows<2, 2>("disk_to_square", "p", p,
                                  [](const auto& q) { return disk_to_square(q); });
        },
        py::arg("p"), "The inverse of square_to_disk.");
    m.def(
        "square_to_cosine_hemisphere",
        [](const py::array& u2) {
            return map_rows<2, 3>("square_to_cosine_hemisphere", "u2", u2,
                                  [](const auto& u) { return square_to_cosine_hemisphere(u); });
        },
        py::arg("u2"), "Directions (N, 3) around +Z, density cos / pi, from uniform u2 (N, 2).");
    m.def(
        "cosine_hemisphere_to_square",
        [](const py::array& w) {
            return map_rows<3, 2>("cosine_hemisphere_to_square", "w", w,
                                  [](const auto& v) { return cosine_hemisphere_to_square(v); });
        },
        py::arg("w"), "The inverse of square_to_cosine_hemisphere.");
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
