// Sparse grids and their files; photograd.grids.sparse is the typed face.

#include "array_args.h"
#include "module.h"
#include "photograd/grid/sparse_grid.h"

namespace photograd {
namespace {

template <class T>
py::array_t<T> filled(const std::vector<T>& from, std::vector<py::ssize_t> shape) {
    py::array_t<T> array(std::move(shape));
    std::copy(from.begin(), from.end(), array.mutable_data());
    return array;
}

constexpr std::int64_t farthest_voxel = std::int64_t{1} << 30;

/// Refuses a box of voxels that is empty or reaches beyond +-2^30, so that sums do not overflow.
std::array<int, 3> checked_box(const ArrayArgs& args, const std::array<int, 3>& origin) {
    std::array<int, 3> shape{};
    constexpr const char* axes[] = {"X", "Y", "Z"};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t size = args.size(axes[k]), end = origin[k] + size;
        if (size < 1 || origin[k] < -farthest_voxel || end > farthest_voxel)
            args.range("origin", "a box of voxels that is not empty, within 2^30 of voxel 0",
                       std::to_string(size) + " voxels from " + std::to_string(origin[k]) + " on");
        shape[k] = static_cast<int>(size);
    }
    return shape;
}

/// Voxels (N, 3) within the same bounds.
const std::int32_t* voxels_in(ArrayArgs& args, const py::array& voxels) {
    const auto* at = args.in<std::int32_t>("voxels", voxels, "N 3");
    for (std::int64_t i = 0; i < voxels.size(); ++i)
        if (at[i] < -farthest_voxel || at[i] > farthest_voxel)
            args.range("voxels", "numbers within 2^30 of 0",
                       std::to_string(at[i]) + " in row " + std::to_string(i / 3));
    return at;
}

void check_path(const char* function, const std::string& path) {
    if (path.empty() || path.find('\0') != std::string::npos)
        fail(ErrorKind::io, function, "path", "the name of a file",
             "none, or one with a zero in it");
}

SparseGrid from_dense(const py::array& values, std::array<int, 3> origin,
                      const py::array& background, float tolerance) {
    ArrayArgs args("SparseGrid.from_dense");
    const float* from = args.in<float>("values", values, "X Y Z C");
    const float* empty = args.in<float>("background", background, "C");
    if (args.size("C") != 1 && args.size("C") != 3)
        args.range("values", "1 or 3 channels", std::to_string(args.size("C")));
    const std::array<int, 3> shape = checked_box(args, origin);
    const auto channels = static_cast<int>(args.size("C"));
    const py::gil_scoped_release release;
    return SparseGrid::from_dense(from, shape, channels, origin, empty, tolerance);
}

void to_dense(const SparseGrid& grid, std::array<int, 3> origin, py::array out) {
    ArrayArgs args("SparseGrid.to_dense");
    float* to = args.out<float>("out", out, "X Y Z C");
    if (args.size("C") != grid.channels())
        args.range("out", "the channels of the grid", std::to_string(args.size("C")));
    const std::array<int, 3> shape = checked_box(args, origin);
    const py::gil_scoped_release release;
    grid.to_dense(shape, origin, to);
}

py::tuple values_at(const SparseGrid& grid, const py::array& voxels) {
    ArrayArgs args("SparseGrid.values_at");
    const auto* at = voxels_in(args, voxels);
    py::array_t<float> values({args.size("N"), std::int64_t(grid.channels())});
    py::array_t<std::uint8_t> active(args.size("N"));
    float* to = values.mutable_data();
    std::uint8_t* flags = active.mutable_data();
    {
        const py::gil_scoped_release release;
        grid.values_at(at, args.size("N"), to, flags);
    }
    return py::make_tuple(values, active);
}

void activate(SparseGrid& grid, const py::array& voxels, const py::array& values) {
    ArrayArgs args("SparseGrid.activate");
    const auto* at = voxels_in(args, voxels);
    const float* from = args.in<float>("values", values, "N C");
    if (args.size("C") != grid.channels())
        args.range("values", "the channels of the grid", std::to_string(args.size("C")));
    const py::gil_scoped_release release;
    grid.activate(at, from, args.size("N"));
}

py::array_t<float> sample(const SparseGrid& grid, const py::array& points) {
    ArrayArgs args("SparseGrid.sample");
    const auto* at = args.within<double>("points", points, "N 3", double(farthest_voxel));
    py::array_t<float> values({args.size("N"), std::int64_t(grid.channels())});
    float* to = values.mutable_data();
    {
        const py::gil_scoped_release release;
        grid.sample(at, args.size("N"), to);
    }
    return values;
}

py::tuple leaves(const SparseGrid& grid) {
    const SparseLeaves all = grid.leaves();
    const auto count = static_cast<py::ssize_t>(all.origins.size() / 3);
    return py::make_tuple(filled(all.origins, {count, 3}), filled(all.active, {count, 8, 8, 8}));
}

py::array_t<float> leaf_values(const SparseGrid& grid) {
    const std::vector<float> values = grid.leaf_values();
    const py::ssize_t channels = grid.channels();
    return filled(values, {static_cast<py::ssize_t>(values.size()) / channels, channels});
}

std::int64_t leaf_voxels(const SparseGrid& grid) {
    const SparseLeaves all = grid.leaves();
    return std::count(all.active.begin(), all.active.end(), 1);
}

void set_leaf_values(SparseGrid& grid, const py::array& values) {
    ArrayArgs args("SparseGrid.set_leaf_values");
    const float* from = args.in<float>("values", values, "N C");
    if (args.size("C") != grid.channels() || args.size("N") != leaf_voxels(grid))
        args.range("values", "one row for each active voxel in a leaf", "another number");
    const py::gil_scoped_release release;
    grid.set_leaf_values({from, static_cast<std::size_t>(args.size("N") * args.size("C"))});
}

void keep(SparseGrid& grid, const py::array& stays) {
    ArrayArgs args("SparseGrid.keep");
    const auto* from = args.in<std::uint8_t>("keep", stays, "N");
    if (args.size("N") != leaf_voxels(grid))
        args.range("keep", "one flag for each active voxel in a leaf", "another number");
    const py::gil_scoped_release release;
    grid.keep({from, static_cast<std::size_t>(args.size("N"))});
}

void set_metadata(SparseGrid& grid, const std::string& key, const MetaValue& value) {
    if (key.empty())
        fail(ErrorKind::range, "SparseGrid.set_metadata", "key", "a name", "an empty one");
    grid.set_metadata(key, value);
}

void prune(SparseGrid& grid, float tolerance) {
    if (!(tolerance >= 0))
        fail(ErrorKind::range, "SparseGrid.prune", "tolerance", "a number of at least 0",
             number_text(double(tolerance)));
    grid.prune(tolerance);
}

void dilate(SparseGrid& grid, int steps) {
    constexpr int max_steps = 1000;
    if (steps < 0 || steps > max_steps)
        fail(ErrorKind::range, "SparseGrid.dilate", "steps", "0 to " + std::to_string(max_steps),
             std::to_string(steps));
    grid.dilate(steps);
}

}  // namespace

void bind_sparse(py::module_& m) {
    py::class_<SparseStatistics>(m, "SparseStatistics", "What a sparse grid holds.")
        .def_readonly("active_voxels", &SparseStatistics::active_voxels)
        .def_readonly("active_tiles", &SparseStatistics::active_tiles)
        .def_readonly("leaves", &SparseStatistics::leaves)
        .def_readonly("memory", &SparseStatistics::memory)
        .def_readonly("box", &SparseStatistics::box)
        .def_readonly("min", &SparseStatistics::min)
        .def_readonly("max", &SparseStatistics::max);
    py::class_<SparseGrid>(m, "SparseGrid", "A grid of OpenVDB, float or vec3s.")
        .def_static("from_dense", &from_dense, py::arg("values"), py::arg("origin"),
                    py::arg("background"), py::arg("tolerance"))
        .def("copy", &SparseGrid::copy)
        .def_property_readonly("channels", &SparseGrid::channels)
        .def_property_readonly("background", &SparseGrid::background)
        .def_property("name", &SparseGrid::name, &SparseGrid::rename)
        .def("metadata", &SparseGrid::metadata)
        .def("set_metadata", &set_metadata, py::arg("key"), py::arg("value"))
        .def("world_from_index", &SparseGrid::world_from_index)
        .def("set_world_from_index", &SparseGrid::set_world_from_index, py::arg("matrix"))
        .def("statistics", &SparseGrid::statistics)
        .def("to_dense", &to_dense, py::arg("origin"), py::arg("out"))
        .def("values_at", &values_at, py::arg("voxels"))
        .def("activate", &activate, py::arg("voxels"), py::arg("values"))
        .def("sample", &sample, py::arg("points"))
        .def("prune", &prune, py::arg("tolerance"))
        .def("dilate", &dilate, py::arg("steps"))
        .def("voxelize", &SparseGrid::voxelize)
        .def("leaves", &leaves)
        .def("leaf_values", &leaf_values)
        .def("set_leaf_values", &set_leaf_values, py::arg("values"))
        .def("keep", &keep, py::arg("keep"));
    m.def(
        "read_vdb",
        [](const std::string& path, std::int64_t memory_limit) {
            VdbFile file;
            check_path("read_vdb", path);
            {
                const py::gil_scoped_release release;
                file = VdbFile::read(path, memory_limit);
            }
            return py::make_tuple(file.grids, file.metadata);
        },
        py::arg("path"), py::arg("memory_limit"), "The grids of a file and its metadata.");
    m.def(
        "write_vdb",
        [](const std::string& path, const std::vector<SparseGrid>& grids, const MetaTable& metadata,
           std::optional<bool> half) {
            check_path("write_vdb", path);
            VdbFile{grids, metadata}.write(path, half);
        },
        py::arg("path"), py::arg("grids"), py::arg("metadata"), py::arg("half"));
}

}  // namespace photograd
