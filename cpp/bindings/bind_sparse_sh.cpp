// Sparse grids of density and spherical harmonics; photograd.fields.sparse_sh is the typed face.
#include <numeric>

#include "march_args.h"
#include "module.h"
#include "photograd/optim/sparse_adam.h"
#include "photograd/optim/total_variation.h"
#include "photograd/render/march/march_sparse_sh.h"

namespace photograd {
namespace {

using FieldArrays = Arrays<3>;  // density (N,), sh (N, K, 3), background (1 + 3 K,)

template <class R>
SparseSh<R> make_field(ArrayArgs& args, const CellTable& table, const FieldArrays& from,
                       const MarchSettings& settings, double color_offset) {
    SparseSh<R> field;
    field.table = &table;
    field.density = args.in<R>("density", from[0], "N");
    field.sh = args.in<R>("sh", from[1], "N K 3");
    field.background = args.in<R>("background", from[2], "B");
    const std::int64_t rows = table.topology().voxels();
    if (args.size("N") != rows || rows == 0)
        args.range("density",
                   std::to_string(std::max<std::int64_t>(rows, 1)) + " rows, one a voxel",
                   std::to_string(args.size("N")));
    field.degree = degree_of(args);
    if (args.size("B") != 1 + field.numbers())
        args.range("background", std::to_string(1 + field.numbers()) + " numbers",
                   std::to_string(args.size("B")));
    field.options = settings.field;
    field.color_offset = static_cast<R>(color_offset);
    field.fit_to_box();
    return field;
}

py::tuple march_field(const CellTable& table, const FieldArrays& parameters,
                      const MarchSettings& settings, double color_offset,
                      const RayArrays& ray_arrays, bool fused, bool skip) {
    return dispatch_real(
        "march_sparse_sh", "density", parameters[0], [&](auto real, ArrayArgs& args) -> py::tuple {
            using R = decltype(real);
            const RayBatch<R> rays = ray_batch<R>(args, ray_arrays);
            const auto field = make_field<R>(args, table, parameters, settings, color_offset);
            auto looked_up =
                std::accumulate(rays.samples, rays.samples + rays.count, std::int64_t{0});
            const auto image =
                filled_image<R, MarchOutputs<R>>({rays.count}, [&](const MarchOutputs<R>& out) {
                    if constexpr (std::is_same_v<R, float>)
                        if (fused) {
                            looked_up = march_sparse_sh(field, rays, settings.march, out, skip);
                            return;
                        }
                    march(field, rays, settings.march, out);
                });
            return py::make_tuple(image[0], image[1], image[2], looked_up);
        });
}

void march_field_backward(const CellTable& table, const FieldArrays& parameters,
                          const MarchSettings& settings, double color_offset,
                          const RayArrays& ray_arrays, const Arrays<3>& outputs,
                          const Arrays<3>& d_outputs, FieldArrays d_parameters,
                          const std::optional<Arrays<2>>& d_rays, bool fused) {
    dispatch_real(
        "march_sparse_sh_backward", "density", parameters[0], [&](auto real, ArrayArgs& args) {
            using R = decltype(real);
            const RayBatch<R> rays = ray_batch<R>(args, ray_arrays);
            const auto field = make_field<R>(args, table, parameters, settings, color_offset);
            MarchAdjoint<R> adjoint;
            const auto out =
                MarchCotangentArrays{outputs, d_outputs, d_rays}.read<R>(args, adjoint);
            const SparseShGradients<R> gradients{args.out<R>("d_density", d_parameters[0], "N"),
                                                 args.out<R>("d_sh", d_parameters[1], "N K 3"),
                                                 args.out<R>("d_background", d_parameters[2], "B")};
            const py::gil_scoped_release release;
            if constexpr (std::is_same_v<R, float>)
                if (fused && !adjoint.d_origins)
                    return march_sparse_sh_backward(field, rays, settings.march, out, adjoint,
                                                    gradients);
            typename SparseSh<R>::Sink sink(field, gradients);
            march_backward(field, rays, settings.march, out, adjoint, sink);
        });
}

void weights(const CellTable& table, const FieldArrays& parameters, const MarchSettings& settings,
             const RayArrays& ray_arrays, py::array max_weight) {
    ArrayArgs args("sparse_sh_weights");
    const RayBatch<float> rays = ray_batch<float>(args, ray_arrays);
    const auto field = make_field<float>(args, table, parameters, settings, 0.0);
    float* to = args.out<float>("max_weight", max_weight, "N");
    const py::gil_scoped_release release;
    march_sparse_sh_weights(field, rays, settings.march, to);
}

template <class Use>
void with_rows(const char* function, const BrickTopology& topology, const py::array& values,
               Use&& use) {
    dispatch_real(function, "values", values, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R* from = args.in<R>("values", values, "N C");
        if (args.size("N") != topology.voxels() || args.size("C") < 1)
            args.range("values", std::to_string(topology.voxels()) + " rows, one a voxel",
                       std::to_string(args.size("N")));
        use(args, from, static_cast<int>(args.size("C")));
    });
}

double variation(const BrickTopology& topology, const py::array& values) {
    double total = 0.0;
    with_rows("total_variation", topology, values, [&](ArrayArgs&, const auto* from, int channels) {
        const py::gil_scoped_release release;
        total = total_variation(topology, from, channels);
    });
    return total;
}

void variation_backward(const BrickTopology& topology, const py::array& values, double d_value,
                        std::int64_t first, std::int64_t last, py::array d_values) {
    with_rows("total_variation_backward", topology, values,
              [&](ArrayArgs& args, const auto* from, int channels) {
                  using R = std::remove_cvref_t<decltype(*from)>;
                  if (first < 0 || last > topology.bricks() || first > last)
                      args.range("first, last", "a range of bricks",
                                 std::to_string(first) + ", " + std::to_string(last));
                  R* to = args.out<R>("d_values", d_values, "N C");
                  const py::gil_scoped_release release;
                  total_variation_backward(topology, from, channels, d_value, first, last, to);
              });
}

void adam(py::array parameter, const py::array& gradient, py::array mean, py::array mean_square,
          const std::array<double, 4>& step) {
    dispatch_real("sparse_adam", "parameter", parameter, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        R* p = args.out<R>("parameter", parameter, "N C");
        const R* g = args.in<R>("gradient", gradient, "N C");
        R* m = args.out<R>("mean", mean, "N C");
        R* v = args.out<R>("mean_square", mean_square, "N C");
        const AdamStep numbers{step[0], step[1], step[2], step[3]};
        const py::gil_scoped_release release;
        sparse_adam(numbers, args.size("N"), args.size("C"), g, p, m, v);
    });
}

}  // namespace

void bind_sparse_sh(py::module_& m) {
    py::class_<CellTable>(m, "CellTable", "The cells of a sparse grid, for marching.")
        .def(py::init<const BrickTopology&, std::array<int, 3>, std::int64_t>(),
             py::arg("topology"), py::arg("shape"), py::arg("memory_limit"))
        .def_property_readonly("tiles", &CellTable::tiles)
        .def_property_readonly("memory", &CellTable::memory);
    m.def("march_sparse_sh", &march_field, py::arg("table"), py::arg("parameters"),
          py::arg("settings"), py::arg("color_offset"), py::arg("rays"), py::arg("fused") = true,
          py::arg("skip") = true,
          "Color without background (R, 3), transmittance (R,), depth (R,), samples looked up. "
          "parameters: density (N,), sh (N, K, 3), background (1 + 3 K,).");
    m.def("march_sparse_sh_backward", &march_field_backward, py::arg("table"),
          py::arg("parameters"), py::arg("settings"), py::arg("color_offset"), py::arg("rays"),
          py::arg("outputs"), py::arg("d_outputs"), py::arg("d_parameters"),
          py::arg("d_rays") = py::none(), py::arg("fused") = true,
          "Adds to d_parameters and, where given, to d_rays: d_origins and d_directions.");
    m.def("sparse_sh_weights", &weights, py::arg("table"), py::arg("parameters"),
          py::arg("settings"), py::arg("rays"), py::arg("max_weight"),
          "Raises max_weight (N,) to the largest weight of each voxel over these rays.");
    m.def("total_variation", &variation, py::arg("topology"), py::arg("values"),
          "Squared total variation of values (N, C) over pairs of active neighbors.");
    m.def("total_variation_backward", &variation_backward, py::arg("topology"), py::arg("values"),
          py::arg("d_value"), py::arg("first"), py::arg("last"), py::arg("d_values"),
          "Adds to the rows of d_values that belong to bricks first .. last - 1.");
    m.def("sparse_adam", &adam, py::arg("parameter"), py::arg("gradient"), py::arg("mean"),
          py::arg("mean_square"), py::arg("step"),
          "Adam on the rows with a gradient; step is beta_1, beta_2, length, epsilon.");
}

}  // namespace photograd
