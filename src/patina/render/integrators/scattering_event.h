#pragma once
// The kinds of scattering that light-path expressions tell apart (Heckbert 1990, and V for media).
//
//   S specular   every delta function: mirrors, smooth interfaces, polarization elements, the mirror part of a paint
//   D diffuse    the rest of `diffuse`, `dipole`, `orennayar`, `plastic` and `paint` (a body: light that came out of
//   the
//                coating)
//   G glossy     the rest of every other model: a rough metal's lobe, a table, a lobe and a body that are not told
//                apart
//   V volume     scattering by the particles of a medium
//
// A model is one kind for all that is not a delta function; it may say which by a member
// `ScatteringEvent scattering_event(const ShadingPoint&, const Vec3& outgoing) const`. Models made of others are what
// those are; a mixture of two kinds is glossy.

#include <cstdint>
#include <type_traits>
#include <variant>

#include "patina/render/bsdf_set.h"

namespace patina::render {

enum class ScatteringEvent : std::uint8_t { diffuse, glossy, specular, volume };
inline constexpr int scattering_events = 4;

inline ScatteringEvent continuous_event(const Bsdf& bsdf, const ShadingPoint& point, const Vec3& outgoing);

inline ScatteringEvent event_of_mixture(const Blend& blend, const ShadingPoint& point, const Vec3& outgoing) {
    const Bsdf &first = nested_bsdf(point, blend.first), &second = nested_bsdf(point, blend.second);
    const float share = mean(blend.weight.at(*point.wavelengths, point.uv));
    if (share <= 0 || bsdf_is_delta(second, point)) return continuous_event(first, point, outgoing);
    if (share >= 1 || bsdf_is_delta(first, point)) return continuous_event(second, point, outgoing);
    const ScatteringEvent event = continuous_event(first, point, outgoing);
    return event == continuous_event(second, point, outgoing) ? event : ScatteringEvent::glossy;
}

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
            } else if constexpr (std::is_base_of_v<NormalMap, Model> || std::is_same_v<Model, Mask>) {
                return continuous_event(nested_bsdf(point, model.model), point, outgoing);
            } else if constexpr (std::is_same_v<Model, Blend>) {
                return event_of_mixture(model, point, outgoing);
            } else if constexpr (std::is_same_v<Model, Diffuse> || std::is_same_v<Model, OrenNayar> ||
                                 std::is_same_v<Model, Plastic> || std::is_same_v<Model, Paint> ||
                                 std::is_same_v<Model, Dipole>) {
                return ScatteringEvent::diffuse;
            } else {
                return ScatteringEvent::glossy;
            }
        },
        bsdf.model);
}

}  // namespace patina::render
