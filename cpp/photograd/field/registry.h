// The radiance fields that the marcher can render. A new field: one header and one line here.
#pragma once

#include "photograd/core/params.h"
#include "photograd/field/dense_grid.h"
#include "photograd/field/tiny_network.h"

namespace photograd {

template <Real R>
using Fields = TypeList<DenseGrid<R>, TinyNetwork<R>>;

}  // namespace photograd
