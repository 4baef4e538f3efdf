#pragma once
// Generalized cosine lobes, `lafortune`: a Lambertian part and up to four lobes; depolarizing.
//
//   f = rho_d / pi + sum_j w_j (n_j + 2) / (2 pi) ((Cx ox ix + Cy oy iy + Cz oz iz) / C_j)_+^n_j,  C_j = max |C|
//
// Lafortune, Foo, Torrance & Greenberg (1997), Non-linear approximation of reflectance functions, eq. 6, each lobe
// normalized as Phong's: Cx = Cy = -Cz is Phong's lobe, Cx = Cy = Cz retroreflects, |Cz| smaller than |Cx| lifts the
// lobe off the horizon side ("off-specular"). Reciprocal; as (C o).i / C is at most the cosine about the axis C o,
// rho_d + sum w <= 1 keeps it from giving energy. The fit of a measured material with coefficients C of its own norm
// has w = (its factor) 2 pi C^n / (n + 2). Empirical: no polarization. Black from behind.

#include <array>

#include "patina/render/bsdf.h"
#include "patina/render/texture.h"

namespace patina::render {

struct Lafortune {
    static constexpr int most_lobes = 4;
    struct Lobe {
        Vec3 c;  // largest component of size 1
        float exponent = 1, share = 0;
        Texture weight;

        // Of weight 1, in 1/sr.
        float height(const Vec3& outgoing, const Vec3& incident) const;
    };
    Texture diffuse_reflectance;
    float diffuse_share = 1;
    std::vector<Lobe> lobes;

    bool is_delta(const ShadingPoint&) const { return false; }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const;
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const;

    static PluginDescriptor describe();
    static Lafortune build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
