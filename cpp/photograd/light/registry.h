// All lights. A new one: its header, and its name here.
#pragma once

#include "photograd/light/sky.h"
#include "photograd/light/sun.h"

namespace photograd {

using Lights = ModelList<Sun, Sky>;

}  // namespace photograd
