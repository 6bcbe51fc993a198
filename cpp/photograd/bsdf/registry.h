// All reflectance models. A new one: its header, and its name here. Bindings, stubs, proofs, benchmark rows
// and gallery pictures follow.
#pragma once

#include "photograd/bsdf/lambert.h"

namespace photograd {

using Bsdfs = ModelList<Lambert>;

}  // namespace photograd
