// All lights of a fixed number of parameters. A new one: its header, and its name here. Meshes and
// environment maps, whose size is not fixed, have bindings of their own.
#pragma once

#include "photograd/light/constant_light.h"
#include "photograd/light/directional_light.h"
#include "photograd/light/point_light.h"
#include "photograd/light/quad_light.h"
#include "photograd/light/sky.h"
#include "photograd/light/sphere_light.h"
#include "photograd/light/spot_light.h"
#include "photograd/light/sun.h"
#include "photograd/light/triangle_light.h"

namespace photograd {

/// At infinity: radiance by direction alone.
using Lights = ModelList<Sun, Sky, ConstantLight>;

/// Of one direction at each place; no ray ever hits them.
using DeltaLights = ModelList<PointLight, DirectionalLight, SpotLight>;

/// Surfaces that emit.
using AreaLights = ModelList<QuadLight, SphereLight, TriangleLight>;

}  // namespace photograd
