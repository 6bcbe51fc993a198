// Brick fields; photograd.grids.bricks is the typed face.
#include "array_args.h"
#include "module.h"
#include "photograd/grid/brick_field.h"

namespace photograd {
namespace {

BrickTopology make(const py::array& origins, const py::array& active, std::int64_t memory_limit) {
    ArrayArgs args("BrickTopology");
    const auto* at = args.in<std::int32_t>("origins", origins, "B 3");
    const auto* flags = args.in<std::uint8_t>("active", active, "B 8 8 8");
    const auto count = static_cast<std::size_t>(args.size("B"));
    return {std::span(at, 3 * count), std::span(flags, 512 * count), memory_limit};
}

template <class R>
struct Call {
    BrickField<R> field;
    PointBatch<R> batch;

    Call(ArrayArgs& args, const BrickTopology& topology, const py::array& values,
         const py::array& background, const py::array& points) {
        const R* from = args.in<R>("values", values, "N C");
        if (args.size("N") != topology.voxels())
            args.range("values", std::to_string(topology.voxels()) + " rows, one a voxel",
                       std::to_string(args.size("N")));
        field = {&topology, from, args.in<R>("background", background, "C"),
                 static_cast<int>(args.size("C"))};
        batch = {args.within<R>("points", points, "P 3", 1 << 30), 0};
        batch.count = args.size("P");
    }
};

void bricks_sample(const BrickTopology& topology, const py::array& values,
                   const py::array& background, const py::array& points, py::array out) {
    dispatch_real("sample_bricks", "values", values, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const Call<R> call(args, topology, values, background, points);
        R* to = args.out<R>("out", out, "P C");
        const py::gil_scoped_release release;
        sample_bricks(call.field, call.batch, to);
    });
}

void backward(const BrickTopology& topology, const py::array& values, const py::array& background,
              const py::array& points, const py::array& d_out, py::array d_values,
              py::array d_background, py::array d_points) {
    dispatch_real("sample_bricks_backward", "values", values, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const Call<R> call(args, topology, values, background, points);
        const R* d = args.in<R>("d_out", d_out, "P C");
        R* to_values = args.out<R>("d_values", d_values, "N C");
        R* to_background = args.out<R>("d_background", d_background, "C");
        R* to_points = args.out<R>("d_points", d_points, "P 3");
        const py::gil_scoped_release release;
        sample_bricks_backward(call.field, call.batch, d, to_values, to_background, to_points);
    });
}

}  // namespace

void bind_bricks(py::module_& m) {
    py::class_<BrickTopology>(m, "BrickTopology", "Where a sparse grid keeps its values.")
        .def(py::init(&make), py::arg("origins"), py::arg("active"), py::arg("memory_limit"))
        .def_property_readonly("bricks", &BrickTopology::bricks)
        .def_property_readonly("voxels", &BrickTopology::voxels)
        .def_property_readonly("memory", &BrickTopology::memory);
    m.def("sample_bricks", &bricks_sample, py::arg("topology"), py::arg("values"),
          py::arg("background"), py::arg("points"), py::arg("out"),
          "Writes the values at index-space points (P, 3).");
    m.def("sample_bricks_backward", &backward, py::arg("topology"), py::arg("values"),
          py::arg("background"), py::arg("points"), py::arg("d_out"), py::arg("d_values"),
          py::arg("d_background"), py::arg("d_points"), "Adds the derivatives to the last three.");
}

}  // namespace photograd
