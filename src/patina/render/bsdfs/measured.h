#pragma once
// Measured or exported tables: `measured_polarized` (Mueller, .pbsdf files) and `merl` (RGB, MERL .binary files).
//
// measured_polarized: Baek, Zeltner, Ku, Hwang, Tong, Jakob & Kim (2020), Image-based acquisition and modeling of
// polarimetric reflectance, as Mitsuba 3 stores it: a Mueller matrix on half and difference angles and wavelength,
// linear between nodes, constant beyond the measured wavelengths, 0 where not measured (brdf/half_angle_table.h).
// merl: Matusik, Pfister, Brand & McMillan (2003), A data-driven reflectance model: nearest cell, as its own reader
// does it; depolarizing. Its RGB becomes a spectrum by three smooth basis spectra that add up to 1: greys are exact,
// saturated colours off by some percent.
//
// Directions are drawn from facets (GGX of roughness alpha_sample) or a cosine, half each. A measurement gives back
// what was measured: neither energy conservation, nor reciprocity, nor realizability is more than approximate. Black
// from behind.

#include "patina/brdf/half_angle_table.h"
#include "patina/brdf/merl_table.h"
#include "patina/render/bsdf.h"
#include "patina/render/microfacet.h"

namespace patina::render {

struct MeasuredPolarized {
    std::shared_ptr<const brdf::HalfAngleTable> table;
    Microfacets proposal;
    float only_wavelength_nm = 0;  // > 0: what the table holds there stands for every wavelength

    bool is_delta(const ShadingPoint&) const { return false; }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const;
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const;

    static PluginDescriptor describe();
    static MeasuredPolarized build(const Properties& node, const BsdfBuilder& builder);
};

struct Merl {
    std::shared_ptr<const brdf::MerlTable> table;
    Microfacets proposal;
    std::array<Spectrum, 3> basis;

    bool is_delta(const ShadingPoint&) const { return false; }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const;
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const;

    static PluginDescriptor describe();
    static Merl build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
