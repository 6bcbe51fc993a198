// Octrees of spherical harmonics; photograd.fields.octree_sh is the typed face.
#include <memory>

#include "march_args.h"
#include "module.h"
#include "photograd/render/march/octree_sh.h"

namespace photograd {
namespace {

using TreeFieldArrays = Arrays<3>;  // row (L,) int32, density (N,), sh (N, K, 3)
using TreeRayArrays = Arrays<3>;    // origins, directions in cells, directions: (R, 3) each

template <class R>
OctreeSh<R> tree_field(ArrayArgs& args, const SpatialTree<3>& tree, const TreeFieldArrays& from,
                       double density_scale) {
    const std::string leaves = std::to_string(tree.leaf_count());
    OctreeSh<R> field{&tree,
                      args.in<std::int32_t>("row", from[0], leaves),
                      args.in<R>("density", from[1], "N"),
                      args.in<R>("sh", from[2], "N K 3"),
                      args.size("N"),
                      args.size("K") == 25 ? sh_max_degree : degree_of(args),
                      static_cast<R>(density_scale)};
    for (std::int32_t leaf = 0; leaf < tree.leaf_count(); ++leaf)
        if (field.row[leaf] < -1 || field.row[leaf] >= field.rows)
            args.range("row", "numbers from -1 to " + std::to_string(field.rows - 1),
                       std::to_string(field.row[leaf]));
    return field;
}

template <class R>
TreeRays<R> tree_rays(ArrayArgs& args, const TreeRayArrays& from, const std::array<double, 3>& cell,
                      double stop) {
    if (!(stop >= 0 && stop < 1)) args.range("stop", "0 to 1", number_text(stop));
    TreeRays<R> rays{};
    rays.origins = args.finite<R>("origins", from[0], "R 3");
    rays.directions = args.finite<R>("directions", from[1], "R 3");
    rays.unit = args.finite<R>("unit", from[2], "R 3");
    rays.count = args.size("R");
    std::copy(cell.begin(), cell.end(), rays.cell);
    return rays;
}

py::tuple march_tree(const SpatialTree<3>& tree, const TreeFieldArrays& parameters,
                     double density_scale, const TreeRayArrays& ray_arrays,
                     const std::array<double, 3>& cell, double stop) {
    return dispatch_real(
        "march_octree_sh", "density", parameters[1], [&](auto real, ArrayArgs& args) -> py::tuple {
            using R = decltype(real);
            const auto field = tree_field<R>(args, tree, parameters, density_scale);
            const auto rays = tree_rays<R>(args, ray_arrays, cell, stop);
            return filled_image<R, MarchOutputs<R>>({rays.count}, [&](const MarchOutputs<R>& out) {
                march_octree_sh(field, rays, static_cast<R>(stop), out);
            });
        });
}

void march_tree_backward(const SpatialTree<3>& tree, const TreeFieldArrays& parameters,
                         double density_scale, const TreeRayArrays& ray_arrays,
                         const std::array<double, 3>& cell, double stop, const Arrays<3>& outputs,
                         const Arrays<3>& d_outputs, Arrays<2> d_parameters,
                         const std::optional<Arrays<2>>& d_rays) {
    dispatch_real(
        "march_octree_sh_backward", "density", parameters[1], [&](auto real, ArrayArgs& args) {
            using R = decltype(real);
            const auto field = tree_field<R>(args, tree, parameters, density_scale);
            const auto rays = tree_rays<R>(args, ray_arrays, cell, stop);
            octree_sh::TreeAdjoint<R> adjoint;
            const auto out =
                MarchCotangentArrays{outputs, d_outputs, d_rays}.read<R>(args, adjoint.image);
            adjoint.d_density = args.out<R>("d_density", d_parameters[0], "N");
            adjoint.d_sh = args.out<R>("d_sh", d_parameters[1], "N K 3");
            const py::gil_scoped_release release;
            march_octree_sh_backward(field, rays, static_cast<R>(stop), out, adjoint);
        });
}

void tree_weights(const SpatialTree<3>& tree, const TreeFieldArrays& parameters,
                  double density_scale, const TreeRayArrays& ray_arrays,
                  const std::array<double, 3>& cell, double stop, py::array max_weight) {
    dispatch_real("octree_sh_weights", "density", parameters[1], [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const auto field = tree_field<R>(args, tree, parameters, density_scale);
        const auto rays = tree_rays<R>(args, ray_arrays, cell, stop);
        R* to = args.out<R>("max_weight", max_weight, "N");
        const py::gil_scoped_release release;
        octree_sh_weights(field, rays, static_cast<R>(stop), to);
    });
}

}  // namespace

void bind_octree_sh(py::module_& m) {
    m.def("march_octree_sh", &march_tree, py::arg("tree"), py::arg("parameters"),
          py::arg("density_scale"), py::arg("rays"), py::arg("cell"), py::arg("stop"),
          "(color, transmittance, depth) of rays through the leaves of an octree. parameters: row "
          "(L,), density (N,), sh (N, K, 3); rays: origins and directions in cells, directions in "
          "the world, (R, 3) each; cell (3,): sides of a cell in meters.");
    m.def("march_octree_sh_backward", &march_tree_backward, py::arg("tree"), py::arg("parameters"),
          py::arg("density_scale"), py::arg("rays"), py::arg("cell"), py::arg("stop"),
          py::arg("outputs"), py::arg("d_outputs"), py::arg("d_parameters"), py::arg("d_rays"),
          "Adds to d_parameters, d_density and d_sh, and to d_rays unless None.");
    m.def("octree_sh_weights", &tree_weights, py::arg("tree"), py::arg("parameters"),
          py::arg("density_scale"), py::arg("rays"), py::arg("cell"), py::arg("stop"),
          py::arg("max_weight"),
          "Raises max_weight (N,) to the largest weight of each row in one of these rays.");
}

}  // namespace photograd
