// Signed distance fields (SDFs): values, derivatives, and where rays hit them. float64 only.
#include "array_args.h"
#include "module.h"
#include "photograd/core/parallel.h"
#include "photograd/geometry/reference/sphere_trace.h"
#include "photograd/geometry/sdf_solid.h"
#include "sdf_args.h"

namespace photograd {
namespace {

static_assert(sizeof(SdfNode) == 4 * sizeof(std::int32_t));
static_assert(sizeof(SdfEnd) == 1);

Sdf build_sdf(const py::array& nodes) {
    ArrayArgs args("Sdf");
    const auto* rows = args.in<std::int32_t>("nodes", nodes, "N 4");
    std::vector<SdfNode> list;
    for (std::int64_t i = 0; i < args.size("N"); ++i, rows += 4)
        list.push_back({static_cast<SdfKind>(rows[0]), rows[1], rows[2], rows[3]});
    return Sdf(std::move(list));
}

py::array_t<double> distance(const Sdf& body, const py::array& numbers, const py::array& points) {
    ArrayArgs args("distance");
    const double* x = checked_numbers(args, body, numbers);
    const double* p = args.in<double>("points", points, "N 3");
    py::array_t<double> out(args.size("N"));
    double* f = out.mutable_data();
    constexpr std::int64_t block = 4096;
    const std::int64_t count = args.size("N");
    {
        const py::gil_scoped_release release;
        parallel_for((count + block - 1) / block, [&](std::int64_t b) {
            for (std::int64_t i = b * block; i < std::min(count, (b + 1) * block); ++i)
                f[i] = body.distance(x, {p[3 * i], p[3 * i + 1], p[3 * i + 2]});
        });
    }
    return out;
}

void distance_backward(const Sdf& body, const py::array& numbers, const py::array& points,
                       const py::array& d_f, py::array d_points, py::array d_numbers) {
    ArrayArgs args("distance_backward");
    const double* x = checked_numbers(args, body, numbers);
    const double* p = args.in<double>("points", points, "N 3");
    const double* d = args.in<double>("d_f", d_f, "N");
    double* d_p = args.out<double>("d_points", d_points, "N 3");
    double* d_x = args.out<double>("d_numbers", d_numbers, std::to_string(body.number_count()));
    const py::gil_scoped_release release;
    for (std::int64_t i = 0; i < args.size("N"); ++i) {
        Vec3<double> d_here(0);
        body.backward(x, {p[3 * i], p[3 * i + 1], p[3 * i + 2]}, d[i], d_here, d_x);
        for (int k = 0; k < 3; ++k) d_p[3 * i + k] += d_here[k];
    }
}

/// (2, 3): lower and upper corner of a box around the body.
py::array_t<double> bounds(const Sdf& body, const py::array& numbers) {
    ArrayArgs args("bounds");
    const SdfSolid solid(body, checked_numbers(args, body, numbers));
    py::array_t<double> out({2, 3});
    for (int k = 0; k < 3; ++k) {
        out.mutable_at(0, k) = double(solid.bounds().lo[k]);
        out.mutable_at(1, k) = double(solid.bounds().hi[k]);
    }
    return out;
}

/// t_min, t_max, tolerance, max_steps.
using MarchArgs = std::tuple<double, double, double, std::int32_t>;
SdfMarch march_of(const ArrayArgs& args, const MarchArgs& m) {
    const auto& [t_min, t_max, tolerance, max_steps] = m;
    constexpr std::int32_t most_steps = 1 << 20;
    if (!(t_min >= 0 && t_min <= t_max))
        args.range("march", "0 <= t_min <= t_max",
                   number_text(t_min) + " and " + number_text(t_max));
    if (!(tolerance > 0)) args.range("march", "a tolerance above 0 m", number_text(tolerance));
    if (max_steps < 1 || max_steps > most_steps)
        args.range("march", "1 to " + std::to_string(most_steps) + " steps",
                   std::to_string(max_steps));
    return {std::get<0>(m), std::get<1>(m), std::get<2>(m), std::get<3>(m)};
}

RaySpan<double> rays_of(ArrayArgs& args, const py::array& origins, const py::array& directions) {
    const double* o = args.finite<double>("origins", origins, "R 3");
    const double* d = args.finite<double>("directions", directions, "R 3");
    return {o, d, args.size("R")};
}

py::tuple sdf_trace(const Sdf& body, const py::array& numbers, const py::array& origins,
                    const py::array& directions, const MarchArgs& march) {
    ArrayArgs args("trace");
    const double* x = checked_numbers(args, body, numbers);
    const RaySpan<double> rays = rays_of(args, origins, directions);
    const SdfMarch limits = march_of(args, march);
    py::array_t<double> t(rays.count);
    py::array_t<std::int32_t> steps(rays.count);
    py::array_t<std::int8_t> end(rays.count);
    const SdfHits hits{t.mutable_data(), steps.mutable_data(),
                       reinterpret_cast<SdfEnd*>(end.mutable_data())};
    {
        const py::gil_scoped_release release;
        trace_sdf(body, x, rays, limits, hits);
    }
    return py::make_tuple(t, steps, end);
}

void trace_backward(const Sdf& body, const py::array& numbers, const py::array& origins,
                    const py::array& directions, const MarchArgs& march, const py::array& t,
                    const py::array& end, const py::array& d_t, py::array d_numbers,
                    py::array d_origins, py::array d_directions) {
    ArrayArgs args("trace_backward");
    const double* x = checked_numbers(args, body, numbers);
    const RaySpan<double> rays = rays_of(args, origins, directions);
    const double* found = args.in<double>("t", t, "R");
    const auto* ends = reinterpret_cast<const SdfEnd*>(args.in<std::int8_t>("end", end, "R"));
    const double* d = args.in<double>("d_t", d_t, "R");
    double* d_x = args.out<double>("d_numbers", d_numbers, std::to_string(body.number_count()));
    double* d_o = args.out<double>("d_origins", d_origins, "R 3");
    double* d_w = args.out<double>("d_directions", d_directions, "R 3");
    const SdfMarch limits = march_of(args, march);
    const py::gil_scoped_release release;
    trace_sdf_backward(body, x, rays, limits, found, ends, d, d_x, d_o, d_w);
}

}  // namespace

void bind_sdf(py::module_& m) {
    py::class_<Sdf>(m, "Sdf", "A body as a tree of signed distances.")
        .def(py::init(&build_sdf), py::arg("nodes"),
             "Nodes (N, 4) int32: kind, two children or -1, where its numbers begin.")
        .def_property_readonly("number_count", &Sdf::number_count)
        .def("bounds", &bounds, py::arg("numbers"),
             "A box (2, 3) around the body; SceneError if it is empty or has no end.")
        .def("distance", &distance, py::arg("numbers"), py::arg("points"),
             "f (N,) of points (N, 3).")
        .def("distance_backward", &distance_backward, py::arg("numbers"), py::arg("points"),
             py::arg("d_f"), py::arg("d_points"), py::arg("d_numbers"),
             "Adds the derivatives to d_points (N, 3) and d_numbers (P,).")
        .def("trace", &sdf_trace, py::arg("numbers"), py::arg("origins"), py::arg("directions"),
             py::arg("march"), "t (R,), steps (R,) int32, end (R,) int8: missed, hit, gave up.")
        .def("trace_backward", &trace_backward, py::arg("numbers"), py::arg("origins"),
             py::arg("directions"), py::arg("march"), py::arg("t"), py::arg("end"), py::arg("d_t"),
             py::arg("d_numbers"), py::arg("d_origins"), py::arg("d_directions"),
             "Adds the derivatives of t to d_numbers (P,), d_origins and d_directions (R, 3).");
}

}  // namespace photograd
