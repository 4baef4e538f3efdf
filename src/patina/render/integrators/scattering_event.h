#pragma once
// The kinds of scattering that light-path expressions tell apart (Heckbert 1990, and V for media).
//
//   S specular   every delta function: mirrors, smooth interfaces, polarization elements, the mirror part of a paint
//   D diffuse    the rest of `diffuse` and of `paint` (its body: light that came out of the coating)
//   G glossy     the rest of every other model, a rough conductor's lobe for instance
//   V volume     scattering by the particles of a medium
//
// A model is one kind for all that is not a delta function; it may say which by a member
// `ScatteringEvent scattering_event(const ShadingPoint&, const Vec3& outgoing) const`.

#include <cstdint>
#include <type_traits>
#include <variant>

#include "patina/render/bsdf_set.h"

namespace patina::render {

enum class ScatteringEvent : std::uint8_t { diffuse, glossy, specular, volume };
inline constexpr int scattering_events = 4;

// The kind of the part of a model that is not a delta function.
inline ScatteringEvent continuous_event(const Bsdf& bsdf, const ShadingPoint& point, const Vec3& outgoing) {
    return std::visit(
        [&](const auto& model) {
            using Model = std::decay_t<decltype(model)>;
            if constexpr (requires { model.scattering_event(point, outgoing); }) {
                return model.scattering_event(point, outgoing);
            } else if constexpr (std::is_same_v<Model, TwoSided>) {
                return continuous_event(nested_bsdf(point, outgoing.z() > 0 ? model.front : model.back), point,
                                        outgoing);
            } else if constexpr (std::is_base_of_v<NormalMap, Model>) {
                return continuous_event(nested_bsdf(point, model.model), point, outgoing);
            } else if constexpr (std::is_same_v<Model, Diffuse> || std::is_same_v<Model, Paint>) {
                return ScatteringEvent::diffuse;
            } else {
                return ScatteringEvent::glossy;
            }
        },
        bsdf.model);
}

}  // namespace patina::render
