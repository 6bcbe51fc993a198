#include "photograd/scene/material.h"

#include <algorithm>
#include <string>

#include "photograd/core/errors.h"

namespace photograd {

template <Real R>
Material<R> Material<R>::read(std::string_view name, const R* row) {
    constexpr std::string_view mark = "+alpha";
    Material material;
    material.has_opacity = name.ends_with(mark);
    if (material.has_opacity) name.remove_suffix(mark.size());
    const auto found = std::ranges::find(bsdf_infos, name, &BsdfInfo::name);
    if (found == bsdf_infos.end())
        fail(ErrorKind::scene, "material", "model", "a registered reflectance model",
             std::string(name), "photograd.bsdf.registry() and photograd.bsdf.specular.registry()");
    material.model = static_cast<std::uint16_t>(found - bsdf_infos.begin());
    material.set(row);
    return material;
}

template <Real R>
Material<R> Material<R>::zero() const {
    Material out;
    out.model = model;
    out.has_opacity = has_opacity;
    out.alpha = R(0);
    return out;
}

template <Real R>
void Material<R>::add_to(double* out) const {
    for (int k = 0; k < info().parameter_count; ++k) *out++ += static_cast<double>(parameter[k]);
    if (has_opacity) *out += static_cast<double>(alpha);
}

template <Real R>
void Material<R>::get(R* row) const {
    row = std::copy_n(parameter, info().parameter_count, row);
    if (has_opacity) *row = alpha;
}

template <Real R>
void Material<R>::set(const R* row) {
    std::copy_n(row, info().parameter_count, parameter);
    if (has_opacity) alpha = row[info().parameter_count];
}

template struct Material<float>;
template struct Material<double>;

}  // namespace photograd
