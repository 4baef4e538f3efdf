#include "patina/render/microfacet.h"

#include <fmt/format.h>

#include "patina/core/error.h"

namespace patina::render {

namespace {

// Below it a facet turns light by less than a float can tell from the mirror direction.
constexpr float smallest_alpha = 1e-4f;

// Solves F(x) = u F(cot theta) for F(x) = int_-inf^x (cos - t sin)_+ exp(-t^2)/sqrt(pi) dt, the distribution of the
// slopes seen under theta (Heitz & d'Eon 2014, eq. 9; Jakob 2014), by Newton steps kept inside a shrinking bracket.
float visible_slope(float cos_theta, float sin_theta, float u) {
    const double c = cos_theta, s = sin_theta;
    const double largest = s > 0.2 * c ? c / s : 5.0;
    const auto cdf = [&](double x) { return 0.5 * (c * (1 + std::erf(x)) + s * std::exp(-x * x) / std::sqrt(M_PI)); };
    const double target = u * cdf(largest);
    double low = -5.0, high = largest, x = std::min(0.0, 0.5 * (low + high));
    for (int i = 0; i < 24; ++i) {
        const double error = cdf(x) - target;
        if (std::abs(error) < 1e-9) break;
        (error > 0 ? high : low) = x;
        const double slope = (c - x * s) * std::exp(-x * x) / std::sqrt(M_PI);
        const double newton = x - error / slope;
        x = newton > low && newton < high ? newton : 0.5 * (low + high);
    }
    return static_cast<float>(x);
}

}  // namespace

Vec3 Microfacets::sample_beckmann(const Vec3& w, const Vec2& u) const {
    // Stretch to unit roughness.
    const Vec3 stretched = Vec3(w.x() * alpha_x, w.y() * alpha_y, w.z()).normalized();
    const float sin_theta = std::hypot(stretched.x(), stretched.y());
    const float cos_phi = sin_theta > 0 ? stretched.x() / sin_theta : 1.0f;
    const float sin_phi = sin_theta > 0 ? stretched.y() / sin_theta : 0.0f;

    // Draw the slopes along and across the view, rotate and unstretch them.
    const float along = visible_slope(stretched.z(), sin_theta, u.x());
    const float across = visible_slope(1, 0, u.y());
    const float slope_x = cos_phi * along - sin_phi * across, slope_y = sin_phi * along + cos_phi * across;
    return Vec3(-slope_x * alpha_x, -slope_y * alpha_y, 1).normalized();
}

std::vector<ParameterDescriptor> microfacet_parameters() {
    return {{"distribution", "string", "", "beckmann", "ggx, beckmann", "distribution of facet normals"},
            {"alpha", "number or texture", "", "0.1", "0.0001 .. 2", "roughness"},
            {"alpha_u", "number or texture", "", "alpha", "0.0001 .. 2", "roughness along the tangent"},
            {"alpha_v", "number or texture", "", "alpha", "0.0001 .. 2", "roughness across the tangent"},
            {"sample_visible", "boolean", "", "true", "", "accepted: visible normals are always sampled"}};
}

MicrofacetField::MicrofacetField(MicrofacetKind kind, ScalarTexture alpha_u, ScalarTexture alpha_v) {
    base_.kind = kind;
    base_.alpha_x = alpha_u.values().front();
    base_.alpha_y = alpha_v.values().front();
    if (!alpha_u.varies() && !alpha_v.varies()) return;
    alpha_ = std::make_shared<const std::array<ScalarTexture, 2>>(std::array{std::move(alpha_u), std::move(alpha_v)});
}

Microfacets MicrofacetField::varied(const SurfaceUv& uv) const {
    return {base_.kind, std::max((*alpha_)[0].at(uv), smallest_alpha), std::max((*alpha_)[1].at(uv), smallest_alpha)};
}

MicrofacetField microfacets_of(const Properties& node, const SceneResources& resources) {
    const std::string kind = node.string("distribution", "beckmann");
    if (kind != "ggx" && kind != "beckmann")
        throw input_error(node.location_of("distribution"), fmt::format("unknown microfacet distribution \"{}\"", kind),
                          "", did_you_mean(kind, {"ggx", "beckmann"}));
    const ScalarTexture both = ScalarTexture::read(node, "alpha", 0.1, resources);
    const auto alpha = [&](const char* name) {
        const bool given = node.has(name);
        ScalarTexture texture = given ? ScalarTexture::read(node, name, 0.1, resources) : both;
        for (float value : texture.values())
            if (!(value >= smallest_alpha || texture.varies()) || !(value <= 2.0f))
                throw input_error(node.location_of(given ? name : "alpha"), "roughness out of range",
                                  fmt::format("it is {}", value),
                                  "keep it between 0.0001 and 2, or use the smooth model");
        return texture;
    };
    node.boolean("sample_visible", true);
    return {kind == "ggx" ? MicrofacetKind::ggx : MicrofacetKind::beckmann, alpha("alpha_u"), alpha("alpha_v")};
}

}  // namespace patina::render
