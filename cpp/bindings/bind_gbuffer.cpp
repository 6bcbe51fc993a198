// The G-buffer of a scene, and its lighting; photograd.frame is the typed face.
#include "camera_args.h"
#include "module.h"
#include "path_args.h"
#include "photograd/frame/gbuffer.h"
#include "scene_calls.h"

namespace photograd {
namespace {

/// The least of the numbers [0, count) that are wrong; `count` for none.
template <class Wrong>
std::int64_t first_wrong(std::int64_t count, Wrong&& wrong) {
    constexpr std::int64_t piece = 1 << 14;
    std::vector<std::int64_t> found(static_cast<std::size_t>((count + piece - 1) / piece), count);
    parallel_for(static_cast<std::int64_t>(found.size()), [&](std::int64_t p) {
        const std::int64_t end = std::min(count, (p + 1) * piece);
        std::int64_t i = p * piece;
        while (i < end && !wrong(i)) ++i;
        if (i < end) found[static_cast<std::size_t>(p)] = i;
    });
    return found.empty() ? count : *std::min_element(found.begin(), found.end());
}

/// {name: array} of all of a G-buffer; rows (N, P), P of 0 for none.
using GBufferArrays = std::map<std::string, py::array>;

py::array& gbuffer_array(GBufferArrays& arrays, const char* name) {
    const auto found = arrays.find(name);
    if (found == arrays.end())
        fail(ErrorKind::shape, "gbuffer", name, "an array of this name", "none");
    return found->second;
}

template <class R>
GBuffer<R> gbuffer_of(ArrayArgs& args, GBufferArrays& arrays) {
    const auto vectors = [&](const char* name) {
        return args.out<R>(name, gbuffer_array(arrays, name), "N 3");
    };
    GBuffer<R> out{};
    out.material = args.out<std::int32_t>("material", gbuffer_array(arrays, "material"), "N");
    out.position = vectors("position");
    out.normal = vectors("normal");
    out.shading = vectors("shading");
    out.tangent = vectors("tangent");
    out.emission = vectors("emission");
    out.alpha = args.out<R>("alpha", gbuffer_array(arrays, "alpha"), "N");
    out.rows = args.out<R>("rows", gbuffer_array(arrays, "rows"), "N Q");
    out.row_size = static_cast<int>(args.size("Q"));
    if (out.row_size > max_parameters)
        args.range("rows", "at most " + std::to_string(max_parameters) + " columns",
                   std::to_string(out.row_size));
    return out;
}

/// shape, primitive (F,): of each face, of which `face` (N,) names those that are seen.
void fill(const SceneRows& rows, const py::tuple& camera_numbers, const py::array& face,
          const py::array& shape, const py::array& primitive, GBufferArrays gbuffer) {
    dispatch_real("fill_gbuffer", "parameters", rows.parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const SceneNumbers<R> described(args, rows);
        const Pinhole camera = pinhole(camera_numbers);
        const std::int32_t* numbers = args.in<std::int32_t>("face", face, "N");
        const std::int32_t* s = args.in<std::int32_t>("shape", shape, "F");
        const std::int32_t* p = args.in<std::int32_t>("primitive", primitive, "F");
        if (args.size("N") != std::int64_t{camera.width} * camera.height)
            args.range("face", "one number a pixel", std::to_string(args.size("N")));
        const std::int64_t pixels = args.size("N"), faces = args.size("F");
        const std::int64_t beyond =
            first_wrong(pixels, [&](std::int64_t i) { return numbers[i] >= faces; });
        if (beyond < pixels)
            args.range("face", "numbers below " + std::to_string(faces),
                       std::to_string(numbers[beyond]));
        const Bvh& bvh = rows.geometry.bvh;
        const std::int64_t unknown = first_wrong(faces, [&](std::int64_t i) {
            const bool known = s[i] >= 0 && s[i] < bvh.first_solid();
            const bool sphere = known && s[i] >= static_cast<std::int32_t>(bvh.sphere_instance());
            const std::int64_t end = sphere ? static_cast<std::int64_t>(bvh.spheres().size())
                                     : known
                                         ? static_cast<std::int64_t>(bvh.mesh_of(s[i]).face_count())
                                         : 0;
            return p[i] < 0 || p[i] >= end;
        });
        if (unknown < faces)
            args.range("primitive", "a primitive of shape " + std::to_string(s[unknown]),
                       std::to_string(p[unknown]));
        const GBuffer<R> out = gbuffer_of<R>(args, gbuffer);
        const py::gil_scoped_release release;
        fill_gbuffer(described.scene, camera, {numbers, s, p}, out);
    });
}

/// Refuses numbers of materials that the scene has not.
template <class R>
void check_materials(const ArrayArgs& args, const SceneNumbers<R>& numbers, const GBuffer<R>& in) {
    const auto end = static_cast<std::int32_t>(numbers.materials.size());
    const std::int64_t count = args.size("N");
    const std::int64_t found =
        first_wrong(count, [&](std::int64_t i) { return in.material[i] >= end; });
    if (found < count)
        args.range("material", "numbers below " + std::to_string(end),
                   std::to_string(in.material[found]));
}

void light(const SceneRows& rows, const std::array<double, 3>& eye, GBufferArrays gbuffer,
           const py::array& wi, const py::array& irradiance, py::array out) {
    dispatch_real("light_gbuffer", "parameters", rows.parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const SceneNumbers<R> numbers(args, rows);
        const GBuffer<R> in = gbuffer_of<R>(args, gbuffer);
        const R* direction = args.in<R>("wi", wi, "N 3");
        const R* arriving = args.in<R>("irradiance", irradiance, "N 3");
        R* to = args.out<R>("out", out, "N 3");
        const std::int64_t count = args.size("N");
        check_materials(args, numbers, in);
        const Vec3<R> from{R(eye[0]), R(eye[1]), R(eye[2])};
        const py::gil_scoped_release release;
        light_gbuffer(numbers.scene, from, count, in, direction, arriving, to);
    });
}

void light_parallel(const SceneRows& rows, const std::array<double, 3>& eye, GBufferArrays gbuffer,
                    const py::array& wi, const py::array& irradiance, const py::array& visible,
                    py::array out) {
    dispatch_real("light_gbuffer_parallel", "parameters", rows.parameters,
                  [&](auto real, ArrayArgs& args) {
                      using R = decltype(real);
                      const SceneNumbers<R> numbers(args, rows);
                      const GBuffer<R> in = gbuffer_of<R>(args, gbuffer);
                      const R* direction = args.in<R>("wi", wi, "D 3");
                      const R* arriving = args.in<R>("irradiance", irradiance, "D 3");
                      const R* part = args.in<R>("visible", visible, "N");
                      R* to = args.out<R>("out", out, "N 3");
                      const std::int64_t count = args.size("N"), directions = args.size("D");
                      check_materials(args, numbers, in);
                      const Vec3<R> from{R(eye[0]), R(eye[1]), R(eye[2])};
                      const py::gil_scoped_release release;
                      light_gbuffer_parallel(numbers.scene, from, count, in, directions, direction,
                                             arriving, part, to);
                  });
}

void sample(const SceneRows& rows, const std::array<double, 3>& eye, GBufferArrays gbuffer,
            const py::array& u, py::array wi, py::array weight, py::array pdf) {
    dispatch_real("sample_gbuffer", "parameters", rows.parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const SceneNumbers<R> numbers(args, rows);
        const GBuffer<R> in = gbuffer_of<R>(args, gbuffer);
        const R* uniform = args.in<R>("u", u, "N 3");
        R* direction = args.out<R>("wi", wi, "N 3");
        R* by = args.out<R>("weight", weight, "N 3");
        R* density = args.out<R>("pdf", pdf, "N");
        check_materials(args, numbers, in);
        const std::int64_t count = args.size("N");
        const Vec3<R> from{R(eye[0]), R(eye[1]), R(eye[2])};
        const py::gil_scoped_release release;
        sample_gbuffer(numbers.scene, from, count, in, uniform, direction, by, density);
    });
}

void find_pdf(const SceneRows& rows, const std::array<double, 3>& eye, GBufferArrays gbuffer,
              const py::array& wi, py::array pdf) {
    dispatch_real("gbuffer_pdf", "parameters", rows.parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const SceneNumbers<R> numbers(args, rows);
        const GBuffer<R> in = gbuffer_of<R>(args, gbuffer);
        const R* direction = args.in<R>("wi", wi, "N 3");
        R* density = args.out<R>("pdf", pdf, "N");
        check_materials(args, numbers, in);
        const std::int64_t count = args.size("N");
        const Vec3<R> from{R(eye[0]), R(eye[1]), R(eye[2])};
        const py::gil_scoped_release release;
        gbuffer_pdf(numbers.scene, from, count, in, direction, density);
    });
}

}  // namespace

void bind_gbuffer(py::module_& m) {
    with_scene_names([&](auto... scene) {
        m.def("fill_gbuffer", of_scene(&fill), scene..., py::arg("camera"), py::arg("face"),
              py::arg("shape"), py::arg("primitive"), py::arg("gbuffer"),
              "Writes the arrays of gbuffer; face (N,) is negative where nothing is seen; shape "
              "(F,) of each face counts instances of meshes, then spheres.");
        m.def("light_gbuffer", of_scene(&light), scene..., py::arg("eye"), py::arg("gbuffer"),
              py::arg("wi"), py::arg("irradiance"), py::arg("out"), "Adds to out (N, 3).");
        m.def("light_gbuffer_parallel", of_scene(&light_parallel), scene..., py::arg("eye"),
              py::arg("gbuffer"), py::arg("wi"), py::arg("irradiance"), py::arg("visible"),
              py::arg("out"), "Adds to out (N, 3).");
        m.def("sample_gbuffer", of_scene(&sample), scene..., py::arg("eye"), py::arg("gbuffer"),
              py::arg("u"), py::arg("wi"), py::arg("weight"), py::arg("pdf"),
              "weight (N, 3) is f cos / pdf; pdf (N,) is 0 of specular surfaces.");
        m.def("gbuffer_pdf", of_scene(&find_pdf), scene..., py::arg("eye"), py::arg("gbuffer"),
              py::arg("wi"), py::arg("pdf"));
    });
}

}  // namespace photograd
