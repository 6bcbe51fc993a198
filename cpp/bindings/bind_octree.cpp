// Octrees and quadtrees: the tree is an object, the payloads of its leaves are an array (L, C).

#include <cstring>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "array_args.h"
#include "module.h"
#include "photograd/grid/octree_batch.h"
#include "photograd/grid/octree_build.h"

namespace photograd {
namespace {

/// A copy of `rows` as a NumPy array.
template <class T>
py::array_t<T> array_of(const std::vector<T>& rows) {
    return py::array_t<T>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

template <class T, int C>
py::array_t<T> array_of(const std::vector<Payload<T, C>>& rows) {
    py::array_t<T> out({static_cast<py::ssize_t>(rows.size()), static_cast<py::ssize_t>(C)});
    if (!rows.empty()) std::memcpy(out.mutable_data(), rows.data(), sizeof(rows[0]) * rows.size());
    return out;
}

/// Calls visit(std::integral_constant<int, C>) for the number of channels that the caller has.
template <class Visit>
py::tuple with_channels(std::int64_t channels, const char* argument, Visit&& visit) {
    switch (channels) {
        case 1: return visit(std::integral_constant<int, 1>{});
        case 2: return visit(std::integral_constant<int, 2>{});
        case 3: return visit(std::integral_constant<int, 3>{});
        case 4: return visit(std::integral_constant<int, 4>{});
        default:
            fail(ErrorKind::range, "Octree", argument, "1 to 4 channels", std::to_string(channels));
    }
}

template <class T, int C, int D>
py::tuple build_dense(ArrayArgs& args, const py::array& values, const py::array& background,
                      double tolerance) {
    const char* const axes = D == 3 ? "X Y Z C" : "X Y C";
    const T* data = args.in<T>("values", values, axes);
    const T* behind = args.in<T>("background", background, "C");
    constexpr std::int64_t max_cells = std::int64_t{1} << SpatialTree<D>::max_depth;
    Cell<D> shape{};
    for (int a = 0; a < D; ++a) {
        if (values.shape(a) > max_cells)
            args.range("values", "at most 2^20 cells along each axis",
                       std::to_string(values.shape(a)));
        shape[a] = static_cast<std::int32_t>(values.shape(a));
    }
    using P = Payload<T, C>;
    P beyond;
    std::copy_n(behind, C, beyond.begin());
    PayloadTree<P, D> built = [&] {
        const py::gil_scoped_release release;
        return tree_from_dense<P, D>(reinterpret_cast<const P*>(data), shape, beyond, tolerance);
    }();
    return py::make_tuple(std::make_shared<SpatialTree<D>>(std::move(built.tree)),
                          array_of<T, C>(built.leaves));
}

template <int D>
py::tuple octree_from_dense(const py::array& values, const py::array& background,
                            double tolerance) {
    ArrayArgs args("Octree.from_dense");
    if (values.ndim() != D + 1)
        fail(ErrorKind::shape, "Octree.from_dense", "values",
             std::to_string(D + 1) + " axes, the last of them channels",
             std::to_string(values.ndim()) + " axes");
    return with_channels(values.shape(D), "values", [&](auto channels) -> py::tuple {
        constexpr int C = channels;
        if constexpr (C == 1)
            if (values.dtype().is(py::dtype::of<std::uint8_t>()))
                return build_dense<std::uint8_t, 1, D>(args, values, background, tolerance);
        return dispatch_real(
            "Octree.from_dense", "values", values, [&](auto real, ArrayArgs&) -> py::tuple {
                return build_dense<decltype(real), C, D>(args, values, background, tolerance);
            });
    });
}

template <int D>
py::tuple from_function(int depth, const py::function& classify, int channels) {
    return with_channels(channels, "channels", [&](auto count) -> py::tuple {
        constexpr int C = count;
        using P = Payload<double, C>;
        const auto ask = [&](const Cell<D>& lower, std::int32_t side) -> std::optional<P> {
            const py::object answer = classify(py::tuple(py::cast(lower)), side);
            if (answer.is_none()) return std::nullopt;
            const auto given = entry_as<std::vector<double>>("Octree.from_function", "classify",
                                                             "None or a list of numbers", answer);
            if (given.size() != C)
                fail(ErrorKind::shape, "Octree.from_function", "classify",
                     "None or " + std::to_string(C) + " channels",
                     std::to_string(given.size()) + " channels");
            P value{};
            std::copy(given.begin(), given.end(), value.begin());
            return value;
        };
        PayloadTree<P, D> built = tree_from_function<P, D>(depth, ask);
        return py::make_tuple(std::make_shared<SpatialTree<D>>(std::move(built.tree)),
                              array_of<double, C>(built.leaves));
    });
}

template <int D>
void locate(const SpatialTree<D>& tree, const py::array& points, py::array leaf) {
    dispatch_real("Octree.locate", "points", points, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R* at = args.in<R>("points", points, D == 3 ? "N 3" : "N 2");
        auto* out = args.out<std::int32_t>("leaf", leaf, "N");
        const py::gil_scoped_release release;
        locate_batch<R, D>(tree, at, args.size("N"), out);
    });
}

template <int D>
py::tuple traverse(const SpatialTree<D>& tree, const py::array& origins,
                   const py::array& directions, const py::array& t_min, const py::array& t_max) {
    return dispatch_real(
        "Octree.traverse", "origins", origins, [&](auto real, ArrayArgs& args) -> py::tuple {
            using R = decltype(real);
            const char* const axes = D == 3 ? "R 3" : "R 2";
            const R *o = args.finite<R>("origins", origins, axes),
                    *d = args.finite<R>("directions", directions, axes),
                    *from = args.in<R>("t_min", t_min, "R"), *to = args.in<R>("t_max", t_max, "R");
            const LeafVisits<R> visits = [&] {
                const py::gil_scoped_release release;
                return traverse_batch<R, D>(tree, o, d, from, to, args.size("R"));
            }();
            return py::make_tuple(array_of(visits.ray_offset), array_of(visits.leaf),
                                  array_of(visits.t0), array_of(visits.t1));
        });
}

template <int D>
py::tuple leaf_boxes(const SpatialTree<D>& tree) {
    const py::ssize_t count = tree.leaf_count();
    py::array_t<std::int32_t> lower({count, static_cast<py::ssize_t>(D)}), side(count);
    std::int32_t *corners = lower.mutable_data(), *sides = side.mutable_data();
    tree.for_each_leaf([&](std::int32_t leaf, const LeafBox<D>& box) {
        std::copy_n(box.lower.begin(), D, corners + static_cast<std::int64_t>(leaf) * D);
        sides[leaf] = box.side;
    });
    return py::make_tuple(lower, side);
}

template <int D>
void bind_tree(py::module_& m, const char* name, const char* help) {
    using Tree = SpatialTree<D>;
    py::class_<Tree, std::shared_ptr<Tree>>(m, name, help)
        .def_static("from_dense", &octree_from_dense<D>, py::arg("values"), py::arg("background"),
                    py::arg("tolerance"), "The tree of an array, and its payloads (L, C).")
        .def_static("from_function", &from_function<D>, py::arg("depth"), py::arg("classify"),
                    py::arg("channels"),
                    "The tree of classify(lower, side) -> None or channels; payloads (L, C).")
        .def("locate", &locate<D>, py::arg("points"), py::arg("leaf"),
             "Fills leaf (N,) int32 for points (N, D) in cells; -1 is outside of the root.")
        .def("traverse", &traverse<D>, py::arg("origins"), py::arg("directions"), py::arg("t_min"),
             py::arg("t_max"),
             "Visits of rays (R, D) in cells: ray_offset (R + 1,), leaf (M,), t0 (M,), t1 (M,).")
        .def("leaf_boxes", &leaf_boxes<D>, "Lower corners (L, D) and sides (L,) in cells.")
        .def(
            "statistics",
            [](const Tree& tree) {
                const TreeStatistics s = tree.statistics();
                return py::make_tuple(s.nodes, s.leaves, s.bytes, s.leaves_per_level);
            },
            "nodes, leaves, bytes, and a list of leaves by level, that of the root first.")
        .def_property_readonly("depth", &Tree::depth, "Levels below the root.");
}

}  // namespace

void bind_octree(py::module_& m) {
    bind_tree<3>(m, "Octree", "Which cube of space is a leaf.");
    bind_tree<2>(m, "Quadtree", "Which square of a plane is a leaf.");
}

}  // namespace photograd
