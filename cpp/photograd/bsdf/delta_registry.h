// All specular surfaces. A new one: its header, and its name here.
#pragma once

#include "photograd/bsdf/dispersive_glass.h"
#include "photograd/bsdf/glass.h"
#include "photograd/bsdf/mirror.h"
#include "photograd/bsdf/thin_glass.h"

namespace photograd {

using DeltaBsdfs = ModelList<Mirror, Glass, ThinGlass, DispersiveGlass>;

}  // namespace photograd
