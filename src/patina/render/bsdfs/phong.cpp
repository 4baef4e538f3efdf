#include "patina/render/bsdfs/phong.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/bsdfs/cosine_lobe.h"
#include "patina/render/sampling.h"

namespace patina::render {

bool Phong::sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const {
    if (outgoing.z() <= 0) return false;
    const Vec3 mirror(-outgoing.x(), -outgoing.y(), outgoing.z());
    sample.incident = u < specular_share ? sample_cosine_lobe(mirror, exponent, u2) : cosine_hemisphere(u2);
    BsdfValue value;
    if (!evaluate(point, outgoing, sample.incident, value) || !(value.pdf > 0)) return false;
    sample.pdf = value.pdf;
    sample.weight.set_depolarizing(value.f.m[0] / value.pdf);
    return true;
}

bool Phong::evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const {
    if (outgoing.z() <= 0 || incident.z() <= 0) return false;
    const Vec3 mirror(-outgoing.x(), -outgoing.y(), outgoing.z());
    const float lobe = cosine_lobe_density(mirror, exponent, incident);
    value.pdf = specular_share * lobe + (1 - specular_share) * incident.z() * inv_pi_f;
    const Wavelengths& w = *point.wavelengths;
    const Float4 diffuse = diffuse_reflectance.at(w, point.uv) * inv_pi_f;
    const Float4 specular = specular_reflectance.at(w, point.uv) * (lobe * (exponent + 2) / (exponent + 1));
    value.f.set_depolarizing((diffuse + specular) * incident.z());
    return true;
}

PluginDescriptor Phong::describe() {
    return {"bsdf",
            "phong",
            "Modified Phong model, normalized (empirical, depolarizing).",
            {{"exponent", "number", "", "30", "0 .. 1e6", "sharpness of the lobe"},
             {"diffuse_reflectance", "spectrum or texture", "", "0.5", "0 .. 1", "Lambertian part"},
             {"specular_reflectance", "spectrum or texture", "", "0.2", "0 .. 1", "lobe at normal incidence"}}};
}

Phong Phong::build(const Properties& node, const BsdfBuilder& builder) {
    Phong p;
    p.exponent = static_cast<float>(node.number("exponent", 30.0));
    if (!(p.exponent >= 0 && p.exponent <= 1e6f))
        throw input_error(node.location_of("exponent"), "exponent out of range", fmt::format("it is {}", p.exponent),
                          "keep it between 0 and 1e6");
    p.diffuse_reflectance = Texture::reflectance(node, "diffuse_reflectance", 0.5f, *builder.resources);
    p.specular_reflectance = Texture::reflectance(node, "specular_reflectance", 0.2f, *builder.resources);
    const float diffuse = p.diffuse_reflectance.average(), specular = p.specular_reflectance.average();
    if (diffuse + specular > 1.001f)
        throw input_error(node.where, "the surface reflects more light than it gets",
                          fmt::format("diffuse and specular reflectance add up to {:.3g}", diffuse + specular),
                          "keep their sum at 1 or below");
    p.specular_share = diffuse + specular > 0 ? specular / (diffuse + specular) : 0.0f;
    return p;
}

}  // namespace patina::render
