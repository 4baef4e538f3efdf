// Intensities of the polarized models against the scalar formulas of their papers, written out here a second time in
// double precision, and what holds between the two sides of an interface.

#include <gtest/gtest.h>

#include "patina/render/bsdf_set.h"
#include "patina/render/test_support.h"

namespace patina::render::test {
namespace {

using Eigen::Vector3d;

// Walter et al. (2007), eq. 22.
double fresnel(double c, double eta) {
    const double g2 = eta * eta - 1 + c * c;
    if (g2 <= 0) return 1;
    const double g = std::sqrt(g2);
    return 0.5 * std::pow((g - c) / (g + c), 2) * (1 + std::pow((c * (g + c) - 1) / (c * (g - c) + 1), 2));
}
// Eqs. 33 and 34: GGX.
double ggx(double cos_m, double alpha) {
    const double tan2 = 1 / (cos_m * cos_m) - 1;
    return alpha * alpha / (pi * std::pow(cos_m, 4) * std::pow(alpha * alpha + tan2, 2));
}
double masking(double cos_v, double alpha) {
    return 2 / (1 + std::sqrt(1 + alpha * alpha * (1 / (cos_v * cos_v) - 1)));
}

class BsdfFormula : public testing::Test {
  protected:
    const Bsdf& make(const std::string& name, std::vector<Value> values) {
        builder_.resources = &resources_;
        builder_.notes = &notes_;
        set_ = {build_bsdf(*node("bsdf", name, std::move(values)), builder_)};
        point_ = {&wavelengths_, Vec2::Zero(), set_.data()};
        return set_[0];
    }
    // f00, without the cosine.
    double intensity(const Bsdf& bsdf, const Vec3& o, const Vec3& i) {
        BsdfValue value;
        if (!bsdf_evaluate(bsdf, point_, o, i, value)) return 0;
        return value.f.matrix(1)(0, 0) / std::abs(i.z());
    }
    static Vec3 direction(double theta_deg, double phi_deg) {
        const double s = std::sin(radians(theta_deg));
        return Vec3(s * std::cos(radians(phi_deg)), s * std::sin(radians(phi_deg)), std::cos(radians(theta_deg)));
    }

    SceneResources resources_;
    BsdfBuilder builder_;
    std::map<std::string, std::string> notes_;
    std::vector<Bsdf> set_;
    Wavelengths wavelengths_ = Wavelengths::sample(0.3f);
    ShadingPoint point_;
};

TEST_F(BsdfFormula, RoughDielectricReflectsAndTransmitsAsWalterEtAl) {
    const double alpha = 0.35, index = 1.6;
    const Bsdf& bsdf =
        make("roughdielectric",
             {{"distribution", std::string("ggx")}, {"alpha", alpha}, {"int_ior", index}, {"ext_ior", 1.0}});
    for (const Vec3& out : {direction(25, 40), direction(70, 200), direction(160, 10), direction(140, 300)})
        for (const Vec3& in : {direction(15, 70), direction(60, 10), direction(150, 220), direction(170, 30)}) {
            const Vector3d o = out.cast<double>(), i = in.cast<double>();
            const double n_o = o.z() > 0 ? 1 : index, n_i = i.z() > 0 ? 1 : index;
            const double g = masking(o.z(), alpha) * masking(i.z(), alpha);
            double expected = 0;
            if (o.z() * i.z() > 0) {
                const Vector3d h = (o + i).normalized() * (o.z() > 0 ? 1 : -1);
                const double f = fresnel(std::abs(o.dot(h)), o.z() > 0 ? index : 1 / index);
                expected = f * ggx(h.z(), alpha) * g / (4 * std::abs(o.z() * i.z()));
            } else {
                // Eq. 21, light from i to o: n_o is that of the side the light goes to.
                Vector3d h = -(n_i * i + n_o * o).normalized();
                if (h.z() < 0) h = -h;
                const double io = i.dot(h), oo = o.dot(h);
                if (io * i.z() > 0 && oo * o.z() > 0)
                    expected = std::abs(io * oo / (i.z() * o.z())) * n_o * n_o *
                               (1 - fresnel(std::abs(io), n_o / n_i)) * g * ggx(h.z(), alpha) /
                               std::pow(n_i * io + n_o * oo, 2);
            }
            // Single precision.
            EXPECT_NEAR(intensity(bsdf, out, in), expected, 2e-4 * expected + 1e-7) << o << "\n\n" << i;
        }
}

// f(o, i) / n_o^2 = R f(i, o)^T R / n_i^2: radiance over the square of the index is what travels back unchanged.
TEST_F(BsdfFormula, RoughDielectricTransmitsReciprocally) {
    const Bsdf& bsdf = make("roughdielectric", {{"alpha", 0.4}, {"int_ior", 1.5}, {"ext_ior", 1.0}});
    for (const auto& [a, b] :
         {std::pair{direction(20, 0), direction(150, 170)}, {direction(55, 30), direction(140, 240)}}) {
        BsdfValue forth, back;
        ASSERT_TRUE(bsdf_evaluate(bsdf, point_, a, b, forth) && bsdf_evaluate(bsdf, point_, b, a, back));
        const optics::Mueller f = forth.f.matrix(0) / std::abs(b.z()), g = back.f.matrix(0) / a.z() / (1.5 * 1.5);
        const optics::Mueller g_here = rotate_frames(g, -a, back.f.x_in, forth.f.x_out, b, back.f.x_out, forth.f.x_in);
        const optics::Mueller expected = optics::reversal() * g_here.transpose() * optics::reversal();
        EXPECT_GT(f(0, 0), 1e-3);
        EXPECT_LT((f - expected).norm(), 1e-4 * f(0, 0));
    }
}

TEST_F(BsdfFormula, PlasticBodyIsTheSaundersonLayer) {
    const double rho = 0.8, index = 1.5;
    // 1 - F_di = (1 - F_de) / eta^2, F_de = int R(mu) d(mu^2): the outside integral gives the inside one.
    double outside = 0;
    for (int k = 0; k < 4000; ++k) outside += fresnel(std::sqrt((k + 0.5) / 4000), index) / 4000;
    const double inside = 1 - (1 - outside) / (index * index);
    const Bsdf& bsdf = make(
        "plastic", {uniform("diffuse_reflectance", rho), {"nonlinear", true}, {"int_ior", index}, {"ext_ior", 1.0}});
    const Vec3 o = direction(50, 0), i = direction(30, 130);
    const double expected =
        rho / pi * (1 - fresnel(o.z(), index)) * (1 - fresnel(i.z(), index)) / (index * index * (1 - rho * inside));
    // The model's quadrature of F has 400 points: 1e-4.
    EXPECT_NEAR(intensity(bsdf, o, i), expected, 3e-4 * expected);
}

// Light from a lit plastic's body at a grazing view is polarized in the plane of emission (Q < 0 with x across it).
TEST_F(BsdfFormula, PlasticBodyPolarizesAlongThePlaneOfEmission) {
    const Bsdf& bsdf = make("pplastic", {uniform("specular_reflectance", 0), {"int_ior", 1.5}, {"ext_ior", 1.0}});
    BsdfValue value;
    const Vec3 o = direction(75, 0);
    ASSERT_TRUE(bsdf_evaluate(bsdf, point_, o, direction(0, 0), value));
    const optics::Mueller m = value.f.matrix(0);
    EXPECT_NEAR(std::abs(value.f.x_out.dot(Vec3::UnitY())), 1, 1e-5);
    // T_s and T_p of Fresnel at 75 degrees.
    const double c = o.z(), g = std::sqrt(1.5 * 1.5 - 1 + c * c);
    const double ts = 1 - std::pow((c - g) / (c + g), 2), tp = 1 - std::pow((2.25 * c - g) / (2.25 * c + g), 2);
    EXPECT_NEAR(m(1, 0) / m(0, 0), (ts - tp) / (ts + tp), 1e-4);
    EXPECT_LT(m(1, 0), 0);
}

TEST_F(BsdfFormula, PaneAddsItsReflectionsUp) {
    const Bsdf& bsdf = make("thindielectric", {{"int_ior", 1.5}, {"ext_ior", 1.0}});
    const Vec3 o = direction(65, 20);
    const double c = o.z(), g = std::sqrt(1.25 + c * c);
    const double rs = std::pow((c - g) / (c + g), 2), rp = std::pow((2.25 * c - g) / (2.25 * c + g), 2);
    BsdfSample reflected, passed;
    ASSERT_TRUE(bsdf_sample(bsdf, point_, o, 0.0f, Vec2::Zero(), reflected));
    ASSERT_TRUE(bsdf_sample(bsdf, point_, o, 0.999f, Vec2::Zero(), passed));
    const optics::Mueller r = reflected.weight.matrix(0) * reflected.pdf, t = passed.weight.matrix(0) * passed.pdf;
    // R' = 2 R / (1 + R) for each polarization, and what is not reflected passes.
    EXPECT_NEAR(r(0, 0) + r(0, 1), 2 * rs / (1 + rs), 1e-5);
    EXPECT_NEAR(r(0, 0) - r(0, 1), 2 * rp / (1 + rp), 1e-5);
    EXPECT_NEAR(t(0, 0) + t(0, 1), 1 - 2 * rs / (1 + rs), 1e-5);
    EXPECT_NEAR(t(0, 0) - t(0, 1), 1 - 2 * rp / (1 + rp), 1e-5);
    EXPECT_EQ(passed.incident, Vec3(-o));
}

TEST_F(BsdfFormula, PhongAndLafortuneAreOneLobe) {
    const Bsdf phong =
        make("phong", {uniform("diffuse_reflectance", 0.1), uniform("specular_reflectance", 0.6), {"exponent", 12.0}});
    const Vec3 o = direction(50, 0), i = direction(40, 170);
    const double cosine = i.cast<double>().dot(Vector3d(-o.x(), -o.y(), o.z()));
    const double expected = 0.1 / pi + 0.6 * 14 / (2 * pi) * std::pow(cosine, 12);
    EXPECT_NEAR(intensity(phong, o, i), expected, 1e-5 * expected);
    const Bsdf lafortune = make("lafortune", {uniform("diffuse_reflectance", 0.1),
                                              uniform("weight_1", 0.6),
                                              {"exponent_1", 12.0},
                                              {"lobe_1", Vector3d(-1, -1, 1)}});
    EXPECT_NEAR(intensity(lafortune, o, i), expected, 1e-5 * expected);
}

TEST_F(BsdfFormula, OrenNayarWithoutRoughnessIsLambert) {
    const Bsdf& bsdf = make("orennayar", {uniform("reflectance", 0.7), {"sigma", 0.0}});
    EXPECT_NEAR(intensity(bsdf, direction(60, 0), direction(30, 100)), 0.7 / pi, 1e-6);
}

// A rough surface looks brightest from where the light comes (Oren & Nayar 1994, fig. 8): backscattering.
TEST_F(BsdfFormula, OrenNayarScattersBack) {
    const Bsdf& bsdf = make("orennayar", {uniform("reflectance", 0.7), {"sigma", 30.0}});
    EXPECT_GT(intensity(bsdf, direction(65, 0), direction(60, 0)),
              1.3 * intensity(bsdf, direction(65, 0), direction(60, 180)));
}

TEST_F(BsdfFormula, NonsenseIsRefusedWithAReason) {
    EXPECT_THROW(make("phong", {uniform("diffuse_reflectance", 0.9), uniform("specular_reflectance", 0.9)}), Error);
    EXPECT_THROW(make("phong", {{"exponent", -3.0}}), Error);
    EXPECT_THROW(make("orennayar", {{"sigma", 80.0}}), Error);
    EXPECT_THROW(make("roughdielectric", {{"alpha", 0.0}}), Error);
    EXPECT_THROW(make("roughdielectric", {{"int_ior", -1.0}}), Error);
    EXPECT_THROW(make("mask", {}), Error);
    EXPECT_THROW(make("blendbsdf", {}), Error);
    EXPECT_THROW(make("lafortune", {{"lobe_1", Vector3d(0, 0, 0)}}), Error);
    EXPECT_THROW(make("pplastic", {{"nonlinear", true}}), Error);
    EXPECT_THROW(make("merl", {{"filename", std::string("x.binary")}}), Error);  // no reader is supplied
}

// Burley (2012, 2015) with Mitsuba's clearcoat, for a grey base, whose hue is white.
TEST_F(BsdfFormula, PrincipledIsTheSumOfBurleysLobes) {
    const double base = 0.6, roughness = 0.45, metal = 0.3, tint = 0.4, sheen = 0.5, flat = 0.3, coat = 0.8,
                 gloss = 0.6;
    const Bsdf& bsdf = make("principled", {uniform("base_color", base),
                                           {"roughness", roughness},
                                           {"metallic", metal},
                                           {"spec_tint", tint},
                                           {"sheen", sheen},
                                           {"flatness", flat},
                                           {"clearcoat", coat},
                                           {"clearcoat_gloss", gloss}});
    const auto weight = [](double c) { return std::pow(1 - c, 5); };
    const auto schlick = [&](double f0, double c) { return f0 + (1 - f0) * weight(c); };
    for (const auto& [o, i] :
         {std::pair{direction(30, 0), direction(50, 170)}, {direction(70, 10), direction(20, 80)}}) {
        const Vec3 m = (o + i).normalized();
        const double co = o.z(), ci = i.z(), cm = m.z(), cd = o.dot(m), eta = 1.5;
        const double r = 2 * roughness * cd * cd, wo = weight(co), wi = weight(ci);
        const double lambert = (1 - wo / 2) * (1 - wi / 2) + r * (wo + wi + wo * wi * (r - 1));
        const double under = (1 - wo + wo * r / 2) * (1 - wi + wi * r / 2);
        const double soft = 1.25 * (under * (1 / (co + ci) - 0.5) + 0.5);
        const double alpha = roughness * roughness;
        const double f =
            (1 - metal) * ((1 - tint) * fresnel(cd, eta) + tint * schlick(0.04, cd)) + metal * schlick(base, cd);
        const double lobe = f * ggx(cm, alpha) * masking(co, alpha) * masking(ci, alpha) / (4 * co * ci);
        const double a2 = std::pow(0.1 + gloss * (0.001 - 0.1), 2);
        const double tails = (a2 - 1) / (pi * std::log(a2) * (1 + (a2 - 1) * cm * cm));
        const double expected = (1 - metal) * (base / pi * ((1 - flat) * lambert + flat * soft) + sheen * weight(cd)) +
                                lobe + 0.25 * coat * schlick(0.04, cd) * tails * masking(co, 0.25) * masking(ci, 0.25);
        // eta of specular 0.5 is 2 / (1 - sqrt(0.04)) - 1 = 1.5; single precision.
        EXPECT_NEAR(intensity(bsdf, o, i), expected, 2e-5 * expected);
    }
}

// White glass of Burley's model is a rough dielectric of alpha = roughness^2, from both sides and with its densities;
// tinted it passes the square root of its colour, which light that goes in and out meets twice.
TEST_F(BsdfFormula, PrincipledGlassIsARoughDielectric) {
    const double roughness = 0.6;
    const Value ggx{"distribution", std::string("ggx")};
    const Bsdf glass = make("principled", {uniform("base_color", 1), {"spec_trans", 1.0}, {"roughness", roughness}});
    const Bsdf tinted =
        make("principled", {uniform("base_color", 0.49), {"spec_trans", 1.0}, {"roughness", roughness}});
    const Bsdf rough =
        make("roughdielectric", {ggx, {"alpha", roughness * roughness}, {"int_ior", 1.5}, {"ext_ior", 1.0}});
    int pairs = 0;
    for (double theta_o : {20.0, 70.0, 110.0, 155.0})
        for (double theta_i : {10.0, 60.0, 125.0, 170.0})
            for (double phi : {30.0, 170.0}) {
                const Vec3 o = direction(theta_o, 0), i = direction(theta_i, phi);
                const double expected = intensity(rough, o, i);
                if (!(expected > 0)) continue;
                ++pairs;
                // Single precision.
                EXPECT_NEAR(intensity(glass, o, i), expected, 1e-4 * expected) << theta_o << " " << theta_i;
                const double share = (theta_o < 90) == (theta_i < 90) ? 1 : 0.7;
                EXPECT_NEAR(intensity(tinted, o, i), share * expected, 1e-4 * expected) << theta_o << " " << theta_i;
            }
    EXPECT_GT(pairs, 10);
}

}  // namespace
}  // namespace patina::render::test
