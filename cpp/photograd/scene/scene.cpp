#include "photograd/scene/scene.h"

#include <string>

#include "photograd/core/errors.h"

namespace photograd {

Scene::Scene(std::shared_ptr<const Bvh> bvh, std::vector<AlbedoLayout> layouts)
    : bvh_(std::move(bvh)), layouts_(std::move(layouts)) {
    if (layouts_.size() != bvh_->meshes().size())
        fail(ErrorKind::scene, "Scene", "albedo", "one for each of " + std::to_string(bvh_->meshes().size()) + " meshes",
             std::to_string(layouts_.size()));
    for (std::size_t i = 0; i < layouts_.size(); ++i) {
        AlbedoLayout& layout = layouts_[i];
        const Mesh& mesh = bvh_->meshes()[i];
        const std::string name = " of mesh " + std::to_string(i);
        layout.first = colors_;
        if (layout.kind == AlbedoKind::texture) {
            if (!mesh.has_uv())
                fail(ErrorKind::scene, "Scene", "uv" + name, "texture coordinates", "none",
                     "a texture needs them");
            if (layout.width < 2 || layout.height < 2)
                fail(ErrorKind::scene, "Scene", "texture" + name, "at least 2 x 2 texels",
                     std::to_string(layout.height) + " x " + std::to_string(layout.width),
                     "use one constant colour");
        }
        switch (layout.kind) {
            case AlbedoKind::constant: colors_ += 1; break;
            case AlbedoKind::vertices: colors_ += mesh.vertex_count(); break;
            case AlbedoKind::faces: colors_ += mesh.face_count(); break;
            case AlbedoKind::texture:
                colors_ += static_cast<std::int64_t>(layout.width) * layout.height;
                break;
        }
    }
}

}  // namespace photograd
