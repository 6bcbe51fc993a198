// The geometry that glossy models share. A facet that mirrors wi into wo has the half vector as its
// normal.
#pragma once

#include "photograd/bsdf/bsdf.h"

namespace photograd {

/// Both directions on the outside; models that only reflect are zero elsewhere.
template <class R>
bool both_above(const Vec3<R>& wo, const Vec3<R>& wi) {
    return wo.z > R(0) && wi.z > R(0);
}

template <class R>
Vec3<R> half_vector(const Vec3<R>& wo, const Vec3<R>& wi) {
    return normalize(wo + wi);
}

template <class R>
Vec3<R> reflect(const Vec3<R>& wo, const Vec3<R>& wh) {
    return R(2) * dot(wo, wh) * wh - wo;
}

/// Density of wi for a half vector of density pdf_h [Walter2007, Eq. 14].
template <class R>
R reflected_pdf(const Vec3<R>& wo, const Vec3<R>& wh, R pdf_h) {
    return pdf_h / (R(4) * dot(wo, wh));
}

}  // namespace photograd
