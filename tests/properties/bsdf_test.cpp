// What every registered surface model must obey. A model is here by being registered; only what it cannot do without
// (children, tables) is named below.

#include <gtest/gtest.h>

#include "patina/brdf/tabulate.h"
#include "patina/render/bsdf_set.h"
#include "patina/render/random.h"
#include "patina/render/test_support.h"

namespace patina::render::test {
namespace {

using optics::Mueller;

struct Case {
    std::string name;
    std::vector<Value> values;
    std::vector<Node> children = {};
    std::vector<std::string> child_names = {};
    // Draws from several lobes whose densities add up: a single lobe's Jacobian is not one over the density.
    bool mixes = false;
    double reciprocity = 1e-4;  // relative: single precision; interpolated tables have their own
    bool reciprocal = true;
    // Half-precision tables lose 5e-4 of a matrix.
    double realizability = 2e-3;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.name;
}

Value text(std::string name, std::string value) {
    return {std::move(name), std::move(value)};
}

// What a model cannot do without, and what its drawing is like.
Case needs_of(const std::string& name) {
    Case c{name, {}};
    const std::string file = "table";
    if (name == "paint") c.values = {{"table", file}};
    if (name == "merl" || name == "measured_polarized") c.values = {{"filename", file}};
    if (name == "twosided" || name == "mask") c.children = {node("bsdf", "roughconductor")};
    if (name == "normalmap" || name == "bumpmap") {
        c.children = {node("bsdf", "roughconductor"), node("texture", "bitmap", {{"filename", file}})};
        c.child_names = {"", name};
        c.reciprocal = false;  // so its manual
    }
    if (name == "blendbsdf") c.children = {node("bsdf", "roughconductor"), node("bsdf", "roughplastic")};
    for (const char* mixed :
         {"roughplastic", "pplastic", "phong", "lafortune", "principled", "blendbsdf", "merl", "measured_polarized"})
        c.mixes |= name == mixed;
    // Half-precision, linearly interpolated tables; and one of half angles on a grid of 5 degrees.
    if (name == "paint") c.reciprocity = 5e-3;
    if (name == "measured_polarized") c.reciprocity = 2e-2;
    // Beside the horizon its cells have corners below it, which hold other directions' values.
    if (name == "measured_polarized") c.realizability = 0.1;
    return c;
}

// Every registered model with its defaults, and some with what is worth trying besides.
std::vector<Case> cases() {
    std::vector<Case> all;
    for (const PluginDescriptor& plugin : plugins())
        if (plugin.category == "bsdf") all.push_back(needs_of(plugin.name));
    const Value ggx = text("distribution", "ggx"), gold = text("material", "Au");
    all.push_back({"roughconductor", {ggx, {"alpha", 0.3}, gold}});
    all.push_back({"roughconductor", {ggx, {"alpha_u", 0.1}, {"alpha_v", 0.6}}});
    all.push_back({"roughconductor", {{"alpha", 0.5}, gold}});
    all.push_back({"dielectric", {{"int_ior", 1.33}, {"ext_ior", 1.6}}});
    all.push_back({"roughdielectric", {ggx, {"alpha", 0.4}}});
    all.push_back({"roughdielectric", {ggx, {"alpha", 0.3}, {"int_ior", 1.0}, {"ext_ior", 1.8}}});
    all.push_back({"roughdielectric", {{"alpha_u", 0.15}, {"alpha_v", 0.5}}});
    all.push_back({"roughdielectric", {{"alpha", 0.2}, text("int_ior", "ZnS")}, {}, {}, true});  // dispersive
    all.push_back({"thindielectric", {{"int_ior", 1.0}, {"ext_ior", 1.5}}});
    // One lobe at a time, where the Jacobian tells.
    all.push_back({"roughplastic", {ggx, {"alpha", 0.3}, uniform("diffuse_reflectance", 0)}});
    all.push_back({"plastic", {uniform("diffuse_reflectance", 1), {"nonlinear", true}}});
    all.push_back(
        {"phong", {uniform("diffuse_reflectance", 0), uniform("specular_reflectance", 1), {"exponent", 8.0}}});
    all.push_back({"lafortune",
                   {uniform("diffuse_reflectance", 0),
                    uniform("weight_1", 1),
                    {"exponent_1", 6.0},
                    {"lobe_1", Eigen::Vector3d(-0.9, -1.0, 0.7)}}});
    all.push_back({"principled", {{"metallic", 1.0}, {"roughness", 0.3}, {"anisotropic", 0.8}}, {}, {}, true});
    all.push_back({"principled",
                   {rgb("base_color", 0.6, 0.3, 0.1),
                    {"metallic", 0.4},
                    {"spec_tint", 0.6},
                    {"flatness", 0.5},
                    {"clearcoat", 1.0},
                    {"clearcoat_gloss", 0.5}},
                   {},
                   {},
                   true});
    all.push_back({"principled", {{"spec_trans", 1.0}, {"roughness", 0.6}}});
    all.push_back({"principled",
                   {uniform("base_color", 0.8), {"spec_trans", 0.6}, {"metallic", 0.2}, {"clearcoat", 0.5}},
                   {},
                   {},
                   true});
    all.push_back({"orennayar", {uniform("reflectance", 0.95), {"sigma", 35.0}}});
    all.push_back({"mask", {uniform("opacity", 0.25)}, {node("bsdf", "plastic")}});
    all.push_back(
        {"blendbsdf", {uniform("weight", 0.7)}, {node("bsdf", "dielectric"), node("bsdf", "pplastic")}, {}, true});
    return all;
}

// Tables that several cases read, made once.
std::shared_ptr<const brdf::MuellerTable> rayleigh_table() {
    static const auto table = std::make_shared<const brdf::MuellerTable>(
        brdf::tabulate(brdf::single_rayleigh_body(1.0), {.wavelengths_nm = {400, 700}, .nodes = 32, .orders = 3}));
    return table;
}
std::shared_ptr<const brdf::HalfAngleTable> half_angle_table() {
    static const auto table = std::make_shared<const brdf::HalfAngleTable>(brdf::to_half_angles(
        *rayleigh_table(), {.theta_h = 19, .theta_d = 19, .phi_d = 37, .wavelengths_nm = {400, 700}}));
    return table;
}
// A brown glossy surface: 1/sr.
std::shared_ptr<const brdf::MerlTable> merl_table() {
    static const auto table = [] {
        brdf::MerlTable t;
        t.rgb.resize(3 * brdf::MerlTable::plane_size);
        for (std::size_t i = 0; i < t.rgb.size(); ++i) {
            const auto h = static_cast<double>(i % brdf::MerlTable::plane_size / (90 * 180));
            t.rgb[i] = 0.1 / (1.0 + static_cast<double>(i / brdf::MerlTable::plane_size)) + 0.5 * std::exp(-h / 15);
        }
        return std::make_shared<const brdf::MerlTable>(std::move(t));
    }();
    return table;
}

class EveryBsdf : public testing::TestWithParam<Case> {
  protected:
    void SetUp() override {
        resources_.load_brdf_table = [](const std::string&) { return rayleigh_table(); };
        resources_.load_half_angle_table = [](const std::string&) { return half_angle_table(); };
        resources_.load_merl_table = [](const std::string&) { return merl_table(); };
        // Normals tilted by 20 degrees; as heights, waves.
        resources_.load_bitmap = [](const std::string&, bool) {
            Bitmap image{"tilted", 4, 1, {"R", "G", "B"}, {}};
            for (float r : {0.67f, 0.66f, 0.67f, 0.68f}) image.data.insert(image.data.end(), {r, 0.5f, 0.97f});
            return std::make_shared<const Bitmap>(std::move(image));
        };
        builder_.resources = &resources_;
        builder_.notes = &notes_;
        builder_.nested = [this](const std::shared_ptr<const Properties>& child) {
            set_.push_back(build_bsdf(*child, builder_));
            return static_cast<int>(set_.size()) - 1;
        };
        const Node tree = node("bsdf", GetParam().name, GetParam().values, GetParam().children);
        for (std::size_t k = 0; k < GetParam().child_names.size(); ++k)
            tree->children[k].name = GetParam().child_names[k];
        const Bsdf built = build_bsdf(*tree, builder_);
        set_.push_back(built);
        point_ = {&wavelengths_, {0.3f, 0.6f}, set_.data()};
    }
    const Bsdf& bsdf() const { return set_.back(); }

    static Vec3 view(double theta_deg, double phi_deg = 25) {
        const double s = std::sin(radians(theta_deg));
        return Vec3(s * std::cos(radians(phi_deg)), s * std::sin(radians(phi_deg)), std::cos(radians(theta_deg)));
    }
    static std::vector<Vec3> views() {
        return {view(0), view(20), view(50), view(75), view(86), view(40, 200), view(130)};
    }

    // A Mueller matrix that some medium can have: its coherency matrix (Cloude 1986) has no negative eigenvalue.
    static double least_coherency_eigenvalue(const Mueller& m) {
        using Complex = std::complex<double>;
        Eigen::Matrix2cd pauli[4];
        pauli[0] << 1, 0, 0, 1;
        pauli[1] << 1, 0, 0, -1;
        pauli[2] << 0, 1, 1, 0;
        pauli[3] << 0, Complex(0, -1), Complex(0, 1), 0;
        Eigen::Matrix4cd h = Eigen::Matrix4cd::Zero();
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                Eigen::Matrix4cd kron;
                for (int a = 0; a < 2; ++a)
                    for (int b = 0; b < 2; ++b) kron.block<2, 2>(2 * a, 2 * b) = pauli[i](a, b) * pauli[j].conjugate();
                h += 0.25 * m(i, j) * kron;
            }
        return Eigen::SelfAdjointEigenSolver<Eigen::Matrix4cd>(h).eigenvalues().minCoeff();
    }

    SceneResources resources_;
    BsdfBuilder builder_;
    std::map<std::string, std::string> notes_;
    std::vector<Bsdf> set_;
    Wavelengths wavelengths_ = Wavelengths::sample(0.11f);
    ShadingPoint point_;
};

// No view gets more light than arrives from surroundings of radiance 1 (times the square of the relative index).
TEST_P(EveryBsdf, ConservesEnergy) {
    for (const Vec3& outgoing : views()) {
        double total = 0;
        const int count = 4096;
        for (int i = 0; i < count; ++i) {
            Sampler sampler(7, i, 1);
            BsdfSample s;
            const float lobe = sampler.next();
            if (!bsdf_sample(bsdf(), point_, outgoing, lobe, sampler.next2(), s)) continue;
            total += s.weight.intensity()[0] * s.eta * s.eta / count;  // eta is that of the hero wavelength
        }
        // Stratified samples; 1 % covers single precision and what is left of the noise.
        EXPECT_LE(total, 1.01) << outgoing.transpose();
    }
}

TEST_P(EveryBsdf, GivesMuellerMatricesThatExist) {
    for (const Vec3& outgoing : views())
        for (int i = 0; i < 64; ++i) {
            Sampler sampler(3, i, 2);
            BsdfSample s;
            const float lobe = sampler.next();
            if (!bsdf_sample(bsdf(), point_, outgoing, lobe, sampler.next2(), s)) continue;
            for (int w = 0; w < wavelengths_per_path; ++w) {
                const Mueller m = s.weight.matrix(w);
                ASSERT_TRUE(m.allFinite());
                EXPECT_GE(least_coherency_eigenvalue(m), -GetParam().realizability * m(0, 0))
                    << m << "\nview " << outgoing.transpose();
            }
            if (s.weight.form == ScatteringMatrix::Form::depolarizing) continue;
            EXPECT_NEAR(s.weight.x_in.dot(s.incident), 0, 1e-5);
            EXPECT_NEAR(s.weight.x_out.dot(outgoing), 0, 1e-5);
            EXPECT_NEAR(s.weight.x_in.norm(), 1, 1e-5);
            EXPECT_NEAR(s.weight.x_out.norm(), 1, 1e-5);
        }
}

// sample() and evaluate() are two views of one function.
TEST_P(EveryBsdf, EvaluatesToWhatItSamples) {
    for (const Vec3& outgoing : views())
        for (int i = 0; i < 64; ++i) {
            Sampler sampler(5, i, 3);
            BsdfSample s;
            const float lobe = sampler.next();
            if (!bsdf_sample(bsdf(), point_, outgoing, lobe, sampler.next2(), s) || s.delta) continue;
            BsdfValue value;
            ASSERT_TRUE(bsdf_evaluate(bsdf(), point_, outgoing, s.incident, value));
            // Float half vectors: the density of a narrow lobe amplifies their rounding.
            EXPECT_NEAR(value.pdf / s.pdf, 1, 2e-2);
            for (int e = 0; e < value.f.entries(); ++e)
                EXPECT_NEAR(value.f.m[e][1] / s.pdf, s.weight.m[e][1], 2e-2 * s.weight.m[0][1] + 1e-6);
            // With unpolarized light the first column is all that is asked for.
            BsdfValue column;
            ShadingPoint unpolarized = point_;
            unpolarized.unpolarized_light = true;
            ASSERT_TRUE(bsdf_evaluate(bsdf(), unpolarized, outgoing, s.incident, column));
            // Tables may add the same products up in another order.
            const double rounding = 1e-6 * value.f.matrix(2)(0, 0);
            EXPECT_NEAR(column.f.matrix(2)(0, 0), value.f.matrix(2)(0, 0), rounding);
            if (value.f.form != ScatteringMatrix::Form::general) continue;
            for (int row = 0; row < 4; ++row) EXPECT_NEAR(column.f.m[row][2], value.f.m[row][2], rounding);
        }
}

// The density integrates to the share of samples that are drawn and no delta functions, cell by cell (chi-square).
TEST_P(EveryBsdf, DrawsWithItsDensity) {
    constexpr int rows = 10, columns = 12, count = 1 << 16, sub = 24;
    for (const Vec3& outgoing : {view(30), view(70, 100)}) {
        std::vector<double> expected(rows * columns), observed(rows * columns);
        for (int i = 0; i < count; ++i) {
            Sampler sampler(static_cast<std::uint32_t>(i), 0, 9);  // independent draws: one of each sequence
            BsdfSample s;
            const float lobe = sampler.next();
            if (!bsdf_sample(bsdf(), point_, outgoing, lobe, sampler.next2(), s) || s.delta) continue;
            const double azimuth = std::atan2(s.incident.y(), s.incident.x()) / (2 * pi);
            const int row = std::min(rows - 1, static_cast<int>(0.5 * (1 + s.incident.z()) * rows));
            const int column = std::min(columns - 1, static_cast<int>((azimuth < 0 ? azimuth + 1 : azimuth) * columns));
            observed[row * columns + column] += 1;
        }
        for (int row = 0; row < rows * sub; ++row)
            for (int column = 0; column < columns * sub; ++column) {
                const double z = 2 * (row + 0.5) / (rows * sub) - 1, r = std::sqrt(1 - z * z);
                const double azimuth = 2 * pi * (column + 0.5) / (columns * sub);
                BsdfValue value;
                const Vec3 incident(r * std::cos(azimuth), r * std::sin(azimuth), z);
                if (!bsdf_evaluate(bsdf(), point_, outgoing, incident, value)) continue;
                expected[row / sub * columns + column / sub] +=
                    value.pdf * 4 * pi / (rows * columns * sub * sub) * count;
            }
        // Pool what is rare; each cell's midpoint rule errs by about 1 % in a lobe, which counts as variance.
        double chi2 = 0, rare_expected = 0, rare_observed = 0;
        int freedom = 0;
        for (int cell = 0; cell < rows * columns; ++cell) {
            if (expected[cell] < 20) {
                rare_expected += expected[cell], rare_observed += observed[cell];
                continue;
            }
            chi2 +=
                std::pow(observed[cell] - expected[cell], 2) / (expected[cell] + std::pow(0.02 * expected[cell], 2));
            ++freedom;
        }
        EXPECT_NEAR(rare_observed, rare_expected, 5 * std::sqrt(rare_expected) + 0.1 * rare_expected + 5);
        if (freedom == 0) continue;
        // Wilson & Hilferty (1931): chi^2 above this has a probability of 1e-5.
        const double t = 2.0 / (9.0 * freedom);
        EXPECT_LT(chi2, freedom * std::pow(1 - t + 4.265 * std::sqrt(t), 3)) << outgoing.transpose();
    }
}

// The density is one over the area a unit of random numbers is stretched to, times the chance of the lobe.
TEST_P(EveryBsdf, DensityIsOneOverTheJacobian) {
    if (GetParam().mixes) return;
    const float h = 2e-3f, lobe = 0.999f;
    const Vec3 outgoing = view(35);
    // How many of all choices lead where this one does; a paint draws from two nodes of its table with nearly the same
    // density.
    const auto chance = [&](const BsdfSample& at, const Vec2& u) {
        if (GetParam().name == "paint") return 1.0;
        constexpr int choices = 200;
        int same = 0;
        for (int k = 0; k < choices; ++k) {
            BsdfSample other;
            const bool found = bsdf_sample(bsdf(), point_, outgoing, (k + 0.5f) / choices, u, other);
            same += found && (other.incident - at.incident).norm() < 1e-4f;
        }
        return static_cast<double>(same) / choices;
    };
    std::vector<double> ratios;
    for (int i = 0; i < 200; ++i) {
        Sampler sampler(11, i, 4);
        const Vec2 u = 0.02f * Vec2::Ones() + 0.96f * sampler.next2();
        BsdfSample at, right, up;
        if (!bsdf_sample(bsdf(), point_, outgoing, lobe, u, at) || at.delta) continue;
        if (!bsdf_sample(bsdf(), point_, outgoing, lobe, u + Vec2(h, 0), right)) continue;
        if (!bsdf_sample(bsdf(), point_, outgoing, lobe, u + Vec2(0, h), up)) continue;
        const double area = (right.incident - at.incident).cross(up.incident - at.incident).norm() / (h * h);
        ratios.push_back(area * at.pdf / chance(at, u));
    }
    if (ratios.empty()) return;  // delta functions only
    // The middle value: differences across a seam of the map, and between nodes of a table, say nothing.
    std::nth_element(ratios.begin(), ratios.begin() + ratios.size() / 2, ratios.end());
    EXPECT_NEAR(ratios[ratios.size() / 2], 1.0, GetParam().name == "paint" ? 0.1 : 0.03);
}

// f(i, o) = R f(o, i)^T R, R = diag(1, 1, -1, 1), with the same x axes.
TEST_P(EveryBsdf, IsReciprocal) {
    if (!GetParam().reciprocal) return;
    for (const auto& [a, b] :
         {std::pair{view(20), view(55, 150)}, {view(70, 10), view(30, 40)}, {view(65, 0), view(60, 185)}}) {
        BsdfValue forth, back;
        if (!bsdf_evaluate(bsdf(), point_, a, b, forth) || !bsdf_evaluate(bsdf(), point_, b, a, back)) continue;
        const Mueller f = forth.f.matrix(0) / b.z(), g = back.f.matrix(0) / a.z();
        const bool turned = forth.f.form != ScatteringMatrix::Form::depolarizing;
        // Bring the way back to the axes of the way forth: its light travels along -a in and along b out.
        const Mueller g_here =
            turned ? rotate_frames(g, -a, back.f.x_in, forth.f.x_out, b, back.f.x_out, forth.f.x_in) : g;
        const Mueller expected = optics::reversal() * g_here.transpose() * optics::reversal();
        EXPECT_LE((f - expected).norm(), GetParam().reciprocity * f(0, 0)) << f << "\n\n" << expected;
    }
}

INSTANTIATE_TEST_SUITE_P(Registered, EveryBsdf, testing::ValuesIn(cases()),
                         [](const auto& entry) { return entry.param.name + std::to_string(entry.index); });

}  // namespace
}  // namespace patina::render::test
