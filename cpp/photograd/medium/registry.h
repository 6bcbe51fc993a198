// All phase functions. A new one: its header, and its name here.
#pragma once

#include "photograd/medium/cornette_shanks.h"
#include "photograd/medium/henyey_greenstein.h"

namespace photograd {

using Phases = ModelList<HenyeyGreenstein, CornetteShanks>;

}  // namespace photograd
