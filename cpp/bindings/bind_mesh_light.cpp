// A glowing mesh: the triangles and their table of areas, kept between calls.
#include "light_calls.h"
#include "photograd/light/mesh_light.h"

namespace photograd {
namespace {

std::unique_ptr<EmittingMesh> make_mesh(const py::array& vertices, const py::array& faces) {
    ArrayArgs args("EmittingMesh");
    const double* v = args.in<double>("vertices", vertices, "V 3");
    const std::uint32_t* f = args.in<std::uint32_t>("faces", faces, "F 3");
    return std::make_unique<EmittingMesh>(
        std::span(v, static_cast<std::size_t>(3 * args.size("V"))),
        std::span(f, static_cast<std::size_t>(3 * args.size("F"))));
}

template <class R>
MeshLight<R> light_in(ArrayArgs& args, const EmittingMesh& mesh, const py::array& radiance) {
    const R* c = args.in<R>("radiance", radiance, "3");
    const MeshLight<R> light{{c[0], c[1], c[2]}, &mesh};
    check_light<R>(args, light);
    return light;
}

template <bool OfSample>
py::array backward(const EmittingMesh& mesh, const py::array& radiance, const py::array& points,
                   const py::array& w, const py::array& d_radiance, py::array d_parameters) {
    const char* name = OfSample ? "sample_backward" : "radiance_backward";
    return dispatch_real(name, "radiance", radiance, [&](auto real) -> py::array {
        using R = decltype(real);
        ArrayArgs args(name);
        const MeshLight<R> light = light_in<R>(args, mesh, radiance);
        add_light_rows<R>(args, light, OfSample, points, w, d_radiance, d_parameters);
        return d_parameters;
    });
}

}  // namespace

void bind_mesh_light(py::module_& m) {
    py::class_<EmittingMesh>(m, "EmittingMesh", "Triangles that glow on their front sides.")
        .def(py::init(&make_mesh), py::arg("vertices"), py::arg("faces"),
             "Vertices (V, 3) float64 in the world, faces (F, 3) uint32.")
        .def_property_readonly("area", &EmittingMesh::area, "Sum of all faces, m^2.")
        .def(
            "sample",
            [](const EmittingMesh& mesh, const py::array& radiance, const py::array& points,
               const py::array& u2) {
                return dispatch_real("sample", "radiance", radiance, [&](auto real) -> py::tuple {
                    using R = decltype(real);
                    ArrayArgs args("sample");
                    return sample_rows<R>(args, light_in<R>(args, mesh, radiance), points, u2);
                });
            },
            py::arg("radiance"), py::arg("points"), py::arg("u2"),
            "(direction (N, 3), distance (N,), radiance (N, 3), pdf (N,)).")
        .def(
            "radiance",
            [](const EmittingMesh& mesh, const py::array& radiance, const py::array& points,
               const py::array& w) {
                return dispatch_real("radiance", "radiance", radiance, [&](auto real) -> py::array {
                    using R = decltype(real);
                    ArrayArgs args("radiance");
                    return radiance_rows<R>(args, light_in<R>(args, mesh, radiance), points, w);
                });
            },
            py::arg("radiance"), py::arg("points"), py::arg("w"),
            "What arrives at the points from w, (N, 3).")
        .def(
            "pdf",
            [](const EmittingMesh& mesh, const py::array& radiance, const py::array& points,
               const py::array& w) {
                return dispatch_real("pdf", "radiance", radiance, [&](auto real) -> py::array {
                    using R = decltype(real);
                    ArrayArgs args("pdf");
                    return pdf_rows<R>(args, light_in<R>(args, mesh, radiance), points, w);
                });
            },
            py::arg("radiance"), py::arg("points"), py::arg("w"),
            "Density over solid angle with which `sample` draws what w meets first, (N,).")
        .def("radiance_backward", &backward<false>, py::arg("radiance"), py::arg("points"),
             py::arg("w"), py::arg("d_radiance"), py::arg("d_parameters"),
             "Adds dL/dradiance to d_parameters (3,) and returns it.")
        .def("sample_backward", &backward<true>, py::arg("radiance"), py::arg("points"),
             py::arg("w"), py::arg("d_radiance"), py::arg("d_parameters"),
             "The same for the radiance of samples whose directions are w.");
}

}  // namespace photograd
