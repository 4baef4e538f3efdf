#pragma once
// Distributions of microfacet normals: GGX and Beckmann, anisotropic, with Smith's separable-height masking.
//
// D is normalized so that int D(m) cos(m) dm = 1; visible normals are sampled. Walter et al. (2007), Microfacet models
// for refraction; Heitz (2014), Understanding the masking-shadowing function; Heitz (2018), Sampling the GGX
// distribution of visible normals. All directions are local, z is the macroscopic normal.

#include <array>
#include <memory>
#include <vector>

#include "patina/core/properties.h"
#include "patina/render/render.h"
#include "patina/render/texture.h"
#include "patina/render/vec.h"

namespace patina::render {

enum class MicrofacetKind { ggx, beckmann };

struct Microfacets {
    MicrofacetKind kind = MicrofacetKind::ggx;
    float alpha_x = 0.1f, alpha_y = 0.1f;

    float density(const Vec3& m) const {
        if (m.z() <= 0) return 0;
        const float cos2 = m.z() * m.z();
        const float slope2 =
            (sqr(m.x() / alpha_x) + sqr(m.y() / alpha_y)) / cos2;  // squared slope over squared roughness
        const float norm = pi_f * alpha_x * alpha_y * cos2 * cos2;
        return kind == MicrofacetKind::ggx ? 1 / (norm * sqr(1 + slope2)) : std::exp(-slope2) / norm;
    }

    // Smith's auxiliary function Lambda; masking is 1 / (1 + Lambda). Beckmann's is exact (Heitz 2014, eq. 66).
    float lambda(const Vec3& w) const {
        const float cos2 = w.z() * w.z();
        if (cos2 <= 0) return INFINITY;
        const float tan2 = (sqr(alpha_x * w.x()) + sqr(alpha_y * w.y())) / cos2;
        if (kind == MicrofacetKind::ggx) return 0.5f * (std::sqrt(1 + tan2) - 1);
        if (tan2 < 1e-12f) return 0;
        const float a = 1 / std::sqrt(tan2);
        return std::max(0.0f, 0.5f * (std::erf(a) - 1 + std::exp(-a * a) / (a * std::sqrt(pi_f))));
    }

    // Height-correlated shadowing and masking (Heitz 2014, eq. 99) for directions on the same side of m as of the
    // surface.
    float shadowing(const Vec3& a, const Vec3& b) const { return 1 / (1 + lambda(a) + lambda(b)); }

    // Density of sample(w, .) at m.
    float visible_density(const Vec3& w, const Vec3& m) const {
        return density(m) * std::max(0.0f, w.dot(m)) / ((1 + lambda(w)) * w.z());
    }

    // A microfacet normal visible from w, w.z > 0.
    Vec3 sample(const Vec3& w, const Vec2& u) const {
        return kind == MicrofacetKind::ggx ? sample_ggx(w, u) : sample_beckmann(w, u);
    }

  private:
    // Spherical caps: Dupuy & Benyoub (2023), Sampling visible GGX normals with spherical caps, listing 3.
    Vec3 sample_ggx(const Vec3& w, const Vec2& u) const {
        const Vec3 stretched = Vec3(w.x() * alpha_x, w.y() * alpha_y, w.z()).normalized();
        const float phi = 2 * pi_f * u.x();
        const float z = (1 - u.y()) * (1 + stretched.z()) - stretched.z();
        const float sin_theta = safe_sqrt(1 - z * z);
        const Vec3 half = Vec3(sin_theta * std::cos(phi), sin_theta * std::sin(phi), z) + stretched;
        return Vec3(half.x() * alpha_x, half.y() * alpha_y, std::max(half.z(), 1e-7f)).normalized();
    }
    Vec3 sample_beckmann(const Vec3& w, const Vec2& u) const;
};

// Microfacets whose roughness may vary over the surface.
class MicrofacetField {
  public:
    MicrofacetField() = default;
    MicrofacetField(const Microfacets& everywhere) : base_(everywhere) {}
    MicrofacetField(MicrofacetKind kind, ScalarTexture alpha_u, ScalarTexture alpha_v);

    Microfacets at(const SurfaceUv& uv) const { return alpha_ ? varied(uv) : base_; }

  private:
    Microfacets varied(const SurfaceUv& uv) const;

    Microfacets base_;
    std::shared_ptr<const std::array<ScalarTexture, 2>> alpha_;  // null: the same everywhere
};

// The microfacets of a plugin's `distribution` and `alpha` (or `alpha_u` and `alpha_v`), with Mitsuba's defaults; and
// what they are called in its manual. Throws Error(input) for roughness outside 0.0001 .. 2; what a picture has below
// is held there, as Mitsuba does.
MicrofacetField microfacets_of(const Properties& node, const SceneResources& resources);
std::vector<ParameterDescriptor> microfacet_parameters();

}  // namespace patina::render
