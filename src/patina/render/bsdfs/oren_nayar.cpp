#include "patina/render/bsdfs/oren_nayar.h"

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/render/sampling.h"

namespace patina::render {

bool OrenNayar::sample(const ShadingPoint& point, const Vec3& outgoing, float, const Vec2& u2,
                       BsdfSample& sample) const {
    if (outgoing.z() <= 0) return false;
    sample.incident = cosine_hemisphere(u2);
    BsdfValue value;
    if (!evaluate(point, outgoing, sample.incident, value) || !(value.pdf > 0)) return false;
    sample.pdf = value.pdf;
    sample.weight.set_depolarizing(value.f.m[0] / value.pdf);
    return true;
}

bool OrenNayar::evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident,
                         BsdfValue& value) const {
    if (outgoing.z() <= 0 || incident.z() <= 0) return false;
    // Angles of the two directions and between their azimuths.
    const float theta_o = std::acos(std::min(outgoing.z(), 1.0f)), theta_i = std::acos(std::min(incident.z(), 1.0f));
    const float alpha = std::max(theta_o, theta_i), beta = std::min(theta_o, theta_i);
    const float sin_sin = std::hypot(outgoing.x(), outgoing.y()) * std::hypot(incident.x(), incident.y());
    const float dot = outgoing.x() * incident.x() + outgoing.y() * incident.y();
    const float cos_phi = sin_sin > 1e-12f ? std::clamp(dot / sin_sin, -1.0f, 1.0f) : 0.0f;

    // The fit's coefficients.
    const float ratio = sigma2 / (sigma2 + 0.09f), b = 2 * beta * inv_pi_f;
    const float c1 = 1 - 0.5f * sigma2 / (sigma2 + 0.33f);
    const float c2 = 0.45f * ratio * (std::sin(alpha) - (cos_phi >= 0 ? 0.0f : b * b * b));
    const float c3 = 0.125f * ratio * sqr(4 * alpha * beta * sqr(inv_pi_f));
    const float once = c1 + cos_phi * c2 * std::tan(beta) + (1 - std::abs(cos_phi)) * c3 * std::tan((alpha + beta) / 2);
    const float twice = 0.17f * sigma2 / (sigma2 + 0.13f) * (1 - cos_phi * b * b);

    const Float4 rho = reflectance.at(*point.wavelengths, point.uv);
    value.pdf = incident.z() * inv_pi_f;
    value.f.set_depolarizing(max(rho * (once + rho * twice), splat(0)) * value.pdf);
    return true;
}

PluginDescriptor OrenNayar::describe() {
    return {"bsdf",
            "orennayar",
            "Rough Lambertian surface (depolarizing).",
            {{"reflectance", "spectrum or texture", "", "0.5", "0 .. 1", "of the facets"},
             {"sigma", "number", "degree", "20", "0 .. 60", "standard deviation of the facets' slope angle"}}};
}

OrenNayar OrenNayar::build(const Properties& node, const BsdfBuilder& builder) {
    OrenNayar o;
    o.reflectance = Texture::reflectance(node, "reflectance", 0.5f, *builder.resources);
    const double sigma_deg = node.number("sigma", 20.0);
    if (!(sigma_deg >= 0 && sigma_deg <= 60))
        throw input_error(node.location_of("sigma"), "slope angle out of range", fmt::format("it is {}", sigma_deg),
                          "keep it between 0 and 60 degrees");
    o.sigma2 = static_cast<float>(std::pow(radians(sigma_deg), 2));
    return o;
}

}  // namespace patina::render
