// One of the sixteen paths that a tracer follows side by side.
#pragma once

#include "photograd/render/path/free_path.h"
#include "photograd/render/path/ray_cone.h"
#include "photograd/render/path/scatter.h"

namespace photograd {

/// Where a path starts: a ray of the camera, or a particle that leaves its emitter.
template <class R>
struct PathStart {
    Ray<R> ray;
    RandomKey key;
    MediumStack stack{};  // of the shapes around the origin
    bool exists = true;
};

/// The material of a hit, whose textures have been looked up: the one that is sampled, and the one
/// that is evaluated. They are the same unless a scene samples by other parameters than its own.
template <Real R>
class HitMaterial {
public:
    void look_up(const PathScene<R>& scene, const SurfaceHit<R>& hit,
                 const Footprint<R>& footprint) {
        scene_ = &scene;
        number_ =
            static_cast<std::size_t>(scene.geometry->material[static_cast<std::size_t>(hit.shape)]);
        const SurfaceTextures& textures = scene.geometry->textures;
        const std::span<const TextureUse> uses = textures.of(number_);
        textured_ = !uses.empty();
        attached_ = scene.sampling_is_attached();
        if (!textured_) return;
        own_sampling_ = textured(scene.sampling[number_], uses, textures, scene.sampling_texels,
                                 hit.uv, footprint);
        if (!attached_)
            own_eval_ =
                textured(scene.materials[number_], uses, textures, scene.texels, hit.uv, footprint);
    }
    [[nodiscard]] std::size_t number() const { return number_; }
    [[nodiscard]] bool is_attached() const { return attached_; }
    [[nodiscard]] bool is_textured() const { return textured_; }
    [[nodiscard]] const Material<R>& sampling() const {
        return textured_ ? own_sampling_ : scene_->sampling[number_];
    }
    [[nodiscard]] const Material<R>& eval() const {
        if (attached_) return sampling();
        return textured_ ? own_eval_ : scene_->materials[number_];
    }

private:
    const PathScene<R>* scene_ = nullptr;
    std::size_t number_ = 0;
    bool textured_ = false, attached_ = true;
    Material<R> own_sampling_, own_eval_;
};

template <Real R>
struct Lane {
    bool alive = false;
    bool at_vertex = false;  // otherwise between two, at a boundary of media
    RandomKey key;
    Ray<R> ray;
    Vec3<R> from{R(0)};      // where the present stretch starts, exactly; the ray starts beside it
    Vec3<R> previous{R(0)};  // the vertex that the ray comes from
    Vec3<R> beta{R(1)};      // throughput, by the scene that is sampled
    R pdf = R(0);            // of the ray's direction; 0 from the camera and from specular surfaces
    RayCone<R> cone;         // from `previous`, where there are mip maps
    SurfaceHit<R> hit;       // at the last vertex
    SurfaceSide<R> side;
    HitMaterial<R> material;
    float time = 0;  // of the shutter
    Path<R> path;

    // In media:
    MediumStack stack;
    typename FreePathSampler<R>::State segment;
    int channel = 0;            // whose coefficients sample the distances of this path
    Vec3<R> channel_pdf{R(1)};  // of the path so far, per channel, over their mean
    int boundaries = 0;         // crossed on this segment
    bool counted = false;       // by the sensor, on this segment

    [[nodiscard]] std::uint32_t vertex() const {
        return static_cast<std::uint32_t>(path.vertices.size()) - 1;
    }
};

}  // namespace photograd
