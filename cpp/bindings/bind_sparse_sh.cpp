// Sparse grids of density and spherical harmonics; photograd.fields.sparse_sh is the typed face.
#include <pybind11/stl.h>

#include <optional>

#include "march_args.h"
#include "module.h"
#include "photograd/optim/sparse_adam.h"
#include "photograd/optim/total_variation.h"
#include "photograd/render/march/march_sparse_sh.h"

namespace photograd {
namespace {

/// The arrays of a field, as Python hands them over.
struct FieldArrays {
    const CellTable& table;
    const py::array &density, &sh, &background;
    const MarchSettings& settings;
    double color_offset;
};

int degree_of(ArrayArgs& args, std::int64_t coefficients) {
    for (int degree = 0; degree <= 3; ++degree)
        if (sh_count(degree) == coefficients) return degree;
    args.range("sh", "1, 4, 9 or 16 coefficients (degree 0 to 3)", std::to_string(coefficients));
}

template <class R>
SparseSh<R> make_field(ArrayArgs& args, const FieldArrays& from) {
    SparseSh<R> field;
    field.table = &from.table;
    field.density = args.in<R>("density", from.density, "N");
    field.sh = args.in<R>("sh", from.sh, "N K 3");
    field.background = args.in<R>("background", from.background, "B");
    const std::int64_t rows = from.table.topology().voxels();
    if (args.size("N") != rows || rows == 0)
        args.range("density",
                   std::to_string(std::max<std::int64_t>(rows, 1)) + " rows, one a voxel",
                   std::to_string(args.size("N")));
    field.degree = degree_of(args, args.size("K"));
    if (args.size("B") != 1 + field.numbers())
        args.range("background", std::to_string(1 + field.numbers()) + " numbers",
                   std::to_string(args.size("B")));
    field.options = from.settings.field();
    field.color_offset = static_cast<R>(from.color_offset);
    field.place();
    return field;
}

py::tuple march_field(const CellTable& table, const py::array& density, const py::array& sh,
                      const py::array& background, const MarchSettings& settings,
                      double color_offset, const py::array& origins, const py::array& directions,
                      const py::array& t0, const py::array& samples, bool fused, bool skip) {
    return dispatch_real("march_sparse_sh", "density", density, [&](auto real) -> py::tuple {
        using R = decltype(real);
        ArrayArgs args("march_sparse_sh");
        const RayBatch<R> rays = ray_batch<R>(args, origins, directions, t0, samples);
        const SparseSh<R> field =
            make_field<R>(args, {table, density, sh, background, settings, color_offset});
        py::array_t<R> color({rays.count, std::int64_t(3)}), transmittance(rays.count),
            depth(rays.count);
        const RayOutputs<R> out{color.mutable_data(), transmittance.mutable_data(),
                                depth.mutable_data()};
        std::int64_t looked_up = 0;
        for (std::int64_t ray = 0; ray < rays.count; ++ray) looked_up += rays.samples[ray];
        {
            const py::gil_scoped_release release;
            bool done = false;
            if constexpr (std::is_same_v<R, float>)
                if (fused) {
                    looked_up = march_sparse_sh(field, rays, settings.march(), out, skip);
                    done = true;
                }
            if (!done) march(field, rays, settings.march(), out);
        }
        return py::make_tuple(color, transmittance, depth, looked_up);
    });
}

void march_field_backward(const CellTable& table, const py::array& density, const py::array& sh,
                          const py::array& background, const MarchSettings& settings,
                          double color_offset, const py::array& origins,
                          const py::array& directions, const py::array& t0,
                          const py::array& samples, py::array color, py::array transmittance,
                          py::array depth, const py::array& d_color,
                          const py::array& d_transmittance, const py::array& d_depth,
                          py::array d_density, py::array d_sh, py::array d_background,
                          std::optional<py::array> d_origins, std::optional<py::array> d_directions,
                          bool fused) {
    dispatch_real("march_sparse_sh_backward", "density", density, [&](auto real) {
        using R = decltype(real);
        ArrayArgs args("march_sparse_sh_backward");
        const RayBatch<R> rays = ray_batch<R>(args, origins, directions, t0, samples);
        const SparseSh<R> field =
            make_field<R>(args, {table, density, sh, background, settings, color_offset});
        const RayOutputs<R> out{args.out<R>("color", color, "R 3"),
                                args.out<R>("transmittance", transmittance, "R"),
                                args.out<R>("depth", depth, "R")};
        RayAdjoints<R> adjoints{args.in<R>("d_color", d_color, "R 3"),
                                args.in<R>("d_transmittance", d_transmittance, "R"),
                                args.in<R>("d_depth", d_depth, "R")};
        if (d_origins.has_value() != d_directions.has_value())
            args.range("d_origins, d_directions", "both or neither", "one of them");
        if (d_origins) {
            adjoints.d_origins = args.out<R>("d_origins", *d_origins, "R 3");
            adjoints.d_directions = args.out<R>("d_directions", *d_directions, "R 3");
        }
        const SparseShGradients<R> gradients{args.out<R>("d_density", d_density, "N"),
                                             args.out<R>("d_sh", d_sh, "N K 3"),
                                             args.out<R>("d_background", d_background, "B")};
        const py::gil_scoped_release release;
        if constexpr (std::is_same_v<R, float>)
            if (fused && !adjoints.d_origins)
                return march_sparse_sh_backward(field, rays, settings.march(), out, adjoints,
                                                gradients);
        typename SparseSh<R>::Sink sink(field, gradients);
        march_backward(field, rays, settings.march(), out, adjoints, sink);
    });
}

void weights(const CellTable& table, const py::array& density, const py::array& sh,
             const py::array& background, const MarchSettings& settings, const py::array& origins,
             const py::array& directions, const py::array& t0, const py::array& samples,
             py::array most) {
    ArrayArgs args("sparse_sh_weights");
    const RayBatch<float> rays = ray_batch<float>(args, origins, directions, t0, samples);
    const SparseSh<float> field =
        make_field<float>(args, {table, density, sh, background, settings, 0.0});
    float* to = args.out<float>("most", most, "N");
    const py::gil_scoped_release release;
    march_sparse_sh_weights(field, rays, settings.march(), to);
}

template <class Use>
void with_rows(const char* function, const BrickTopology& topology, const py::array& values,
               Use&& use) {
    dispatch_real(function, "values", values, [&](auto real) {
        using R = decltype(real);
        ArrayArgs args(function);
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
    dispatch_real("sparse_adam", "parameter", parameter, [&](auto real) {
        using R = decltype(real);
        ArrayArgs args("sparse_adam");
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
    m.def("march_sparse_sh", &march_field, py::arg("table"), py::arg("density"), py::arg("sh"),
          py::arg("background"), py::arg("settings"), py::arg("color_offset"), py::arg("origins"),
          py::arg("directions"), py::arg("t0"), py::arg("samples"), py::arg("fused") = true,
          py::arg("skip") = true,
          "Colour without background (R, 3), transmittance (R,), depth (R,), samples looked up.");
    m.def("march_sparse_sh_backward", &march_field_backward, py::arg("table"), py::arg("density"),
          py::arg("sh"), py::arg("background"), py::arg("settings"), py::arg("color_offset"),
          py::arg("origins"), py::arg("directions"), py::arg("t0"), py::arg("samples"),
          py::arg("color"), py::arg("transmittance"), py::arg("depth"), py::arg("d_color"),
          py::arg("d_transmittance"), py::arg("d_depth"), py::arg("d_density"), py::arg("d_sh"),
          py::arg("d_background"), py::arg("d_origins") = py::none(),
          py::arg("d_directions") = py::none(), py::arg("fused") = true,
          "Adds to d_density, d_sh, d_background and, where given, d_origins and d_directions.");
    m.def("sparse_sh_weights", &weights, py::arg("table"), py::arg("density"), py::arg("sh"),
          py::arg("background"), py::arg("settings"), py::arg("origins"), py::arg("directions"),
          py::arg("t0"), py::arg("samples"), py::arg("most"),
          "Raises most (N,) to the greatest weight of each voxel over these rays.");
    m.def("total_variation", &variation, py::arg("topology"), py::arg("values"),
          "Squared total variation of values (N, C) over pairs of active neighbours.");
    m.def("total_variation_backward", &variation_backward, py::arg("topology"), py::arg("values"),
          py::arg("d_value"), py::arg("first"), py::arg("last"), py::arg("d_values"),
          "Adds to the rows of d_values that belong to bricks first .. last - 1.");
    m.def("sparse_adam", &adam, py::arg("parameter"), py::arg("gradient"), py::arg("mean"),
          py::arg("mean_square"), py::arg("step"),
          "Adam on the rows with a gradient; step is beta_1, beta_2, length, epsilon.");
}

}  // namespace photograd
