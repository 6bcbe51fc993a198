// All reflectance models. A new one: its header, and its name here. Bindings, stubs, proofs,
// benchmark rows and gallery pictures follow.
#pragma once

#include "photograd/bsdf/blinn_phong.h"
#include "photograd/bsdf/burley_diffuse.h"
#include "photograd/bsdf/clearcoat.h"
#include "photograd/bsdf/conductor.h"
#include "photograd/bsdf/cook_torrance.h"
#include "photograd/bsdf/disney.h"
#include "photograd/bsdf/dispersive_dielectric.h"
#include "photograd/bsdf/ggx_anisotropic.h"
#include "photograd/bsdf/ggx_metal.h"
#include "photograd/bsdf/ggx_metal_compensated.h"
#include "photograd/bsdf/ggx_metal_fast.h"
#include "photograd/bsdf/gltf.h"
#include "photograd/bsdf/gltf_iridescence.h"
#include "photograd/bsdf/gltf_layered.h"
#include "photograd/bsdf/gltf_refraction.h"
#include "photograd/bsdf/gltf_sheen.h"
#include "photograd/bsdf/gltf_specular.h"
#include "photograd/bsdf/gltf_transmission.h"
#include "photograd/bsdf/lambert.h"
#include "photograd/bsdf/oren_nayar.h"
#include "photograd/bsdf/oren_nayar_energy_preserving.h"
#include "photograd/bsdf/oren_nayar_full.h"
#include "photograd/bsdf/phong.h"
#include "photograd/bsdf/principled.h"
#include "photograd/bsdf/rough_dielectric.h"
#include "photograd/bsdf/sheen.h"
#include "photograd/bsdf/standard.h"

namespace photograd {

using Bsdfs =
    ModelList<Lambert, Phong, PhongReciprocal, BlinnPhong, BlinnPhongFitted, OrenNayarQualitative,
              OrenNayarFull, OrenNayarEnergyPreserving, BurleyDiffuse, CookTorrance, GgxMetal,
              GgxMetalCompensated, GgxMetalFast, GgxConductor, BeckmannConductor, GgxAnisotropic,
              Standard, Gltf, GltfIridescence, GltfSheen, GltfSpecular, Clearcoat, Sheen, Disney,
              RoughDielectric, DispersiveDielectric, GltfTransmission, GltfRefraction, GltfLayered,
              GltfLayeredConserving, GltfLayeredVolume, GltfLayeredVolumeConserving, Principled>;

}  // namespace photograd
