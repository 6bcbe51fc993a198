#include <cstdlib>
#include <string>

#include "kernels/kernels.h"
#include "photograd/core/errors.h"

namespace photograd {

namespace baseline {
extern const Kernels table;
}
namespace v3 {
extern const Kernels table;
}
namespace v4 {
extern const Kernels table;
}

namespace {

const Kernels* supported(const std::string& name) {
#if defined(PHOTOGRAD_HAS_v4)
    if (name == "v4" && __builtin_cpu_supports("x86-64-v4")) return &v4::table;
#endif
#if defined(PHOTOGRAD_HAS_v3)
    if (name == "v3" && __builtin_cpu_supports("x86-64-v3")) return &v3::table;
#endif
    return name == "baseline" ? &baseline::table : nullptr;
}

const Kernels& choose() {
    if (const char* forced = std::getenv("PHOTOGRAD_ISA"); forced && *forced) {
        if (const Kernels* table = supported(forced)) return *table;
        fail(ErrorKind::range, "photograd", "PHOTOGRAD_ISA",
             "baseline, v3 or v4, one that this processor supports", forced, "unset the variable");
    }
    for (const char* name : {"v4", "v3"})
        if (const Kernels* table = supported(name)) return *table;
    return baseline::table;
}

}  // namespace

const Kernels& kernels() {
    static const Kernels& chosen = choose();
    return chosen;
}

}  // namespace photograd
