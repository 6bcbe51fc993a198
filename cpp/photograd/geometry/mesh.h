// A triangle mesh: vertices (V, 3), faces (F, 3), optional texture coordinates (V, 2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photograd/core/vec.h"

namespace photograd {

class Mesh {
public:
    /// Copies the arrays. Refuses (SceneError, naming `index`) vertices that are not finite,
    /// corners that name no vertex and triangles without area.
    Mesh(std::span<const float> vertices, std::span<const std::uint32_t> faces,
         std::span<const float> uv, int index);

    [[nodiscard]] std::int64_t vertex_count() const {
        return static_cast<std::int64_t>(vertices_.size() / 3) - 1;
    }
    [[nodiscard]] std::int64_t face_count() const {
        return static_cast<std::int64_t>(faces_.size() / 3);
    }
    [[nodiscard]] bool has_uv() const { return !uv_.empty(); }
    /// The three vertex numbers of a face.
    [[nodiscard]] const std::uint32_t* corners(std::uint32_t face) const {
        return &faces_[3 * static_cast<std::size_t>(face)];
    }
    template <class R>
    [[nodiscard]] Vec3<R> vertex(std::uint32_t i) const {
        const float* p = &vertices_[3 * static_cast<std::size_t>(i)];
        return {R(p[0]), R(p[1]), R(p[2])};
    }
    template <class R>
    [[nodiscard]] Vec2<R> uv(std::uint32_t i) const {
        const float* p = &uv_[2 * static_cast<std::size_t>(i)];
        return {R(p[0]), R(p[1])};
    }
    [[nodiscard]] const float* vertex_data() const { return vertices_.data(); }
    [[nodiscard]] const std::uint32_t* face_data() const { return faces_.data(); }

private:
    // One row of padding: the tracer reads 16 bytes at the last vertex, which has only 12.
    std::vector<float> vertices_;
    std::vector<std::uint32_t> faces_;
    std::vector<float> uv_;
};

}  // namespace photograd
