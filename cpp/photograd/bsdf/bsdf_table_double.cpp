// The table on doubles and dual numbers, and what models say about themselves.
#include "photograd/bsdf/bsdf_rows.h"

namespace photograd {
namespace {

template <template <class> class... M>
constexpr std::array<BsdfInfo, sizeof...(M)> infos_of_all(ModelList<M...>) {
    return {info_of<M<double>>()...};
}
template <template <class> class... M>
constexpr std::array<BsdfTangents, sizeof...(M)> tangents_of_all(ModelList<M...>) {
    return {tangents_of<M<Dual<double>>>()...};
}

constexpr auto infos = infos_of_all(AllBsdfs{});
constexpr auto double_functions = functions_of_all<double>(AllBsdfs{});
constexpr auto tangents = tangents_of_all(AllBsdfs{});

}  // namespace

constinit const std::span<const BsdfInfo> bsdf_infos = infos;
constinit const BsdfFunctions<double>* const double_bsdfs = double_functions.data();
constinit const BsdfTangents* const bsdf_tangents = tangents.data();

}  // namespace photograd
