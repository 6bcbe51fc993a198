// The reference hierarchy, the binary space partition, and the order by depth that splats use.
#include "module.h"

#include <numeric>

#include "array_args.h"
#include "photograd/core/parallel.h"
#include "photograd/geometry/ray_order.h"
#include "photograd/geometry/reference/bsp.h"
#include "photograd/geometry/reference/bvh_walk.h"
#include "photograd/splat/sort.h"

namespace photograd {
namespace {

constexpr std::int64_t block_size = 1024;  // rays of one task

template <class Body>
void for_each_ray(std::int64_t count, Body&& body) {
    parallel_for((count + block_size - 1) / block_size, [&](std::int64_t block) {
        const std::int64_t end = std::min(count, (block + 1) * block_size);
        for (std::int64_t i = block * block_size; i < end; ++i) body(i);
    });
}

Mesh reference_mesh(const char* function, const py::array& vertices, const py::array& faces) {
    ArrayArgs args(function);
    const float* v = args.in<float>("vertices", vertices, "V 3");
    const std::uint32_t* f = args.in<std::uint32_t>("faces", faces, "F 3");
    const auto V = static_cast<std::size_t>(args.size("V")),
               F = static_cast<std::size_t>(args.size("F"));
    return Mesh({v, 3 * V}, {f, 3 * F}, {}, 0);
}

struct ReferenceBvh {
    Mesh mesh;
    BvhTree tree;
};

struct TracedRays {
    RaySpan<double> rays;
    double *t, *barycentrics;
    std::int32_t *primitive, *boxes, *triangles;

    TracedRays(const char* function, const py::array& origins, const py::array& directions,
               double t_min, double t_max, py::array& t_out, py::array& primitive_out,
               py::array& barycentrics_out, py::array& visits) {
        ArrayArgs args(function);
        const double* o = args.finite<double>("origins", origins, "R 3");
        const double* d = args.finite<double>("directions", directions, "R 3");
        if (!(t_min >= 0 && t_min <= t_max))
            args.range("t_min, t_max", "0 <= t_min <= t_max",
                       number_text(t_min) + " and " + number_text(t_max));
        rays = {o, d, args.size("R")};
        t = args.out<double>("t", t_out, "R");
        primitive = args.out<std::int32_t>("primitive", primitive_out, "R");
        barycentrics = args.out<double>("barycentrics", barycentrics_out, "R 2");
        boxes = args.out<std::int32_t>("visits", visits, "2 R");
        triangles = boxes + rays.count;
    }
    void put(std::int64_t i, const NearestHit& hit, const Visits& cost) const {
        t[i] = hit.t;
        barycentrics[2 * i] = hit.u;
        barycentrics[2 * i + 1] = hit.v;
        primitive[i] = hit.primitive;
        boxes[i] = cost.boxes;
        triangles[i] = cost.triangles;
    }
};

void trace_reference(const ReferenceBvh& bvh, const py::array& origins, const py::array& directions,
                     double t_min, double t_max, bool any, py::array t, py::array primitive,
                     py::array barycentrics, py::array visits) {
    const TracedRays out("trace", origins, directions, t_min, t_max, t, primitive, barycentrics,
                         visits);
    const py::gil_scoped_release release;
    for_each_ray(out.rays.count, [&](std::int64_t i) {
        Visits cost;
        const NearestHit hit =
            walk_bvh(bvh.mesh, bvh.tree, out.rays.ray(i), t_min, t_max, any, cost);
        out.put(i, hit, cost);
    });
}

void trace_all(const ReferenceBvh& bvh, const py::array& origins, const py::array& directions,
               double t_min, double t_max, py::array t, py::array primitive, py::array barycentrics,
               py::array visits) {
    const TracedRays out("trace_all", origins, directions, t_min, t_max, t, primitive, barycentrics,
                         visits);
    const py::gil_scoped_release release;
    const auto every = static_cast<std::int32_t>(bvh.mesh.face_count());
    for_each_ray(out.rays.count, [&](std::int64_t i) {
        out.put(i, try_all_triangles(bvh.mesh, out.rays.ray(i), t_min, t_max), {0, every});
    });
}

/// Boxes (N, 2, 3); first, count, right, depth (N, 4); order (F,).
py::tuple nodes(const ReferenceBvh& bvh) {
    const auto n = static_cast<py::ssize_t>(bvh.tree.nodes.size());
    py::array_t<double> boxes({n, py::ssize_t{2}, py::ssize_t{3}});
    py::array_t<std::int32_t> links({n, py::ssize_t{4}});
    for (py::ssize_t i = 0; i < n; ++i) {
        const BvhNode& node = bvh.tree.nodes[static_cast<std::size_t>(i)];
        for (int k = 0; k < 3; ++k) {
            boxes.mutable_at(i, 0, k) = node.box.lo[k];
            boxes.mutable_at(i, 1, k) = node.box.hi[k];
        }
        const std::int32_t row[4] = {node.first, node.count, node.right, node.depth};
        std::copy_n(row, 4, links.mutable_data(i));
    }
    py::array_t<std::uint32_t> order(static_cast<py::ssize_t>(bvh.tree.order.size()));
    std::copy(bvh.tree.order.begin(), bvh.tree.order.end(), order.mutable_data());
    return py::make_tuple(boxes, links, order);
}

py::array_t<std::uint32_t> back_to_front(const BspTree& tree, const py::array& eyes) {
    ArrayArgs args("back_to_front");
    const double* eye = args.finite<double>("eyes", eyes, "E 3");
    const std::int64_t count = args.size("E"), polygons = tree.polygon_count();
    py::array_t<std::uint32_t> order({count, polygons});
    std::uint32_t* out = order.mutable_data();
    {
        const py::gil_scoped_release release;
        for_each_ray(count, [&](std::int64_t i) {
            tree.back_to_front({eye[3 * i], eye[3 * i + 1], eye[3 * i + 2]}, out + i * polygons);
        });
    }
    return order;
}

/// Points (Q, 3) of all polygons one after another; where each begins (P + 1,); their triangles
/// (P,).
py::tuple polygons(const BspTree& tree) {
    const auto count = static_cast<py::ssize_t>(tree.polygon_count());
    py::array_t<std::int64_t> begin(count + 1);
    py::array_t<std::int32_t> face(count);
    std::int64_t total = 0;
    for (py::ssize_t i = 0; i < count; ++i) {
        const BspPolygon& polygon = tree.polygons()[static_cast<std::size_t>(i)];
        begin.mutable_at(i) = total;
        face.mutable_at(i) = polygon.face;
        total += static_cast<std::int64_t>(polygon.points.size());
    }
    begin.mutable_at(count) = total;
    py::array_t<double> points({total, std::int64_t{3}});
    double* out = points.mutable_data();
    for (const BspPolygon& polygon : tree.polygons())
        for (const Vec3<double>& p : polygon.points)
            for (int k = 0; k < 3; ++k) *out++ = p[k];
    return py::make_tuple(points, begin, face);
}

/// Planes (N, 4) as normal and offset; front, back, first, count, depth (N, 5).
py::tuple bsp_nodes(const BspTree& tree) {
    const auto n = static_cast<py::ssize_t>(tree.nodes().size());
    py::array_t<double> planes({n, py::ssize_t{4}});
    py::array_t<std::int32_t> links({n, py::ssize_t{5}});
    for (py::ssize_t i = 0; i < n; ++i) {
        const BspNode& node = tree.nodes()[static_cast<std::size_t>(i)];
        const Vec3<double>& normal = node.plane.normal;
        const double plane[4] = {normal.x, normal.y, normal.z, node.plane.offset};
        const std::int32_t row[5] = {node.front, node.back, node.first, node.count, node.depth};
        std::copy_n(plane, 4, planes.mutable_data(i));
        std::copy_n(row, 5, links.mutable_data(i));
    }
    return py::make_tuple(planes, links);
}

py::array_t<std::uint32_t> order_by_depth(const py::array& depth, bool far_first) {
    ArrayArgs args("order_by_depth");
    const double* key = args.in<double>("depth", depth, "N");
    const std::int64_t count = args.size("N");
    for (std::int64_t i = 0; i < count; ++i)
        if (!(key[i] >= 0))
            args.range("depth", "numbers of at least 0",
                       number_text(key[i]) + " in row " + std::to_string(i));
    std::vector<std::uint32_t> rows(static_cast<std::size_t>(count));
    std::iota(rows.begin(), rows.end(), 0u);
    // Farthest first is nearest first read backwards; rows go in backwards too, so that equals do
    // not swap.
    if (far_first) std::reverse(rows.begin(), rows.end());
    rows = sort_by_depth(std::move(rows), key);
    if (far_first) std::reverse(rows.begin(), rows.end());
    py::array_t<std::uint32_t> order(count);
    std::copy(rows.begin(), rows.end(), order.mutable_data());
    return order;
}

}  // namespace

void bind_reference(py::module_& m) {
    py::class_<ReferenceBvh>(m, "ReferenceBvh", "A hierarchy of boxes, written to be read.")
        .def(py::init([](const py::array& vertices, const py::array& faces, int leaf_size, int bins,
                         int max_depth) {
                 Mesh mesh = reference_mesh("ReferenceBvh", vertices, faces);
                 BvhTree tree = build_bvh(mesh, {leaf_size, bins, max_depth});
                 return ReferenceBvh{std::move(mesh), std::move(tree)};
             }),
             py::arg("vertices"), py::arg("faces"), py::arg("leaf_size"), py::arg("bins"),
             py::arg("max_depth"))
        .def("trace", &trace_reference, py::arg("origins"), py::arg("directions"), py::arg("t_min"),
             py::arg("t_max"), py::arg("any"), py::arg("t"), py::arg("primitive"),
             py::arg("barycentrics"), py::arg("visits"),
             "Fills t (R,), primitive (R,) int32, barycentrics (R, 2) and visits (2, R) int32.")
        .def("trace_all", &trace_all, py::arg("origins"), py::arg("directions"), py::arg("t_min"),
             py::arg("t_max"), py::arg("t"), py::arg("primitive"), py::arg("barycentrics"),
             py::arg("visits"), "The same, by a test of every triangle.")
        .def("nodes", &nodes,
             "Boxes (N, 2, 3); first, count, right and depth (N, 4); order (F,) of triangles.");
    py::class_<BspTree>(m, "BspTree", "A binary space partition of triangles.")
        .def(py::init([](const py::array& vertices, const py::array& faces, int candidates,
                         int max_polygons) {
                 return BspTree(reference_mesh("BspTree", vertices, faces),
                                {candidates, max_polygons});
             }),
             py::arg("vertices"), py::arg("faces"), py::arg("candidates"), py::arg("max_polygons"))
        .def("back_to_front", &back_to_front, py::arg("eyes"),
             "Numbers (E, P) of all polygons, for each eye (E, 3), hidden ones first.")
        .def("polygons", &polygons, "Points (Q, 3), where each begins (P + 1,), triangles (P,).")
        .def("nodes", &bsp_nodes, "Planes (N, 4); front, back, first, count and depth (N, 5).");
    m.def("order_by_depth", &order_by_depth, py::arg("depth"), py::arg("far_first"),
          "Rows (N,) uint32 by depth (N,) float64, none below 0; equals keep their order.");
}

}  // namespace photograd
