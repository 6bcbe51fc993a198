// A list of lights without surface (light/any_light.h) as Python gives it, a tuple a light:
//
//   (name in the registry, parameters (P,), constants (C,))
//   ("environment", texels, world_from_map, sampler)
#pragma once

#include "environment_args.h"
#include "light_calls.h"
#include "photograd/light/any_light.h"

namespace photograd {

using LightTuples = std::vector<py::tuple>;

/// The first entries of all of these tuples.
struct LightRow {
    std::string name;
    py::array first, second;

    explicit LightRow(const py::tuple& row) {
        if (row.size() < 3) refuse("3 entries a light", row.size());
        name = entry_as<std::string>("PathTracer", "lights", "names of lights", row[0]);
        first = entry_as<py::array>("PathTracer", "lights", "arrays", row[1]);
        second = entry_as<py::array>("PathTracer", "lights", "arrays", row[2]);
    }
    [[noreturn]] static void refuse(const char* expected, std::size_t size) {
        fail(ErrorKind::shape, "PathTracer", "lights", expected,
             "a tuple of " + std::to_string(size));
    }
};

template <class R>
AnyLight<R> infinite_or_delta(const py::tuple& row) {
    const LightRow of(row);
    const std::string& name = of.name;
    ArrayArgs args(name);
    const py::array &first = of.first, &second = of.second;
    if (name == Environment<R>::name) {
        if (row.size() < 4) of.refuse("4 entries, the last of them a sampler", row.size());
        const auto* sampler = entry_as<const EnvironmentSampler*>("environment", "lights",
                                                                  "an EnvironmentSampler", row[3]);
        if (!sampler) of.refuse("an EnvironmentSampler", row.size());
        return {environment_in<R>(args, *sampler, first, second)};
    }
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
std::vector<AnyLight<R>> infinite_and_delta(const LightTuples& rows) {
    std::vector<AnyLight<R>> lights;
    for (const py::tuple& row : rows) lights.push_back(infinite_or_delta<R>(row));
    return lights;
}

}  // namespace photograd
