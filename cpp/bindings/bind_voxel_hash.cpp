// The hash table from voxels to rows of payload arrays. Python threads may share one.
#include <span>
#include <vector>

#include "array_args.h"
#include "module.h"
#include "photograd/grid/voxel_hash.h"

namespace photograd {
namespace {

static_assert(sizeof(Voxel) == 3 * sizeof(std::int32_t));

/// Runs one of the operations on lists, with voxels (N, 3) and rows (N,) both int32.
template <class Run>
void on_list(const char* function, const py::array& voxels, py::array& rows, Run&& run) {
    ArrayArgs args(function);
    const auto* at = args.in<std::int32_t>("voxels", voxels, "N 3");
    auto* out = args.out<std::int32_t>("rows", rows, "N");
    const auto count = static_cast<std::size_t>(args.size("N"));
    const py::gil_scoped_release release;
    run(std::span(reinterpret_cast<const Voxel*>(at), count), std::span(out, count));
}

py::tuple items(const VoxelHash& table) {
    std::vector<Voxel> voxels;
    std::vector<std::int32_t> rows;
    {
        const py::gil_scoped_release release;
        table.items(voxels, rows);
    }
    const auto count = static_cast<py::ssize_t>(rows.size());
    py::array_t<std::int32_t> voxel_array({count, py::ssize_t{3}}), row_array(count);
    for (std::size_t i = 0; i < voxels.size(); ++i)
        std::copy_n(voxels[i].begin(), 3, voxel_array.mutable_data() + 3 * i);
    std::copy(rows.begin(), rows.end(), row_array.mutable_data());
    return py::make_tuple(voxel_array, row_array);
}

}  // namespace

void bind_voxel_hash(py::module_& m) {
    py::class_<VoxelHash>(m, "VoxelHash", "Which row of a payload array belongs to a voxel.")
        .def(py::init<>())
        .def(
            "insert",
            [](VoxelHash& table, const py::array& voxels, py::array rows) {
                on_list("VoxelHash.insert", voxels, rows,
                        [&](auto in, auto out) { table.insert(in, out); });
            },
            py::arg("voxels"), py::arg("rows"), "Fills rows (N,); new voxels (N, 3) are given one.")
        .def(
            "find",
            [](const VoxelHash& table, const py::array& voxels, py::array rows) {
                on_list("VoxelHash.find", voxels, rows,
                        [&](auto in, auto out) { table.find(in, out); });
            },
            py::arg("voxels"), py::arg("rows"), "Fills rows (N,), -1 where there is none.")
        .def(
            "erase",
            [](VoxelHash& table, const py::array& voxels, py::array rows) {
                on_list("VoxelHash.erase", voxels, rows,
                        [&](auto in, auto out) { table.erase(in, out); });
            },
            py::arg("voxels"), py::arg("rows"), "Fills rows (N,) with those that are free now.")
        .def("items", &items, "Voxels (M, 3) and their rows (M,), by ascending row.")
        .def(
            "statistics",
            [](const VoxelHash& table) {
                const VoxelHashStatistics s = table.statistics();
                return py::make_tuple(s.count, s.row_limit, s.slots, s.bytes, s.longest_probe,
                                      s.mean_probe);
            },
            "count, row_limit, slots, bytes, longest_probe, mean_probe.");
}

}  // namespace photograd
