#include "patina/render/bsdfs/rough_dielectric.h"

#include "patina/render/fresnel_packet.h"
#include "patina/render/indices.h"

namespace patina::render {

namespace {

// The mirror image in the surface: facet statistics are the same from both sides.
Vec3 to_upper(const Vec3& v, bool upper) {
    return upper ? v : Vec3(v.x(), v.y(), -v.z());
}

}  // namespace

Float4 RoughDielectric::relative_index(const ShadingPoint& point, bool from_outside) const {
    const Float4 inside = interior_index.at(*point.wavelengths), outside = exterior_index.at(*point.wavelengths);
    return from_outside ? inside / outside : outside / inside;
}

bool RoughDielectric::sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2,
                             BsdfSample& sample) const {
    if (outgoing.z() == 0) return false;
    const bool above = outgoing.z() > 0;
    const Vec3 o = to_upper(outgoing, above);
    const Float4 eta4 = relative_index(point, above);

    // Choose a wavelength whose refraction is followed.
    float eta = eta4[0];
    if (dispersive) {
        const int lane = std::min(static_cast<int>(4 * u), 3);
        eta = eta4[lane];
        u = 4 * u - lane;
    }

    // Reflect or refract at a visible facet, by its Fresnel reflectance.
    const Vec3 m = roughness.at(point.uv).sample(o, u2);
    const float cos_m = o.dot(m);
    if (cos_m <= 0) return false;
    const FresnelInterface f = fresnel_dielectric(std::min(cos_m, 1.0f), splat(eta));
    Vec3 i;
    if (u < f.reflection.a[0]) {
        i = 2 * cos_m * m - o;
        if (i.z() <= 0) return false;
        sample.eta = 1;
    } else {
        i = ((cos_m / eta - f.cos_t[0]) * m - o / eta).normalized();
        if (i.z() >= 0) return false;
        sample.eta = eta4[0];
    }
    sample.incident = to_upper(i, above);
    sample.delta = false;
    return weigh_by_all_lobes(*this, point, outgoing, sample);
}

bool RoughDielectric::evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident,
                               BsdfValue& value) const {
    if (outgoing.z() == 0 || incident.z() == 0) return false;
    const bool above = outgoing.z() > 0;
    const Vec3 o = to_upper(outgoing, above), i = to_upper(incident, above);
    const Vec3 axis = common_perpendicular(outgoing, incident);
    const Float4 eta = relative_index(point, above);
    return i.z() > 0 ? reflect(point, o, i, eta, axis, value) : transmit(point, o, i, eta, axis, value);
}

bool RoughDielectric::reflect(const ShadingPoint& point, const Vec3& o, const Vec3& i, Float4 eta, const Vec3& axis,
                              BsdfValue& value) const {
    const Microfacets facets = roughness.at(point.uv);
    const Vec3 m = (o + i).normalized();
    const float visible = facets.density(m) / ((1 + facets.lambda(o)) * 4 * o.z());
    if (!dispersive) eta = splat(eta[0]);
    const FresnelPacket f = fresnel_dielectric(std::min(o.dot(m), 1.0f), eta).reflection;
    value.pdf = visible * mean(f.a);
    const Float4 scale = specular_reflectance.at(*point.wavelengths, point.uv) * (visible / (1 + facets.lambda(i)));
    value.f.set_fresnel(f.a * scale, f.b * scale, f.c * scale, f.d * scale, axis, axis);
    return value.pdf > 0;
}

bool RoughDielectric::transmit(const ShadingPoint& point, const Vec3& o, const Vec3& i, Float4 eta, const Vec3& axis,
                               BsdfValue& value) const {
    Float4 a = splat(0), b = a, c = a, pdf = a;
    const Microfacets facets = roughness.at(point.uv);
    const float shadowing_o = 1 / (1 + facets.lambda(o)), shadowing_i = 1 / (1 + facets.lambda(-i));
    for (int lane = 0; lane < (dispersive ? wavelengths_per_path : 1); ++lane) {
        // The facet that refracts i to o: it looks to the rarer side.
        Vec3 m = o + eta[lane] * i;
        const float length = m.norm();
        if (length < 1e-7f) continue;
        m *= (m.z() > 0 ? 1 : -1) / length;
        const float om = o.dot(m), im = i.dot(m);
        if (om <= 0 || im >= 0) continue;
        const FresnelPacket f = fresnel_dielectric(std::min(om, 1.0f), splat(eta[lane])).transmission;

        // Density of facets, changed to one of directions; seen from o only for what is drawn.
        const float stretch = -im / sqr(om + eta[lane] * im);
        const float visible = facets.density(m) * shadowing_o * om * stretch / o.z();
        const float scale = visible * shadowing_i;
        a[lane] = f.a[0] * scale, b[lane] = f.b[0] * scale, c[lane] = f.c[0] * scale;
        pdf[lane] = visible * sqr(eta[lane]) * f.a[0];
    }
    value.pdf = dispersive ? mean(pdf) : pdf[0];
    const Float4 t = specular_transmittance.at(*point.wavelengths, point.uv);
    if (!dispersive) a = splat(a[0]), b = splat(b[0]), c = splat(c[0]);
    value.f.set_fresnel(a * t, b * t, c * t, splat(0), axis, axis);
    return value.pdf > 0;
}

PluginDescriptor RoughDielectric::describe() {
    PluginDescriptor d{
        "bsdf",
        "roughdielectric",
        "Rough interface between two transparent media; polarizes, disperses when an index names a material.",
        {{"int_ior", "number, medium, material or spectrum", "", "bk7", "0.1 .. 10",
          "index on the side the normal leaves"},
         {"ext_ior", "number, medium, material or spectrum", "", "air", "0.1 .. 10", "index on the side of the normal"},
         {"specular_reflectance", "spectrum or texture", "", "1", "0 .. 1", "factor on reflection (not physical)"},
         {"specular_transmittance", "spectrum or texture", "", "1", "0 .. 1", "factor on refraction (not physical)"}}};
    for (ParameterDescriptor& p : microfacet_parameters()) d.parameters.push_back(std::move(p));
    return d;
}

RoughDielectric RoughDielectric::build(const Properties& node, const BsdfBuilder& builder) {
    RoughDielectric d;
    d.interior_index = real_index(node, "int_ior", "bk7", builder);
    d.exterior_index = real_index(node, "ext_ior", "air", builder);
    d.roughness = microfacets_of(node, *builder.resources);
    d.specular_reflectance = Texture::reflectance(node, "specular_reflectance", 1.0f, *builder.resources);
    d.specular_transmittance = Texture::reflectance(node, "specular_transmittance", 1.0f, *builder.resources);
    d.dispersive = !d.interior_index.is_uniform() || !d.exterior_index.is_uniform();
    return d;
}

}  // namespace patina::render
