#include "patina/render/bsdfs/thin_dielectric.h"

#include "patina/render/fresnel_packet.h"
#include "patina/render/indices.h"

namespace patina::render {

namespace {

struct Pane {
    FresnelPacket reflection, transmission;
};

Pane pane_of(float cos_o, Float4 eta) {
    const FresnelInterface face = fresnel_dielectric(cos_o, eta);
    const FresnelPacket r = face.reflection, t = face.transmission;
    const Float4 zero = splat(0);
    // A lane without transmission has R = 1: nothing enters, and 0/0 must not.
    const auto inside = [&](Float4 transmitted, Float4 reflected) {
        return select(transmitted > zero, transmitted * transmitted / (1 - reflected * reflected), zero);
    };
    const Float4 rs = r.a + r.b, rp = r.a - r.b;
    const Float4 ts = inside(t.a + t.b, rs), tp = inside(t.a - t.b, rp), c = inside(t.c, r.c);
    const Float4 rs_all = rs * (1 + ts), rp_all = rp * (1 + tp);
    Pane p;
    p.reflection = {0.5f * (rs_all + rp_all), 0.5f * (rs_all - rp_all), r.c * (1 + c), r.d};
    p.transmission = {0.5f * (ts + tp), 0.5f * (ts - tp), c, zero};
    return p;
}

}  // namespace

bool ThinDielectric::sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2&,
                            BsdfSample& sample) const {
    if (outgoing.z() == 0) return false;
    const Wavelengths& w = *point.wavelengths;
    const Pane pane = pane_of(std::abs(outgoing.z()), interior_index.at(w) / exterior_index.at(w));
    const float chance = point.chance_of_reflection(mean(pane.reflection.a));
    const bool reflected = u < chance;
    const FresnelPacket& f = reflected ? pane.reflection : pane.transmission;
    sample.incident = reflected ? Vec3(-outgoing.x(), -outgoing.y(), outgoing.z()) : Vec3(-outgoing);
    sample.pdf = reflected ? chance : 1 - chance;
    sample.delta = true;
    if (!(sample.pdf > 0)) return false;
    const Texture& factor = reflected ? specular_reflectance : specular_transmittance;
    const Float4 scale = factor.at(w, point.uv) / sample.pdf;
    const Vec3 axis = perpendicular_to_normal(outgoing);
    sample.weight.set_fresnel(f.a * scale, f.b * scale, f.c * scale, f.d * scale, axis, axis);
    return true;
}

PluginDescriptor ThinDielectric::describe() {
    return {"bsdf",
            "thindielectric",
            "Thin pane with both its faces, polarized.",
            {{"int_ior", "number, medium, material or spectrum", "", "bk7", "0.1 .. 10", "index of the pane"},
             {"ext_ior", "number, medium, material or spectrum", "", "air", "0.1 .. 10", "index on both its sides"},
             {"specular_reflectance", "spectrum or texture", "", "1", "0 .. 1", "factor on reflection (not physical)"},
             {"specular_transmittance", "spectrum or texture", "", "1", "0 .. 1",
              "factor on transmission (not physical)"}}};
}

ThinDielectric ThinDielectric::build(const Properties& node, const BsdfBuilder& builder) {
    return {real_index(node, "int_ior", "bk7", builder), real_index(node, "ext_ior", "air", builder),
            Texture::reflectance(node, "specular_reflectance", 1.0f, *builder.resources),
            Texture::reflectance(node, "specular_transmittance", 1.0f, *builder.resources)};
}

}  // namespace patina::render
