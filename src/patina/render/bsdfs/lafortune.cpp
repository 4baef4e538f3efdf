#include "patina/render/bsdfs/lafortune.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/bsdfs/cosine_lobe.h"
#include "patina/render/sampling.h"

namespace patina::render {

bool Lafortune::sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2,
                       BsdfSample& sample) const {
    if (outgoing.z() <= 0) return false;
    // Choose the Lambertian part or a lobe.
    const Lobe* chosen = nullptr;
    u -= diffuse_share;
    for (const Lobe& lobe : lobes) {
        if (u < 0) break;
        if (lobe.share > 0) chosen = &lobe;
        u -= lobe.share;
    }
    const auto axis = [&](const Lobe& lobe) { return Vec3(lobe.c.cwiseProduct(outgoing).normalized()); };
    sample.incident = chosen ? sample_cosine_lobe(axis(*chosen), chosen->exponent, u2) : cosine_hemisphere(u2);
    BsdfValue value;
    if (!evaluate(point, outgoing, sample.incident, value) || !(value.pdf > 0)) return false;
    sample.pdf = value.pdf;
    sample.weight.set_depolarizing(value.f.m[0] / value.pdf);
    return true;
}

// The products in double precision, and of true unit vectors: a sharp lobe magnifies a rounding error by its exponent.
float Lafortune::Lobe::height(const Vec3& outgoing, const Vec3& incident) const {
    const Eigen::Vector3d o = outgoing.cast<double>(), i = incident.cast<double>();
    const double cos = o.cwiseProduct(i).dot(c.cast<double>()) / std::sqrt(o.squaredNorm() * i.squaredNorm());
    return cos > 0 ? static_cast<float>((exponent + 2) * 0.5 * inv_pi_f * std::pow(cos, exponent)) : 0.0f;
}

bool Lafortune::evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident,
                         BsdfValue& value) const {
    if (outgoing.z() <= 0 || incident.z() <= 0) return false;
    const Wavelengths& w = *point.wavelengths;
    Float4 f = diffuse_reflectance.at(w, point.uv) * inv_pi_f;
    value.pdf = diffuse_share * incident.z() * inv_pi_f;
    for (const Lobe& lobe : lobes) {
        const Vec3 axis = lobe.c.cwiseProduct(outgoing);
        const float length = axis.norm();
        if (!(length > 0)) continue;
        const float density = cosine_lobe_density(axis / length, lobe.exponent, incident);
        value.pdf += lobe.share * density;
        f += lobe.weight.at(w, point.uv) * lobe.height(outgoing, incident);
    }
    value.f.set_depolarizing(f * incident.z());
    return true;
}

PluginDescriptor Lafortune::describe() {
    PluginDescriptor d{"bsdf",
                       "lafortune",
                       "Generalized cosine lobes (empirical, depolarizing).",
                       {{"diffuse_reflectance", "spectrum or texture", "", "0.2", "0 .. 1", "Lambertian part"}}};
    for (int j = 1; j <= most_lobes; ++j) {
        d.parameters.push_back({fmt::format("lobe_{}", j), "vector", "", j == 1 ? "-1, -1, 0.95" : "", "not 0",
                                "coefficients Cx, Cy, Cz of the products of the directions' components"});
        d.parameters.push_back(
            {fmt::format("exponent_{}", j), "number", "", "20", "0 .. 1e6", "sharpness of the lobe"});
        d.parameters.push_back(
            {fmt::format("weight_{}", j), "spectrum or texture", "", "0.3", "0 .. 1", "share of light it reflects"});
    }
    return d;
}

namespace {

Lafortune::Lobe lobe_of(const Properties& node, int j, const BsdfBuilder& builder) {
    Lafortune::Lobe lobe;
    const std::string name = fmt::format("lobe_{}", j), exponent = fmt::format("exponent_{}", j);
    const Vec3 c = node.vector(name, Eigen::Vector3d(-1, -1, 0.95)).cast<float>();
    const float largest = c.cwiseAbs().maxCoeff();
    if (!c.allFinite() || !(largest > 0))
        throw input_error(node.location_of(name), "a lobe needs finite coefficients, not all 0");
    lobe.c = c / largest;
    lobe.exponent = static_cast<float>(node.number(exponent, 20.0));
    if (!(lobe.exponent >= 0 && lobe.exponent <= 1e6f))
        throw input_error(node.location_of(exponent), "exponent out of range", fmt::format("it is {}", lobe.exponent),
                          "keep it between 0 and 1e6");
    lobe.weight = Texture::reflectance(node, fmt::format("weight_{}", j), 0.3f, *builder.resources);
    return lobe;
}

}  // namespace

Lafortune Lafortune::build(const Properties& node, const BsdfBuilder& builder) {
    Lafortune model;
    model.diffuse_reflectance = Texture::reflectance(node, "diffuse_reflectance", 0.2f, *builder.resources);
    for (int j = 1; j <= most_lobes; ++j)
        if (j == 1 || node.has(fmt::format("lobe_{}", j))) model.lobes.push_back(lobe_of(node, j, builder));

    // Draw from the parts in proportion to what they may reflect.
    float total = model.diffuse_reflectance.average();
    for (const Lobe& lobe : model.lobes) total += lobe.weight.average();
    if (total > 1.001f)
        throw input_error(node.where, "the surface reflects more light than it gets",
                          fmt::format("reflectance and weights add up to {:.3g}", total),
                          "keep their sum at 1 or below");
    if (total > 0) {
        model.diffuse_share = model.diffuse_reflectance.average() / total;
        for (Lobe& lobe : model.lobes) lobe.share = lobe.weight.average() / total;
    }
    return model;
}

}  // namespace patina::render
