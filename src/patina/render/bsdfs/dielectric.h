#pragma once
// A smooth interface between two transparent media, `dielectric`: Fresnel reflection and refraction, delta functions
// both.
//
// Born & Wolf (1999), section 1.5. Total reflection retards; the index may depend on wavelength, and then refraction
// goes on with the hero wavelength alone. Refracted radiance scales by (n_outgoing / n_incident)^2.

#include "patina/render/bsdf.h"
#include "patina/render/fresnel_packet.h"
#include "patina/render/texture.h"

namespace patina::render {

struct Dielectric {
    Spectrum interior_index, exterior_index;
    Texture specular_reflectance, specular_transmittance;
    bool dispersive = false;

    bool is_delta(const ShadingPoint&) const { return true; }
    bool evaluate(const ShadingPoint&, const Vec3&, const Vec3&, BsdfValue&) const { return false; }

    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2&, BsdfSample& sample) const {
        const Wavelengths& w = *point.wavelengths;
        const float cos_o = outgoing.z();
        if (cos_o == 0) return false;
        const Float4 inside = interior_index.at(w), outside = exterior_index.at(w);
        const Float4 eta = cos_o > 0 ? inside / outside : outside / inside;
        const FresnelInterface f = fresnel_dielectric(std::abs(cos_o), eta);

        // Reflect or refract with the probability of unpolarized light, on average over the wavelengths.
        const float reflected = point.chance_of_reflection(mean(f.reflection.a));
        const Vec3 axis = perpendicular_to_normal(outgoing);
        sample.delta = true;
        if (u < reflected) {
            sample.incident = Vec3(-outgoing.x(), -outgoing.y(), cos_o);
            sample.pdf = reflected;
            const Float4 weight = specular_reflectance.at(w, point.uv) * (1 / reflected);
            sample.weight.set_fresnel(f.reflection.a * weight, f.reflection.b * weight, f.reflection.c * weight,
                                      f.reflection.d * weight, axis, axis);
            return true;
        }
        if (f.cos_t[0] == 0) return false;  // the hero is totally reflected, another wavelength was not
        sample.pdf = 1 - reflected;
        sample.dispersed = dispersive;
        sample.eta = eta[0];
        const float inv_eta = 1 / eta[0];
        sample.incident = Vec3(-outgoing.x() * inv_eta, -outgoing.y() * inv_eta, std::copysign(f.cos_t[0], -cos_o));
        const Float4 weight = specular_transmittance.at(w, point.uv) / (sample.pdf * eta * eta);
        sample.weight.set_fresnel(f.transmission.a * weight, f.transmission.b * weight, f.transmission.c * weight,
                                  splat(0), axis, axis);
        return true;
    }

    static PluginDescriptor describe();
    static Dielectric build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
