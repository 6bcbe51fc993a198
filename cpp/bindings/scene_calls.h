// How functions are bound that begin with a scene: each is written with one SceneRows, and Python
// calls it with the seven arguments that this is made of, by their names.
#pragma once

#include "path_args.h"

namespace photograd {

/// call(scene, more...) as a function of the scene's arguments and `more`.
template <class Result, class... More>
auto of_scene(Result (*call)(const SceneRows&, More...)) {
    return [call](const PathGeometry& geometry, const Models& models, const py::array& parameters,
                  const py::array& emission, const LightTuples& lights, const Arrays& textures,
                  const MediumTuples& media, More... more) {
        return call({geometry, models, parameters, emission, lights, textures, media},
                    std::forward<More>(more)...);
    };
}

/// define(names...) with the names of the scene's arguments.
template <class Define>
void with_scene_names(Define&& define) {
    define(py::arg("geometry"), py::arg("models"), py::arg("parameters"), py::arg("emission"),
           py::arg("lights"), py::arg("textures"), py::arg("media"));
}

}  // namespace photograd
