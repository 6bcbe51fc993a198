// One path as Python sees it: a dictionary a vertex.
#pragma once

#include "camera_args.h"
#include "photograd/render/volume_path.h"
#include "scene_calls.h"

namespace photograd {

inline py::list colors(const Vec3<double>& v) {
    py::list out;
    for (int c = 0; c < 3; ++c) out.append(v[c]);
    return out;
}

inline py::dict vertex_row(const PathVertex<double>& v) {
    py::dict row;
    row["shape"] = v.shape;
    row["direction"] = colors(v.direction);
    row["emitted"] = colors(v.emitted);
    row["emission_weight"] = v.emission_weight;
    row["pdf"] = v.pdf;
    row["light_pdf"] = v.light_pdf;
    row["light_shape"] = v.light.shape;
    row["light_listed"] = v.light.listed;
    row["light_direction"] = colors(v.light.direction);
    row["light_f"] = colors(v.light.f);
    row["light_emitted"] = colors(v.light.weight > 0 ? v.light.sent : Vec3<double>(0));
    row["light_weight"] = v.light.weight;
    row["light_cosine"] = std::abs(v.light.wi.z);
    row["light_chosen_pdf"] = v.light.pdf;
    row["light_scatter_pdf"] = v.light.scatter_pdf;
    row["wo"] = colors(v.wo);
    row["wi"] = colors(v.wi);
    row["value"] = colors(v.value);
    row["lobe"] = v.lobe;
    row["passed"] = v.passed;
    row["coverage"] = v.coverage;
    row["coverage_slope"] = v.coverage_slope;
    row["light_through"] = v.light.through;
    row["weight"] = v.weight;
    row["survival"] = v.survival;
    return row;
}

/// (medium, kind, length, position, value) of each step of a product.
inline py::list step_rows(const MediaTrail<double>& trail, const StepProduct<double>& product) {
    py::list out;
    for (std::int32_t i = product.first; i < product.last; ++i) {
        const MediumStep<double>& step = trail.steps[static_cast<std::size_t>(i)];
        out.append(py::make_tuple(step.medium, static_cast<int>(step.kind), step.length,
                                  colors(step.position), colors(step.value)));
    }
    return out;
}

/// In double precision.
inline py::list path_rows(const SceneRows& rows, const py::tuple& camera_numbers,
                          const Options& given, std::uint32_t pixel, std::uint32_t sample) {
    ArrayArgs args("trace_path");
    const SceneNumbers<double> numbers(args, rows);
    const ThinLens camera = thin_lens(camera_numbers);
    const PathOptions options = options_of(args, given);
    const std::int64_t pixels = std::int64_t{camera.width} * camera.height;
    if (pixel >= pixels)
        args.range("pixel", "below " + std::to_string(pixels), std::to_string(pixel));
    py::list out;
    if (!rows.geometry.media.any()) {
        for (const auto& v : trace_path(numbers.scene, camera, options, pixel, sample))
            out.append(vertex_row(v));
        return out;
    }
    const auto found = trace_volume_path(numbers.scene, camera, options, pixel, sample);
    for (std::size_t k = 0; k < found.path.size(); ++k) {
        const MediumVertex<double>& m = found.trail.vertices[k];
        py::dict row = vertex_row(found.path[k]);
        row["medium"] = m.medium;
        row["chance"] = colors(m.chance);
        row["segment_weight"] = m.weight;
        row["steps"] = step_rows(found.trail, m.arrival);
        row["shadow_steps"] = step_rows(found.trail, m.shadow);
        out.append(row);
    }
    return out;
}

}  // namespace photograd
