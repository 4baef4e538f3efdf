#include "patina/render/bsdfs/principled.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/bsdfs/matrix_sum.h"
#include "patina/render/fresnel_packet.h"
#include "patina/render/sampling.h"

namespace patina::render {

namespace {

float schlick_weight(float cos) {
    const float m = std::clamp(1 - cos, 0.0f, 1.0f);
    return sqr(sqr(m)) * m;
}
Float4 schlick(Float4 at_normal, float cos) {
    return at_normal + (1 - at_normal) * schlick_weight(cos);
}

// The clearcoat's facets: Burley (2012), GTR of exponent 1, eq. 9.
struct LongTails {
    float alpha2;

    explicit LongTails(float gloss) : alpha2(sqr(0.1f + (0.001f - 0.1f) * gloss)) {}
    float density(float cos_m) const {
        return (alpha2 - 1) / (pi_f * std::log(alpha2) * (1 + (alpha2 - 1) * sqr(cos_m)));
    }
    // Normals of the density times their cosine (his appendix B.2).
    Vec3 sample(const Vec2& u) const {
        const float cos2 = (1 - std::pow(alpha2, 1 - u.x())) / (1 - alpha2), sin = safe_sqrt(1 - cos2);
        const float phi = 2 * pi_f * u.y();
        return {sin * std::cos(phi), sin * std::sin(phi), safe_sqrt(cos2)};
    }
};
constexpr Microfacets clearcoat_masking{MicrofacetKind::ggx, 0.25f, 0.25f};

// The mirror image in the surface: facet statistics are the same from both sides.
Vec3 to_upper(const Vec3& v, bool upper) {
    return upper ? v : Vec3(v.x(), v.y(), -v.z());
}

}  // namespace

Principled::Shares Principled::shares(const SurfaceUv& uv) const {
    const float coat = 0.25f * clearcoat.at(uv), diffuse = (1 - metallic.at(uv)) * (1 - spec_trans.at(uv));
    const float all = 1 + coat + diffuse;
    return {1 / all, coat / all};
}

Microfacets Principled::facets(const SurfaceUv& uv) const {
    const float alpha = sqr(roughness.at(uv)), aspect = std::sqrt(1 - 0.9f * anisotropic.at(uv));
    return {MicrofacetKind::ggx, std::max(0.001f, alpha / aspect), std::max(0.001f, alpha * aspect)};
}

// The base colour at luminance 1. Luminance is the mean over quantiles of the eye's sensitivity at 1/8, 3/8, 5/8, 7/8.
Float4 Principled::hue(const ShadingPoint& point, Float4 base) const {
    static const Wavelengths quantiles{Float4{515, 545, 572, 607}, {135, 165, 192, 227}, splat(0)};
    const float luminance = mean(base_color.at(quantiles, point.uv));
    return luminance > 0 ? base / luminance : splat(1);
}

// Diffuse light and sheen, without the cosine.
Float4 Principled::body(const ShadingPoint& point, Float4 base, float cos_o, float cos_i, float cos_m) const {
    const float dielectric = 1 - metallic.at(point.uv);
    const float w_o = schlick_weight(cos_o), w_i = schlick_weight(cos_i);
    const float retro = 2 * roughness.at(point.uv) * sqr(cos_m);
    float shape = (1 - 0.5f * w_o) * (1 - 0.5f * w_i) + retro * (w_o + w_i + w_o * w_i * (retro - 1));
    if (const float flat = flatness.at(point.uv); flat > 0) {
        const float grazing = (1 + w_o * (0.5f * retro - 1)) * (1 + w_i * (0.5f * retro - 1));
        shape += flat * (1.25f * (grazing * (1 / (cos_o + cos_i) - 0.5f) + 0.5f) - shape);
    }
    Float4 f = base * (dielectric * (1 - spec_trans.at(point.uv)) * shape * inv_pi_f);
    if (const float rate = sheen.at(point.uv); rate > 0) {
        const float tint = sheen_tint.at(point.uv);
        const Float4 colour = tint > 0 ? 1 + tint * (hue(point, base) - 1) : splat(1);
        f += colour * (rate * dielectric * schlick_weight(cos_m));
    }
    return f;
}

bool Principled::sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2,
                        BsdfSample& sample) const {
    const bool above = outgoing.z() > 0;
    const float through = glass(point.uv);
    if (outgoing.z() == 0 || (!above && through <= 0)) return false;
    const Vec3 o = to_upper(outgoing, above);
    const Shares share = above ? shares(point.uv) : Shares{1, 0};
    sample.eta = 1;
    if (u < share.specular) {
        // A visible facet refracts with the probability that it does, as far as it is glass.
        const Vec3 m = facets(point.uv).sample(o, u2);
        const float cos_m = o.dot(m), relative = above ? eta : 1 / eta;
        if (cos_m <= 0) return false;
        const FresnelInterface f = fresnel_dielectric(std::min(cos_m, 1.0f), splat(relative));
        Vec3 i = 2 * cos_m * m - o;
        if (u / share.specular < (above ? through : 1.0f) * f.transmission.a[0]) {
            i = ((cos_m / relative - f.cos_t[0]) * m - o / relative).normalized();
            if (i.z() >= 0) return false;
            sample.eta = relative;
        } else if (i.z() <= 0) {
            return false;
        }
        sample.incident = to_upper(i, above);
    } else if (u < share.specular + share.clearcoat) {
        const Vec3 m = LongTails(clearcoat_gloss.at(point.uv)).sample(u2);
        sample.incident = 2 * outgoing.dot(m) * m - outgoing;
        if (sample.incident.z() <= 0) return false;
    } else {
        sample.incident = cosine_hemisphere(u2);
    }
    sample.delta = false;
    return weigh_by_all_lobes(*this, point, outgoing, sample);
}

bool Principled::evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident,
                          BsdfValue& value) const {
    const bool above = outgoing.z() > 0;
    if (above && incident.z() > 0) return reflect(point, outgoing, incident, value);
    if (outgoing.z() == 0 || incident.z() == 0 || !(glass(point.uv) > 0)) return false;
    const Vec3 o = to_upper(outgoing, above), i = to_upper(incident, above);
    const Vec3 axis = common_perpendicular(outgoing, incident);
    return i.z() > 0 ? reflect_inside(point, o, i, axis, value)
                     : refract(point, o, i, above ? eta : 1 / eta, above, axis, value);
}

bool Principled::reflect_inside(const ShadingPoint& point, const Vec3& o, const Vec3& i, const Vec3& axis,
                                BsdfValue& value) const {
    const Microfacets facet = facets(point.uv);
    const Vec3 m = (o + i).normalized();
    const float visible = facet.density(m) / ((1 + facet.lambda(o)) * 4 * o.z());
    const FresnelPacket f = fresnel_dielectric(std::min(o.dot(m), 1.0f), splat(1 / eta)).reflection;
    const float scale = glass(point.uv) * visible / (1 + facet.lambda(i));
    value.f.set_fresnel(f.a * scale, f.b * scale, f.c * scale, f.d * scale, axis, axis);
    value.pdf = visible * f.a[0];
    return value.pdf > 0;
}

// As RoughDielectric::transmit, for one index.
bool Principled::refract(const ShadingPoint& point, const Vec3& o, const Vec3& i, float relative, bool above,
                         const Vec3& axis, BsdfValue& value) const {
    const Microfacets facet = facets(point.uv);
    Vec3 m = o + relative * i;
    const float length = m.norm();
    if (length < 1e-7f) return false;
    m *= (m.z() > 0 ? 1 : -1) / length;
    const float om = o.dot(m), im = i.dot(m);
    if (om <= 0 || im >= 0) return false;
    const FresnelPacket f = fresnel_dielectric(std::min(om, 1.0f), splat(relative)).transmission;
    const float stretch = -im / sqr(om + relative * im);
    const float visible = facet.density(m) * om * stretch / (o.z() * (1 + facet.lambda(o)));
    const float through = glass(point.uv);
    const Float4 tint = sqrt(base_color.at(*point.wavelengths, point.uv));
    const Float4 scale = tint * (through * visible / (1 + facet.lambda(-i)));
    value.f.set_fresnel(f.a * scale, f.b * scale, f.c * scale, splat(0), axis, axis);
    value.pdf = visible * sqr(relative) * f.a[0] * (above ? shares(point.uv).specular * through : 1.0f);
    return value.pdf > 0;
}

// From the front to the front.
bool Principled::reflect(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident,
                         BsdfValue& value) const {
    const float cos_o = outgoing.z(), cos_i = incident.z();
    const SurfaceUv& uv = point.uv;
    const Float4 base = base_color.at(*point.wavelengths, uv);
    const Vec3 m = (outgoing + incident).normalized();
    const float cos_m = std::clamp(outgoing.dot(m), 1e-6f, 1.0f);

    // Facets: what of them is a dielectric polarizes.
    const Microfacets specular = facets(uv);
    const float lambda_o = specular.lambda(outgoing), lambda_i = specular.lambda(incident);
    const float visible = specular.density(m) / (4 * cos_o * (1 + lambda_o)), lobe = visible / (1 + lambda_i);
    const float metal = metallic.at(uv), tint = spec_tint.at(uv);
    const FresnelPacket fresnel = fresnel_dielectric(cos_m, splat(eta)).reflection;
    const float clear = lobe * (1 - metal) * (1 - tint);
    const Vec3 axis = common_perpendicular(outgoing, incident);
    value.f.set_fresnel(fresnel.a * clear, fresnel.b * clear, fresnel.c * clear, fresnel.d * clear, axis, axis);

    // The rest depolarizes.
    Float4 rest = body(point, base, cos_o, cos_i, cos_m) * cos_i;
    if (metal > 0) rest += schlick(base, cos_m) * (lobe * metal);
    if (tint > 0) rest += schlick(hue(point, base) * sqr((eta - 1) / (eta + 1)), cos_m) * (lobe * (1 - metal) * tint);
    const LongTails tails(clearcoat_gloss.at(uv));
    const float coat = clearcoat.at(uv), coat_density = tails.density(m.z());
    if (coat > 0) {
        const float masking = 1 / ((1 + clearcoat_masking.lambda(outgoing)) * (1 + clearcoat_masking.lambda(incident)));
        rest += schlick(splat(0.04f), cos_m) * (0.25f * coat * coat_density * masking * cos_i);
    }
    ScatteringMatrix depolarizing;
    depolarizing.set_depolarizing(rest);
    add_to(value.f, depolarizing, outgoing, incident);

    const Shares share = shares(uv);
    // What glass refracts is not reflected.
    const float reflecting = 1 - glass(uv) * (1 - fresnel.a[0]);
    value.pdf = share.specular * reflecting * visible + share.clearcoat * coat_density * m.z() / (4 * cos_m) +
                (1 - share.specular - share.clearcoat) * cos_i * inv_pi_f;
    return true;
}

PluginDescriptor Principled::describe() {
    PluginDescriptor d{"bsdf",
                       "principled",
                       "Disney's artists' model (Burley); its dielectric surface polarizes.",
                       {{"base_color", "spectrum or texture", "", "0.5", "0 .. 1", "of the body, or of the metal"}}};
    const auto number = [&](const char* name, const char* fallback, const char* doc) {
        d.parameters.push_back({name, "number or texture", "", fallback, "0 .. 1", doc});
    };
    number("roughness", "0.5", "its square is the alpha of the facets");
    number("anisotropic", "0", "facets rougher along the tangent");
    number("metallic", "0", "share of metal");
    number("spec_trans", "0", "share of glass in what is no metal");
    number("spec_tint", "0", "share of the surface's reflection that takes the hue of base_color");
    number("sheen", "0", "light at grazing angles, as on cloth");
    number("sheen_tint", "0", "share of it that takes the hue of base_color");
    number("flatness", "0", "share of a body as flat as if light went through it");
    number("clearcoat", "0", "second, colourless reflection");
    number("clearcoat_gloss", "0", "its sharpness");
    d.parameters.push_back({"specular", "number", "", "0.5", "0 .. 1", "sets the index: 0.5 is 1.5"});
    d.parameters.push_back({"eta", "number", "", "", "1 .. 5", "index, instead of specular"});
    for (const char* name :
         {"diffuse_reflectance_sampling_rate", "main_specular_sampling_rate", "clearcoat_sampling_rate"})
        d.parameters.push_back({name, "number", "", "1", "", "accepted, without effect"});
    return d;
}

Principled Principled::build(const Properties& node, const BsdfBuilder& builder) {
    const auto range = [&](const char* name, double value, double low, double high) {
        if (value >= low && value <= high) return static_cast<float>(value);
        throw input_error(node.location_of(name), fmt::format("{} out of range", name), fmt::format("it is {}", value),
                          fmt::format("keep it between {} and {}", low, high));
    };
    const auto share = [&](const char* name, double fallback) {
        ScalarTexture texture = ScalarTexture::read(node, name, fallback, *builder.resources);
        for (float value : texture.values()) range(name, value, 0, 1);
        return texture;
    };
    Principled p;
    p.base_color = Texture::reflectance(node, "base_color", 0.5f, *builder.resources);
    p.roughness = share("roughness", 0.5);
    p.anisotropic = share("anisotropic", 0);
    p.metallic = share("metallic", 0);
    p.spec_tint = share("spec_tint", 0);
    p.sheen = share("sheen", 0);
    p.sheen_tint = share("sheen_tint", 0);
    p.flatness = share("flatness", 0);
    p.clearcoat = share("clearcoat", 0);
    p.clearcoat_gloss = share("clearcoat_gloss", 0);
    if (node.has("eta") && node.has("specular"))
        throw input_error(node.location_of("eta"), "\"eta\" and \"specular\" both give the index", "", "give one");
    // Normal reflectance is 0.08 specular.
    const double specular = range("specular", node.number("specular", 0.5), 0, 1);
    p.eta = range("eta", node.number("eta", 2 / (1 - std::sqrt(0.08 * specular)) - 1), 1, 5);
    p.spec_trans = share("spec_trans", 0);
    // Glass of index 1 has no facets to refract at.
    if (node.has("spec_trans")) p.eta = std::max(p.eta, 1.001f);
    for (const char* name :
         {"diffuse_reflectance_sampling_rate", "main_specular_sampling_rate", "clearcoat_sampling_rate"})
        node.number(name, 1.0);
    return p;
}

}  // namespace patina::render
