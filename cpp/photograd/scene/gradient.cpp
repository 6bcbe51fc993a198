#include "photograd/scene/gradient.h"

namespace photograd {

template <Real R>
std::vector<GradientBlock<R>> gradient_blocks(const PathScene<R>& scene) {
    std::vector<GradientBlock<R>> blocks;
    const auto add = [&](const std::string& name, BlockKind kind, std::size_t number,
                         std::initializer_list<std::int64_t> shape) {
        blocks.push_back({name, kind, number, shape});
    };
    const auto numbered = [](const char* name, std::size_t i) {
        return std::string(name) + "." + std::to_string(i);
    };
    std::int64_t parameters = 0;
    for (const Material<R>& m : scene.materials) parameters += m.parameter_count();
    add("parameters", BlockKind::dense, 0, {parameters});
    add("emission", BlockKind::dense, 0,
        {static_cast<std::int64_t>(scene.geometry->shape_count()), 3});
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        if (const auto* map = std::get_if<Environment<R>>(&scene.lights[i].model)) {
            add(numbered("lights", i), BlockKind::directions, i, {map->height, 2 * map->height, 3});
            continue;
        }
        AnyLightGradient<R> zero = zero_gradient(scene.lights[i]);
        std::int64_t count = 0;
        SceneGradient<R>::for_each_number(zero, [&](R) { ++count; });
        add(numbered("lights", i), BlockKind::dense, i, {count});
    }
    for (std::size_t m = 0; m < scene.media.size(); ++m)
        add(numbered("media", m), BlockKind::dense, m, {scene.media[m].parameter_count()});
    for (std::size_t t = 0; t < scene.texels.size(); ++t) {
        const TextureLayout& layout = scene.geometry->textures.layouts[t];
        add(numbered("textures", t), BlockKind::texels, t,
            {layout.shape.height, layout.shape.width, layout.channels});
    }
    for (std::size_t m = 0; m < scene.media.size(); ++m)
        if (scene.media[m].density) {
            const GridShape& shape = scene.geometry->media.grids[m].shape;
            add(numbered("densities", m), BlockKind::voxels, m, {shape.x, shape.y, shape.z});
        }
    return blocks;
}

template std::vector<GradientBlock<float>> gradient_blocks(const PathScene<float>&);
template std::vector<GradientBlock<double>> gradient_blocks(const PathScene<double>&);

}  // namespace photograd
