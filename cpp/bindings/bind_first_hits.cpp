// What rays meet first in a scene for path tracing: the tracer's answer, and the point made from it in double.
#include "array_args.h"
#include "bind_reference.h"
#include "photograd/core/parallel.h"
#include "photograd/render/ray_lanes.h"
#include "photograd/scene/path_scene.h"

namespace photograd {
namespace {

constexpr int width = RayPacket::width;

struct Rows {
    const double *origins, *directions;
    std::int32_t* shape;
    double *t, *position, *normal;

    [[nodiscard]] Ray<double> ray(std::int64_t i) const {
        const double *o = origins + 3 * i, *d = directions + 3 * i;
        return {{o[0], o[1], o[2]}, normalize(Vec3<double>(d[0], d[1], d[2]))};
    }
};

void trace_packet(const PathGeometry& geometry, const Rows& rows, std::int64_t first, int count) {
    RayPacket packet{};
    for (int k = 0; k < count; ++k) {
        const Ray<double> ray = rows.ray(first + k);
        set_lane(packet, k, ray.origin, ray.direction, std::numeric_limits<float>::infinity());
    }
    PacketHits found;
    geometry.bvh.trace(packet, false, found);
    for (int k = 0; k < count; ++k) {
        const std::int64_t i = first + k;
        rows.shape[i] = -1;
        rows.t[i] = std::numeric_limits<double>::infinity();
        if (found.primitive[k] < 0) continue;
        const Ray<double> ray = rows.ray(i);
        const SurfaceHit<double> hit =
            surface_hit(geometry, ray, found.instance[k], found.primitive[k], found.t[k]);
        rows.shape[i] = hit.shape;
        rows.t[i] = dot(hit.position - ray.origin, ray.direction);
        for (int axis = 0; axis < 3; ++axis) {
            rows.position[3 * i + axis] = hit.position[axis];
            rows.normal[3 * i + axis] = hit.outside[axis];
        }
    }
}

py::tuple first_hits(const PathGeometry& geometry, const py::array& origins,
                     const py::array& directions) {
    ArrayArgs args("first_hits");
    const double* o = args.within<double>("origins", origins, "R 3", world_limit);
    const double* d = args.within<double>("directions", directions, "R 3", world_limit);
    const std::int64_t count = args.size("R");
    py::array_t<std::int32_t> shape(count);
    py::array_t<double> t(count), position({count, std::int64_t{3}}),
        normal({count, std::int64_t{3}});
    std::fill_n(position.mutable_data(), 3 * count, 0.0);
    std::fill_n(normal.mutable_data(), 3 * count, 0.0);
    const Rows rows{o,
                    d,
                    shape.mutable_data(),
                    t.mutable_data(),
                    position.mutable_data(),
                    normal.mutable_data()};
    constexpr std::int64_t block = 64 * width;
    {
        const py::gil_scoped_release release;
        parallel_for((count + block - 1) / block, [&](std::int64_t b) {
            const std::int64_t end = std::min(count, (b + 1) * block);
            for (std::int64_t i = b * block; i < end; i += width)
                trace_packet(geometry, rows, i,
                             static_cast<int>(std::min<std::int64_t>(width, end - i)));
        });
    }
    return py::make_tuple(shape, t, position, normal);
}

}  // namespace

void bind_first_hits(py::module_& m) {
    m.def("first_hits", &first_hits, py::arg("geometry"), py::arg("origins"), py::arg("directions"),
          "Number of the shape (R,) int32 or -1, t (R,) in metres, position and normal (R, 3) of "
          "what "
          "rays (R, 3) meet first; the normal is that of the surface, out of it.");
}

}  // namespace photograd
