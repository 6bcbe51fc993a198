// Meshes, instances and the hierarchy that finds what rays hit.

#include <optional>

#include "array_args.h"
#include "module.h"
#include "photograd/geometry/bvh.h"

namespace photograd {
namespace {

using MeshArrays = std::tuple<py::array, py::array, std::optional<py::array>>;

Mesh mesh_of(const MeshArrays& arrays, int index) {
    const auto& [vertices, faces, uv] = arrays;
    ArrayArgs args("Bvh");
    const float* v = args.in<float>("vertices", vertices, "V 3");
    const std::uint32_t* f = args.in<std::uint32_t>("faces", faces, "F 3");
    const float* t = uv ? args.in<float>("uv", *uv, "V 2") : nullptr;
    const auto V = static_cast<std::size_t>(args.size("V")),
               F = static_cast<std::size_t>(args.size("F"));
    const py::gil_scoped_release release;
    return Mesh({v, 3 * V}, {f, 3 * F},
                t ? std::span<const float>(t, 2 * V) : std::span<const float>(), index);
}

std::shared_ptr<Bvh> build(const std::vector<MeshArrays>& meshes, const py::array& mesh_index,
                           const py::array& world_from_object) {
    ArrayArgs args("Bvh");
    const std::int32_t* index = args.in<std::int32_t>("mesh_index", mesh_index, "N");
    const double* rows = args.in<double>("world_from_object", world_from_object, "N 3 4");
    std::vector<Mesh> built;
    built.reserve(meshes.size());
    for (std::size_t i = 0; i < meshes.size(); ++i)
        built.push_back(mesh_of(meshes[i], static_cast<int>(i)));
    std::vector<Instance> instances(static_cast<std::size_t>(args.size("N")));
    for (std::size_t i = 0; i < instances.size(); ++i) {
        instances[i].mesh = index[i];
        std::copy_n(rows + 12 * i, 12, instances[i].world_from_object.m.begin());
    }
    const py::gil_scoped_release release;
    return std::make_shared<Bvh>(std::move(built), std::move(instances));
}

/// The arrays of a batch of rays; t_min and t_max are (R,) or (1,).
template <class R>
struct RayArrays {
    RaySpan<R> rays;
    RayInterval<R> interval;

    RayArrays(ArrayArgs& args, const py::array& origins, const py::array& directions,
              const py::array& t_min, const py::array& t_max) {
        rays = {args.in<R>("origins", origins, "R 3"), args.in<R>("directions", directions, "R 3"),
                args.size("R")};
        interval.t_min = args.in<R>("t_min", t_min, t_min.size() == 1 ? "1" : "R");
        interval.t_max = args.in<R>("t_max", t_max, t_max.size() == 1 ? "1" : "R");
        interval.t_min_step = t_min.size() == 1 ? 0 : 1;
        interval.t_max_step = t_max.size() == 1 ? 0 : 1;
        check(args, "t_min", "numbers of at least 0", t_min, [](R t) { return t >= R(0); });
        check(args, "t_max", "numbers", t_max, [](R t) { return t == t; });
    }

private:
    template <class Good>
    static void check(const ArrayArgs& args, const char* name, const char* expected,
                      const py::array& array, Good&& good) {
        const R* values = static_cast<const R*>(array.data());
        std::int64_t bad = 0;
        for (std::int64_t i = 0; i < array.size(); ++i) bad += !good(values[i]);
        for (std::int64_t i = 0; bad > 0; ++i)
            if (!good(values[i]))
                args.range(name, expected,
                           std::to_string(bad) + " that are not, the first, " +
                               number_text(double(values[i])) + ", in row " + std::to_string(i));
    }
};

void trace(const Bvh& bvh, const py::array& origins, const py::array& directions,
           const py::array& t_min, const py::array& t_max, py::array t, py::array primitive,
           py::array instance, py::array barycentrics) {
    dispatch_real("trace", "origins", origins, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const RayArrays<R> in(args, origins, directions, t_min, t_max);
        const HitSpan<R> hits{args.out<R>("t", t, "R"),
                              args.out<std::int32_t>("primitive", primitive, "R"),
                              args.out<std::int32_t>("instance", instance, "R"),
                              args.out<R>("barycentrics", barycentrics, "R 2")};
        const py::gil_scoped_release release;
        bvh.trace(in.rays, in.interval, hits);
    });
}

py::array_t<bool> occluded(const Bvh& bvh, const py::array& origins, const py::array& directions,
                           const py::array& t_min, const py::array& t_max) {
    return dispatch_real("occluded", "origins", origins,
                         [&](auto real, ArrayArgs& args) -> py::array_t<bool> {
                             using R = decltype(real);
                             const RayArrays<R> in(args, origins, directions, t_min, t_max);
                             py::array_t<bool> blocked(in.rays.count);
                             bool* out = blocked.mutable_data();
                             {
                                 const py::gil_scoped_release release;
                                 bvh.occluded(in.rays, in.interval, out);
                             }
                             return blocked;
                         });
}

py::tuple surface_points(const Bvh& bvh, const py::array& origins, const py::array& directions,
                         const py::array& primitive, const py::array& instance) {
    return dispatch_real(
        "surface_points", "origins", origins, [&](auto real, ArrayArgs& args) -> py::tuple {
            using R = decltype(real);
            const RaySpan<R> rays{args.in<R>("origins", origins, "R 3"),
                                  args.in<R>("directions", directions, "R 3"), args.size("R")};
            const std::int32_t* prim = args.in<std::int32_t>("primitive", primitive, "R");
            const std::int32_t* inst = args.in<std::int32_t>("instance", instance, "R");
            bvh.check_numbers("surface_points", {prim, static_cast<std::size_t>(rays.count)}, inst);
            py::array_t<R> t(rays.count), barycentrics({rays.count, std::int64_t(2)}),
                uv({rays.count, std::int64_t(2)}), position({rays.count, std::int64_t(3)}),
                normal({rays.count, std::int64_t(3)});
            const SurfaceSpan<R> out{t.mutable_data(), barycentrics.mutable_data(),
                                     uv.mutable_data(), position.mutable_data(),
                                     normal.mutable_data()};
            {
                const py::gil_scoped_release release;
                bvh.surface_points(rays, prim, inst, out);
            }
            return py::make_tuple(t, barycentrics, uv, position, normal);
        });
}

}  // namespace

void bind_geometry(py::module_& m) {
    py::class_<Bvh, std::shared_ptr<Bvh>>(m, "Bvh",
                                          "Meshes and their instances, ready to be traced.")
        .def(
            py::init(&build), py::arg("meshes"), py::arg("mesh_index"),
            py::arg("world_from_object"),
            "Meshes as (vertices (V, 3) float32, faces (F, 3) uint32, uv (V, 2) float32 or None);\n"
            "instances as mesh_index (N,) int32 and world_from_object (N, 3, 4) float64.")
        .def("trace", &trace, py::arg("origins"), py::arg("directions"), py::arg("t_min"),
             py::arg("t_max"), py::arg("t"), py::arg("primitive"), py::arg("instance"),
             py::arg("barycentrics"),
             "Fills t (R,), primitive (R,), instance (R,) int32 and barycentrics (R, 2).")
        .def("occluded", &occluded, py::arg("origins"), py::arg("directions"), py::arg("t_min"),
             py::arg("t_max"),
             "Whether anything lies within [t_min, t_max] of each ray: (R,) bool.")
        .def(
            "surface_points", &surface_points, py::arg("origins"), py::arg("directions"),
            py::arg("primitive"), py::arg("instance"),
            "t (R,), barycentrics (R, 2), uv (R, 2), position (R, 3), normal (R, 3) of known hits.")
        .def_property_readonly(
            "bounds",
            [](const Bvh& bvh) {
                py::array_t<float> box({2, 3});
                for (int k = 0; k < 3; ++k) {
                    box.mutable_at(0, k) = bvh.bounds().lo[k];
                    box.mutable_at(1, k) = bvh.bounds().hi[k];
                }
                return box;
            },
            "Lower and upper corner (2, 3) of everything.");
}

}  // namespace photograd
