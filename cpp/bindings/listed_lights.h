// A list of lights without surface (light/any_light.h) as Python gives it, a tuple a light:
//
//   (name in the registry, parameters (P,), constants (C,))      or      ("environment", texels, world_from_map, sampler)
#pragma once

#include "environment_args.h"
#include "light_calls.h"
#include "photograd/light/any_light.h"

namespace photograd {

using LightTuples = std::vector<py::tuple>;

template <class R>
AnyLight<R> listed_light(const py::tuple& row) {
    const auto name = row[0].cast<std::string>();
    ArrayArgs args(name);
    const auto first = row[1].cast<py::array>(), second = row[2].cast<py::array>();
    if (name == Environment<R>::name)
        return {environment_in<R>(args, row[3].cast<const EnvironmentSampler&>(), first, second)};
    AnyLight<R> light;
    bool found = false;
    const auto look = [&]<template <class> class M>() {
        if (name != M<R>::name) return;
        light.model = light_of<M<R>, R>(args, first, second);
        found = true;
    };
    Lights::for_each(look);
    DeltaLights::for_each(look);
    if (!found)
        fail(ErrorKind::scene, "PathTracer", "lights", "a light without a surface", name,
             "lights with a surface are shapes");
    return light;
}

template <class R>
std::vector<AnyLight<R>> listed_lights(const LightTuples& rows) {
    std::vector<AnyLight<R>> lights;
    for (const py::tuple& row : rows) lights.push_back(listed_light<R>(row));
    return lights;
}

/// Where the derivatives of each light's first array go: arrays of the same shapes.
template <class R>
std::vector<R*> light_derivatives(const LightTuples& rows, std::vector<py::array>& d_lights) {
    if (rows.size() != d_lights.size())
        fail(ErrorKind::shape, "trace_paths_backward", "d_lights",
             std::to_string(rows.size()) + " arrays", std::to_string(d_lights.size()));
    std::vector<R*> out;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto first = rows[i][1].cast<py::array>();
        std::string axes;
        for (py::ssize_t k = 0; k < first.ndim(); ++k) {
            if (k > 0) axes += ' ';
            axes += std::to_string(first.shape(k));
        }
        ArrayArgs args("trace_paths_backward");
        out.push_back(args.out<R>("d_lights", d_lights[i], axes));
    }
    return out;
}

}  // namespace photograd
