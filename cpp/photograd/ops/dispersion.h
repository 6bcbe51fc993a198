// The refractive index of glass for red, green and blue light, after KHR_materials_dispersion
// [Khronos2022].
//
// Glass is denser for blue light than for red. Abbe's number V = (n_d - 1) / (n_F - n_C) says how
// little, by the indices at the lines C (656.3 nm, red), d (587.6 nm) and F (486.1 nm, blue). With
// eta = n_d, dispersion = 20 / V and k = -1, 0, 1 for red, green and blue,
//
//   index_k = eta + k (eta - 1) dispersion / 40      so that index_blue - index_red = (eta - 1) / V
//
//   dindex_k/deta = 1 + k dispersion / 40                dindex_k/ddispersion = k (eta - 1) / 40
//
// These are the extension's three indices. Its law for single wavelengths, Cauchy's, has the same
// distance from C to F and divides it unevenly, 0.30 below d and 0.70 above.
#pragma once

#include "photograd/core/vec.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

template <class R>
inline Vec3<R> channel_indices(R eta, R dispersion) {
    const R half = (eta - R(1)) * dispersion * R(0.025);
    return {eta - half, eta, eta + half};
}
template <class R>
inline void channel_indices_backward(R eta, R dispersion, const Vec3<R>& d_index, R& d_eta,
                                     R& d_dispersion) {
    const R d_half = d_index.z - d_index.x;
    d_eta += d_index.x + d_index.y + d_index.z + d_half * dispersion * R(0.025);
    d_dispersion += d_half * (eta - R(1)) * R(0.025);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
