// The table on floats. A file of its own, so that it compiles beside that on doubles.
#include "photograd/bsdf/bsdf_rows.h"

namespace photograd {
namespace {
constexpr auto float_functions = functions_of_all<float>(AllBsdfs{});
}

constinit const BsdfFunctions<float>* const float_bsdfs = float_functions.data();

}  // namespace photograd
