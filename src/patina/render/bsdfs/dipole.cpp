#include "patina/render/bsdfs/dipole.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/fresnel_packet.h"
#include "patina/render/indices.h"
#include "patina/render/medium_coefficients.h"

namespace patina::render {

namespace {

Float4 exp(Float4 x) {
    return Float4{std::exp(x[0]), std::exp(x[1]), std::exp(x[2]), std::exp(x[3])};
}

// The distance d from a source at depth z beyond which a share 1 - u of its light leaves: z/d exp(-sigma (d - z)).
double distance_to_source(double z, double sigma, double u) {
    const double rest = 1 - u;
    if (sigma * z < 1e-9) return z / rest;
    // y + ln y = l for y = sigma d, by Newton's steps from above; convex, so that they converge.
    const double l = sigma * z + std::log(sigma * z) - std::log(rest);
    double y = l > 1 ? l - std::log(l) + 1 : std::exp(l);
    for (int i = 0; i < 6; ++i) y = std::max(y * (1 + l - std::log(y)) / (1 + y), 1e-300);
    return std::max(y / sigma, z);
}

}  // namespace

DipoleProfile::DipoleProfile(Float4 absorption, Float4 reduced_scattering, Float4 returned_inside) {
    const Float4 extinction = absorption + reduced_scattering;
    albedo = reduced_scattering / extinction;
    z_r = 1 / extinction;
    z_v = z_r * (1 + 4.0f / 3 * (1 + returned_inside) / (1 - returned_inside));
    sigma_tr = sqrt(3 * absorption * extinction);
    total = 0.5f * albedo * (exp(-sigma_tr * z_r) + exp(-sigma_tr * z_v));
}

Float4 DipoleProfile::at(float r) const {
    Float4 sum = splat(0);
    for (const Float4& z : {z_r, z_v}) {
        const Float4 d2 = r * r + z * z, d = sqrt(d2);
        sum += z * (1 + sigma_tr * d) * exp(-sigma_tr * d) / (d2 * d);
    }
    return albedo * (0.25f * inv_pi_f) * sum;
}

float DipoleProfile::sample_radius(int lane, float u) const {
    // Choose the source by its share, then invert its integral.
    const double real = std::exp(-static_cast<double>(sigma_tr[lane]) * z_r[lane]),
                 image = std::exp(-static_cast<double>(sigma_tr[lane]) * z_v[lane]);
    const double share = real / (real + image);
    const double z = u < share ? z_r[lane] : z_v[lane];
    const double rest = std::min(u < share ? u / share : (u - share) / (1 - share), 1 - 1e-7);
    const double d = distance_to_source(z, sigma_tr[lane], rest);
    return static_cast<float>(std::sqrt(std::max(0.0, d * d - z * z)));
}

float Dipole::body_share(const Wavelengths& w, const Vec3& outgoing) const {
    return 1 -
           specular_share(fresnel_dielectric(outgoing.z(), interior_index.at(w) / exterior_index.at(w)).reflection.a);
}

void Dipole::leave(const Wavelengths& w, const Vec3& outgoing, ScatteringMatrix& m) const {
    const FresnelPacket t = fresnel_dielectric(outgoing.z(), interior_index.at(w) / exterior_index.at(w)).transmission;
    m.form = ScatteringMatrix::Form::general;
    for (Float4& entry : m.m) entry = splat(0);
    m.m[0] = t.a, m.m[1] = t.b;
    m.x_in = m.x_out = perpendicular_to_normal(outgoing);
}

void Dipole::enter(const Wavelengths& w, const Vec3& incident, ScatteringMatrix& m) const {
    const Float4 eta = interior_index.at(w) / exterior_index.at(w);
    const FresnelPacket t = fresnel_dielectric(incident.z(), eta).transmission;
    // What a surface lets out of diffuse light it lets in divided by eta^2 (Stokes' reversibility).
    const Float4 scale = incident.z() * inv_pi_f / (eta * eta * (1 - returned_inside.at(w)));
    m.form = ScatteringMatrix::Form::general;
    for (Float4& entry : m.m) entry = splat(0);
    m.m[0] = scale * t.a, m.m[4] = scale * t.b;
    m.x_in = m.x_out = perpendicular_to_normal(incident);
}

PluginDescriptor Dipole::describe() {
    return {
        "bsdf",
        "dipole",
        "Translucent matter under a smooth surface, by diffusion (BSSDF in the volumetric integrator).",
        {{"int_ior", "number, medium, material or spectrum", "", "1.5; a recipe's binder", "0.1 .. 10", "index inside"},
         {"ext_ior", "number, medium, material or spectrum", "", "air", "0.1 .. 10", "index on the side of the normal"},
         {"sigma_a", "spectrum", "1/scene unit", "0.1", ">= 0", "absorption"},
         {"sigma_s", "spectrum", "1/scene unit", "10", "> 0", "scattering"},
         {"g", "number", "", "0", "-1 .. 1", "mean cosine of the scattering angle"},
         {"scale", "number", "", "1", "> 0", "factor on the coefficients"},
         {"filename", "path", "", "", "", "a recipe (.toml) whose layer gives coefficients and index"},
         {"layer", "integer", "", "the topmost that scatters", ">= 0", "of the recipe, counted from the top"},
         {"scene_unit_um", "number", "um", "1", "> 0", "of a recipe: what a unit of length stands for"},
         {"specular_reflectance", "spectrum or texture", "", "1", "0 .. 1", "factor on the surface"}}};
}

Dipole Dipole::build(const Properties& node, const BsdfBuilder& builder) {
    Dipole d;
    const ReducedCoefficients coefficients = reduced_coefficients(node, *builder.resources, *builder.notes);
    d.absorption = coefficients.absorption;
    d.reduced_scattering = coefficients.scattering;
    d.interior_index = coefficients.index && !node.has("int_ior") ? *coefficients.index
                       : node.has("int_ior")                      ? real_index(node, "int_ior", "bk7", builder)
                                                                  : Spectrum(1.5f);
    d.exterior_index = real_index(node, "ext_ior", "air", builder);
    d.specular_reflectance = Texture::reflectance(node, "specular_reflectance", 1.0f, *builder.resources);
    d.returned_inside = diffuse_internal_reflectance(d.interior_index, d.exterior_index);
    const Spectrum total([&](double nm) { return d.profile(Wavelengths::all_at(static_cast<float>(nm))).total[0]; });
    d.diffuse_reflectance = Texture(total);
    d.diffuse_average = total.average();
    d.specular_average = d.specular_reflectance.average();
    return d;
}

}  // namespace patina::render
