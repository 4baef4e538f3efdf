#pragma once
// The closed set of surface models and their dispatch. Adding one: its header and source in bsdfs/, and one line here.

#include "patina/render/bsdf.h"
#include "patina/render/bsdfs/blend.h"
#include "patina/render/bsdfs/conductor.h"
#include "patina/render/bsdfs/dielectric.h"
#include "patina/render/bsdfs/diffuse.h"
#include "patina/render/bsdfs/dipole.h"
#include "patina/render/bsdfs/lafortune.h"
#include "patina/render/bsdfs/mask.h"
#include "patina/render/bsdfs/measured.h"
#include "patina/render/bsdfs/normal_map.h"
#include "patina/render/bsdfs/oren_nayar.h"
#include "patina/render/bsdfs/paint.h"
#include "patina/render/bsdfs/phong.h"
#include "patina/render/bsdfs/plastic.h"
#include "patina/render/bsdfs/polarizer.h"
#include "patina/render/bsdfs/principled.h"
#include "patina/render/bsdfs/rough_conductor.h"
#include "patina/render/bsdfs/rough_dielectric.h"
#include "patina/render/bsdfs/thin_dielectric.h"
#include "patina/render/bsdfs/two_sided.h"

namespace patina::render {

template <BsdfModel... Models>
using BsdfVariant = std::variant<Models...>;

struct Bsdf {
    using Model = BsdfVariant<Diffuse, OrenNayar, Phong, Lafortune, Principled,  // empirical
                              Dielectric, ThinDielectric, RoughDielectric,       // interfaces
                              Conductor, RoughConductor,                         // metals
                              Plastic, RoughPlastic, PolarizedPlastic, Paint,    // coatings
                              Dipole,                                            // translucent matter
                              MeasuredPolarized, Merl,                           // tables
                              LinearPolarizer, Retarder, CircularPolarizer,      // polarization optics
                              TwoSided, Blend, Mask, NormalMap, BumpMap, Null>;
    Model model;
};

inline const Bsdf& nested_bsdf(const ShadingPoint& point, int index) {
    return point.set[index];
}

inline bool bsdf_sample(const Bsdf& bsdf, const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2,
                        BsdfSample& sample) {
    return std::visit([&](const auto& model) { return model.sample(point, outgoing, u, u2, sample); }, bsdf.model);
}
inline bool bsdf_evaluate(const Bsdf& bsdf, const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident,
                          BsdfValue& value) {
    return std::visit([&](const auto& model) { return model.evaluate(point, outgoing, incident, value); }, bsdf.model);
}
inline bool bsdf_is_delta(const Bsdf& bsdf, const ShadingPoint& point) {
    return std::visit([&](const auto& model) { return model.is_delta(point); }, bsdf.model);
}

// Every model's descriptor, in the order of the variant.
std::vector<PluginDescriptor> bsdf_descriptors();

// The model a plugin of a scene names. Throws Error(input) for unknown plugins and properties.
Bsdf build_bsdf(const Properties& node, const BsdfBuilder& builder);

}  // namespace patina::render
