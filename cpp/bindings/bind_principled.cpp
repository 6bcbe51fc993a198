// Many evaluations of the principled surface at once; photograd.bsdf.principled is the typed face.
#include "module.h"

#include "array_args.h"
#include "kernels/kernels.h"
#include "photograd/core/scatter.h"

namespace photograd {
namespace {

PrincipledArgs read(ArrayArgs& args, const py::array& parameters, const py::array& wo,
                    const py::array& wi, bool cosine) {
    PrincipledArgs a{};
    a.parameters =
        args.in<float>("parameters", parameters, "T " + std::to_string(principled_parameters));
    a.wo = args.in<float>("wo", wo, "N 3");
    a.wi = args.in<float>("wi", wi, "N 3");
    a.count = args.size("N");
    a.rows = args.size("T");
    a.cosine = cosine;
    if (a.rows < 1) args.range("parameters", "at least one row", "none");
    return a;
}

/// visit(begin, end) for pieces of the evaluations, where one row serves all, or of the rows.
template <class Visit>
void for_pieces(const PrincipledArgs& a, Visit&& visit) {
    const std::int64_t all = a.rows == 1 ? a.count : a.rows, piece = a.rows == 1 ? 16384 : 1024;
    parallel_for((all + piece - 1) / piece,
                 [&](std::int64_t k) { visit(k * piece, std::min(all, (k + 1) * piece)); });
}

void values(const py::array& parameters, const py::array& wo, const py::array& wi, bool cosine,
            py::array out) {
    ArrayArgs args("principled_values");
    const PrincipledArgs a = read(args, parameters, wo, wi, cosine);
    float* to = args.out<float>("values", out, "N 3");
    const py::gil_scoped_release release;
    for_pieces(a, [&](std::int64_t begin, std::int64_t end) {
        kernels().principled_values(a, begin, end, to);
    });
}

void values_backward(const py::array& parameters, const py::array& wo, const py::array& wi,
                     bool cosine, const py::array& d_values, py::array d_parameters) {
    ArrayArgs args("principled_values_backward");
    const PrincipledArgs a = read(args, parameters, wo, wi, cosine);
    const float* d = args.in<float>("d_values", d_values, "N 3");
    float* to =
        args.out<float>("d_parameters", d_parameters, "T " + std::to_string(principled_parameters));
    const py::gil_scoped_release release;
    if (a.rows > 1)
        return for_pieces(a, [&](std::int64_t begin, std::int64_t end) {
            kernels().principled_values_backward(a, d, begin, end, to);
        });
    // Sums of blocks in float, of which no lane adds up more than 256 values; the rest in double.
    constexpr std::int64_t block = 4096, blocks = 16;
    sum_partials<float>((a.count + block * blocks - 1) / (block * blocks),
                        std::span<float>(to, principled_parameters),
                        [&](std::int64_t chunk, std::span<double> partial) {
                            for (std::int64_t k = 0; k < blocks; ++k) {
                                const std::int64_t begin = (chunk * blocks + k) * block;
                                float sums[principled_parameters] = {};
                                if (begin >= a.count) return;
                                kernels().principled_values_backward(
                                    a, d, begin, std::min(a.count, begin + block), sums);
                                for (std::size_t j = 0; j < partial.size(); ++j)
                                    partial[j] += static_cast<double>(sums[j]);
                            }
                        });
}

}  // namespace

void bind_principled(py::module_& m) {
    m.def("principled_values", &values, py::arg("parameters"), py::arg("wo"), py::arg("wi"),
          py::arg("cosine"), py::arg("values"),
          "Writes values (N, 3), times the cosine of wi on request. parameters (T, 5): base color, "
          "metalness, roughness; evaluation n takes row n mod T. float32.");
    m.def("principled_values_backward", &values_backward, py::arg("parameters"), py::arg("wo"),
          py::arg("wi"), py::arg("cosine"), py::arg("d_values"), py::arg("d_parameters"),
          "Adds to d_parameters (T, 5) for d_values (N, 3).");
}

}  // namespace photograd
