#include "patina/render/bsdfs/plastic.h"

#include "patina/render/bsdfs/matrix_sum.h"
#include "patina/render/fresnel_packet.h"
#include "patina/render/indices.h"
#include "patina/render/sampling.h"

namespace patina::render {

namespace {

// Share of diffuse light that a surface reflects into a medium from which the other has the relative index eta >= 1:
// int_0^1 R(mu) d(mu^2), by the midpoint rule in mu^2 (400 points: 1e-4).
double diffuse_reflectance_outside(double eta) {
    constexpr int points = 400;
    double total = 0;
    for (int i = 0; i < points; ++i) {
        const auto mu = static_cast<float>(std::sqrt((i + 0.5) / points));
        total += fresnel_dielectric(mu, splat(static_cast<float>(eta))).reflection.a[0] / points;
    }
    return total;
}

// The same inside the body of relative index eta. From the denser side total reflection hides all but a cone of light
// that narrows as 1 / eta^2; both sides let the same etendue through (Kubelka 1954).
double diffuse_internal_reflectance(double eta) {
    if (eta <= 1) return diffuse_reflectance_outside(1 / eta);
    return 1 - (1 - diffuse_reflectance_outside(eta)) / (eta * eta);
}

}  // namespace

Spectrum diffuse_internal_reflectance(const Spectrum& interior_index, const Spectrum& exterior_index) {
    return Spectrum([&](double nm) {
        const Wavelengths w = Wavelengths::all_at(static_cast<float>(nm));
        return diffuse_internal_reflectance(interior_index.at(w)[0] / exterior_index.at(w)[0]);
    });
}

float PlasticLayer::specular_share(Float4 reflectance) const {
    const float surface = mean(reflectance) * specular_average, body = (1 - mean(reflectance)) * diffuse_average;
    return surface + body > 0 ? surface / (surface + body) : 0.0f;
}

bool PlasticLayer::sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2,
                          BsdfSample& sample) const {
    if (outgoing.z() <= 0) return false;
    const Wavelengths& w = *point.wavelengths;
    const Float4 eta = interior_index.at(w) / exterior_index.at(w);
    const FresnelPacket mirror = fresnel_dielectric(outgoing.z(), eta).reflection;
    const float share = specular_share(mirror.a);
    if (u < share && !roughness) {
        const Vec3 axis = perpendicular_to_normal(outgoing);
        sample.incident = Vec3(-outgoing.x(), -outgoing.y(), outgoing.z());
        sample.pdf = share;
        sample.delta = true;
        const Float4 scale = specular_reflectance.at(w, point.uv) / share;
        sample.weight.set_fresnel(mirror.a * scale, mirror.b * scale, mirror.c * scale, splat(0), axis, axis);
        return true;
    }

    // Draw from the facets or from the cosine; both may have led to the direction.
    if (u < share) {
        const Vec3 m = roughness->at(point.uv).sample(outgoing, u2);
        sample.incident = 2 * outgoing.dot(m) * m - outgoing;
    } else {
        sample.incident = cosine_hemisphere(u2);
    }
    return weigh_by_all_lobes(*this, point, outgoing, sample);
}

bool PlasticLayer::evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident,
                            BsdfValue& value) const {
    if (outgoing.z() <= 0 || incident.z() <= 0) return false;
    const Wavelengths& w = *point.wavelengths;
    const Float4 eta = interior_index.at(w) / exterior_index.at(w);
    const float share = specular_share(fresnel_dielectric(outgoing.z(), eta).reflection.a);
    add_body(point, outgoing, incident, eta, value.f);
    value.pdf = (1 - share) * incident.z() * inv_pi_f;
    if (roughness) value.pdf += share * add_facets(point, outgoing, incident, eta, value.f);
    return true;
}

// Sets f to the body's part times cos_i.
void PlasticLayer::add_body(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, Float4 eta,
                            ScatteringMatrix& f) const {
    const Float4 rho = diffuse_reflectance.at(*point.wavelengths, point.uv);
    Float4 scale = rho * (incident.z() * inv_pi_f);
    if (internal_reflections) {
        const Float4 back = returned_inside.at(*point.wavelengths);
        scale = scale / (eta * eta * (1 - (nonlinear ? rho * back : back)));
    }
    const FresnelPacket out = fresnel_dielectric(outgoing.z(), eta).transmission;
    const FresnelPacket in = fresnel_dielectric(incident.z(), eta).transmission;
    f.form = ScatteringMatrix::Form::general;
    for (Float4& entry : f.m) entry = splat(0);
    f.m[0] = scale * out.a * in.a;
    f.m[1] = scale * out.b * in.a;
    f.m[4] = scale * out.a * in.b;
    f.m[5] = scale * out.b * in.b;
    f.x_out = perpendicular_to_normal(outgoing);
    f.x_in = perpendicular_to_normal(incident);
}

// Adds the facets' part times cos_i; returns the density of their visible normals.
float PlasticLayer::add_facets(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, Float4 eta,
                               ScatteringMatrix& f) const {
    const Microfacets facets = roughness->at(point.uv);
    const Vec3 m = (outgoing + incident).normalized();
    const float scale = facets.density(m) / (4 * outgoing.z());
    const float lambda_o = facets.lambda(outgoing), lambda_i = facets.lambda(incident);
    const FresnelPacket r = fresnel_dielectric(std::min(outgoing.dot(m), 1.0f), eta).reflection;
    const Float4 factor = specular_reflectance.at(*point.wavelengths, point.uv) * (scale / (1 + lambda_o + lambda_i));
    const Vec3 axis = common_perpendicular(outgoing, incident);
    ScatteringMatrix surface;
    surface.set_fresnel(r.a * factor, r.b * factor, r.c * factor, r.d * factor, axis, axis);
    add_to(f, surface, outgoing, incident);
    return scale / (1 + lambda_o);
}

PlasticLayer PlasticLayer::common(const Properties& node, const BsdfBuilder& builder, const char* interior) {
    PlasticLayer p;
    p.interior_index = real_index(node, "int_ior", interior, builder);
    p.exterior_index = real_index(node, "ext_ior", "air", builder);
    p.diffuse_reflectance = Texture::reflectance(node, "diffuse_reflectance", 0.5f, *builder.resources);
    p.specular_reflectance = Texture::reflectance(node, "specular_reflectance", 1.0f, *builder.resources);
    p.diffuse_average = p.diffuse_reflectance.average();
    p.specular_average = p.specular_reflectance.average();
    p.returned_inside = diffuse_internal_reflectance(p.interior_index, p.exterior_index);
    return p;
}

namespace {

std::vector<ParameterDescriptor> plastic_parameters(const char* interior, bool rough, bool nonlinear) {
    std::vector<ParameterDescriptor> all = {
        {"int_ior", "number, medium, material or spectrum", "", interior, "0.1 .. 10", "index of the body"},
        {"ext_ior", "number, medium, material or spectrum", "", "air", "0.1 .. 10", "index on the side of the normal"},
        {"diffuse_reflectance", "spectrum or texture", "", "0.5", "0 .. 1", "albedo of the body, surface taken off"},
        {"specular_reflectance", "spectrum or texture", "", "1", "0 .. 1", "factor on the surface (not physical)"}};
    if (nonlinear)
        all.push_back({"nonlinear", "boolean", "", "false", "", "colour deepens by reflections inside the surface"});
    if (rough)
        for (ParameterDescriptor& p : microfacet_parameters()) all.push_back(std::move(p));
    return all;
}

}  // namespace

PluginDescriptor Plastic::describe() {
    return {"bsdf", "plastic", "Smooth dielectric surface over a diffuse body, polarized.",
            plastic_parameters("polypropylene", false, true)};
}
Plastic Plastic::build(const Properties& node, const BsdfBuilder& builder) {
    Plastic p{common(node, builder, "polypropylene")};
    p.nonlinear = node.boolean("nonlinear", false);
    return p;
}

PluginDescriptor RoughPlastic::describe() {
    return {"bsdf", "roughplastic", "Rough dielectric surface over a diffuse body, polarized.",
            plastic_parameters("polypropylene", true, true)};
}
RoughPlastic RoughPlastic::build(const Properties& node, const BsdfBuilder& builder) {
    RoughPlastic p{common(node, builder, "polypropylene")};
    p.nonlinear = node.boolean("nonlinear", false);
    p.roughness = microfacets_of(node, *builder.resources);
    return p;
}

PluginDescriptor PolarizedPlastic::describe() {
    return {"bsdf", "pplastic", "Polarized diffuse and specular reflection as measured by Baek et al. (2018).",
            plastic_parameters("polypropylene", true, false)};
}
PolarizedPlastic PolarizedPlastic::build(const Properties& node, const BsdfBuilder& builder) {
    PolarizedPlastic p{common(node, builder, "polypropylene")};
    p.internal_reflections = false;
    p.roughness = microfacets_of(node, *builder.resources);
    return p;
}

}  // namespace patina::render
