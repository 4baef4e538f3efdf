// Light-path expressions: which paths they accept, what they refuse, and that partitions add up.

#include "patina/render/integrators/light_path_expression.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/render/test_support.h"

namespace patina::render {
namespace {

using namespace test;

// Events from the eye to the light.
bool accepts(const std::string& expression, const std::string& events) {
    const LightPathExpression given[] = {{"x", expression}};
    const LightPathClassifier classifier(given);
    int state = LightPathClassifier::eye;
    for (char c : events)
        state = classifier.after(state, c == 'D'   ? ScatteringEvent::diffuse
                                        : c == 'G' ? ScatteringEvent::glossy
                                                   : ScatteringEvent::specular);
    return classifier.belongs(classifier.path_class(state), 0);
}

std::string refusal(const std::string& expression) {
    try {
        accepts(expression, "");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(LightPathExpression, AcceptsWhatTheLecturesSay) {
    EXPECT_TRUE(accepts("LE", ""));
    EXPECT_FALSE(accepts("LE", "D"));
    EXPECT_TRUE(accepts("LDE", "D"));
    EXPECT_FALSE(accepts("LDE", "DD"));
    EXPECT_TRUE(accepts("LSSDE", "DSS"));
    EXPECT_FALSE(accepts("LSSDE", "SSD"));
    // At least one S or D between the light and the last diffuse event.
    EXPECT_TRUE(accepts("L(S|D)+DE", "DSDS"));
    EXPECT_FALSE(accepts("L(S|D)+DE", "D"));
    EXPECT_FALSE(accepts("L(S|D)+DE", "SD"));
    // From the eye: Appel and Whitted.
    EXPECT_TRUE(accepts("E(D|G)L", "G"));
    EXPECT_FALSE(accepts("E(D|G)L", "S"));
    EXPECT_TRUE(accepts("ES*(D|G)L", "SSG"));
    EXPECT_FALSE(accepts("ES*(D|G)L", "DS"));
    EXPECT_TRUE(accepts("E D? (S|G)* L", "DSG"));
    EXPECT_TRUE(accepts("E.*L", "DSGGSD"));
    // Kajiya, in the brackets of the lecture.
    EXPECT_TRUE(accepts("E[(D|G|S)+(D|G)]L", "SD"));
    EXPECT_FALSE(accepts("E[(D|G|S)+(D|G)]L", "D"));
    EXPECT_FALSE(accepts("E[(D|G|S)+(D|G)]L", "DGS"));
}

// The same language written from either end is the same.
TEST(LightPathExpression, ReadsBothDirections) {
    const std::string letters = "DGS";
    for (int code = 0; code < 243; ++code) {
        std::string events;
        for (int i = 0, rest = code; i < 5; ++i, rest /= 3) events += letters[rest % 3];
        EXPECT_EQ(accepts("L(SD?)*G+.E", events), accepts("E.G+(D?S)*L", events)) << events;
    }
}

TEST(LightPathExpression, RefusesWithTheColumn) {
    EXPECT_NE(refusal("L(S|DE").find("column 2: \"(\" is not closed"), std::string::npos);
    EXPECT_NE(refusal("LXE").find("column 2: \"X\" is no symbol"), std::string::npos);
    EXPECT_NE(refusal("LD)E").find("column 3: \")\" closes nothing"), std::string::npos);
    EXPECT_NE(refusal("L[D)E").find("column 2: \"[\" is not closed"), std::string::npos);
    EXPECT_NE(refusal("L|*E").find("column 3: a symbol is missing before \"*\""), std::string::npos);
    EXPECT_NE(refusal("LDLE").find("column 3"), std::string::npos);
    EXPECT_NE(refusal("DDE").find("column 1"), std::string::npos);
    EXPECT_NE(refusal("").find("column 1"), std::string::npos);
    // A caret under the place, and no more of a long text than a line.
    EXPECT_TRUE(refusal("L(S|DE").ends_with("\n    L(S|DE\n     ^")) << refusal("L(S|DE");
    EXPECT_TRUE(refusal("").ends_with("\n    \n    ^")) << refusal("");
    EXPECT_LT(refusal("L" + std::string(100'000, 'D') + "E").size(), 250u);
    EXPECT_NE(refusal(std::string(10'000, '(')).find("longer than"), std::string::npos);
    // 2^n states: no hang.
    EXPECT_NE(refusal("E(D|S)*D" + std::string(200, '.') + "L").find("too complex"), std::string::npos);
}

// What the light of a point lamp met on a ball of the model: the only letter X with light in LXE.
std::string kinds(const Node& model) {
    const Node ball = node("shape", "sphere", {}, {model});
    RenderOptions options;
    options.light_paths = {{"D", "LDE"}, {"G", "LGE"}, {"S", "LSE"}};
    const auto built = build_scene(
        *scene({path(2), perspective(look_at({0, -4, 0}, {0, 0, 0}, {0, 0, 1}), 30, 6, 6, 4), ball,
                node("emitter", "point", {{"position", Eigen::Vector3d(1, -4, 1)}, uniform("intensity", 1)}),
                node("emitter", "constant", {uniform("radiance", 1)})}),
        {});
    std::string found;
    for (const auto& [name, image] : render_parts(*built, options).parts)
        if (std::any_of(image.spectral.begin(), image.spectral.end(), [](float v) { return v != 0; })) found += name;
    return found;
}

TEST(ScatteringEvent, OfTheModels) {
    const auto model = [](const char* type, std::vector<Value> values = {}, std::vector<Node> children = {}) {
        return node("bsdf", type, std::move(values), std::move(children));
    };
    const Node matt = model("orennayar"), metal = model("roughconductor"), mirror = model("conductor");
    EXPECT_EQ(kinds(model("diffuse")), "D");
    EXPECT_EQ(kinds(matt), "D");
    EXPECT_EQ(kinds(metal), "G");
    EXPECT_EQ(kinds(mirror), "S");
    EXPECT_EQ(kinds(model("plastic")), "DS");
    EXPECT_EQ(kinds(model("roughplastic")), "G");  // its body and its lobe are not told apart
    EXPECT_EQ(kinds(model("phong")), "G");
    // Made of others.
    EXPECT_EQ(kinds(model("twosided", {}, {matt})), "D");
    EXPECT_EQ(kinds(model("mask", {{"opacity", 0.5}}, {matt})), "D");
    EXPECT_EQ(kinds(model("mask", {{"opacity", 0.5}}, {metal})), "G");
    EXPECT_EQ(kinds(model("blendbsdf", {}, {matt, model("diffuse")})), "D");
    EXPECT_EQ(kinds(model("blendbsdf", {}, {matt, metal})), "G");
    EXPECT_EQ(kinds(model("blendbsdf", {}, {matt, mirror})), "DS");
    EXPECT_EQ(kinds(model("blendbsdf", {{"weight", 1.0}}, {metal, matt})), "D");
}

// A corner with a mirror, a rough metal and a diffuse floor under an area light and a constant sky.
Node mixed_scene(int samples = 4) {
    const Node lamp = node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, 3}) * rotate_x(180))}},
                           {node("emitter", "area", {uniform("radiance", 3)})});
    const Node floor = node("shape", "rectangle", {{"to_world", scale(3, 3, 1)}},
                            {node("bsdf", "diffuse", {rgb("reflectance", 0.7, 0.4, 0.2)})});
    const Node ball = node("shape", "sphere", {{"center", Eigen::Vector3d(0.8, 0, 0.6)}, {"radius", 0.6}},
                           {node("bsdf", "conductor", {{"material", std::string("Au")}})});
    const Node rough = node("shape", "sphere", {{"center", Eigen::Vector3d(-0.8, 0, 0.6)}, {"radius", 0.6}},
                            {node("bsdf", "roughconductor", {{"material", std::string("Al")}, {"alpha", 0.3}})});
    return scene({path(6), perspective(look_at({0, -5, 1.5}, {0, 0, 0.6}, {0, 0, 1}), 40, 16, 16, samples), lamp, floor,
                  ball, rough, node("emitter", "constant", {uniform("radiance", 0.2)})});
}

void expect_exact_sum(const StokesImage& whole, std::vector<const StokesImage*> parts) {
    // Forwards and backwards: exact sums do not depend on the order.
    for (int direction = 0; direction < 2; ++direction) {
        int different = 0;
        for (std::size_t i = 0; i < whole.spectral.size(); ++i) {
            float sum = 0;
            for (const StokesImage* part : parts) sum += part->spectral[i];
            different += sum != whole.spectral[i];
        }
        for (std::size_t i = 0; i < whole.rgb.size(); ++i) {
            float sum = 0;
            for (const StokesImage* part : parts) sum += part->rgb[i];
            different += sum != whole.rgb[i];
        }
        EXPECT_EQ(different, 0);
        std::reverse(parts.begin(), parts.end());
    }
}

TEST(LightPathExpression, PartitionsAddUpToTheLastBit) {
    RenderOptions options;
    options.light_paths = {{"seen", "LE"},        {"direct", "LDE"},     {"glossy", "LGE"},
                           {"mirror", "LS+E"},    {"caustics", "LS+DE"}, {"indirect", "E.*L"},
                           {"first_d", "ED..*L"}, {"first_g", "EG..*L"}, {"first_s", "ES.*(D|G).*L"}};
    const auto built = build_scene(*mixed_scene(), {});
    const Pictures pictures = render_parts(*built, options);
    const auto part = [&](int i) { return &pictures.parts[i].second; };
    expect_exact_sum(pictures.whole, {part(0), part(1), part(2), part(3), part(6), part(7), part(8)});
    expect_exact_sum(pictures.whole, {part(5)});

    // Rounding to a common step is all that tells it from the picture without parts: 2^-22 of the largest term, and
    // spectral values of Q, U, V may cancel to less, so compare with the intensity.
    const StokesImage plain = render(*built, {});
    for (std::size_t i = 0; i < plain.spectral.size(); ++i)
        EXPECT_NEAR(plain.spectral[i], pictures.whole.spectral[i], 2e-6f * (1e-3f + plain.spectral[i / 4 * 4]));
}

TEST(Neumann, TermsAddUpToTheLastBitAndAreTheDifferencesOfDepths) {
    RenderOptions options;
    options.neumann_terms = 3;
    const auto built = build_scene(*mixed_scene(), {});
    const Pictures pictures = render_parts(*built, options);
    ASSERT_EQ(pictures.parts.size(), 4u);
    std::vector<const StokesImage*> terms;
    for (const auto& [name, image] : pictures.parts) terms.push_back(&image);
    expect_exact_sum(pictures.whole, terms);

    // The same random numbers with paths cut at one more segment add just the next term.
    std::vector<float> sum(pictures.whole.spectral.size(), 0.0f);
    for (int term = 0; term < 3; ++term) {
        const Node tree = mixed_scene();
        tree->children[0].node = path(term + 1);
        const StokesImage cut = render(*build_scene(*tree, {}), {});
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += terms[term]->spectral[i];
            // Every term is rounded to 2^-22 of the whole.
            EXPECT_NEAR(sum[i], cut.spectral[i], 2e-6f * (1e-3f + pictures.whole.spectral[i / 4 * 4]));
        }
    }
}

// In a closed sphere that shines with radiance 1 and reflects rho of all light, T^k L_e = rho^k and |T| = rho.
TEST(Neumann, FurnaceHasTheNormOfItsReflectance) {
    const double rho = 0.7;
    const Node sphere = node(
        "shape", "sphere", {{"flip_normals", true}},
        {node("bsdf", "diffuse", {uniform("reflectance", rho)}), node("emitter", "area", {uniform("radiance", 1)})});
    const Node tree = scene({path(12), perspective(look_at({0, 0.2, 0}, {1, 0, 0}, {0, 0, 1}), 60, 4, 4, 64), sphere});
    RenderOptions options;
    options.neumann_terms = 5;
    const Pictures pictures = render_parts(*build_scene(*tree, {}), options);
    for (int term = 0; term < 5; ++term) {
        double mean = 0;
        const StokesImage& image = pictures.parts[term].second;
        for (std::size_t i = 0; i < image.spectral.size(); i += 4)
            mean += 4 * image.spectral[i] / image.spectral.size();
        // Two estimates of the same radiance shared by multiple importance sampling: noise of about 1e-2.
        EXPECT_NEAR(mean, std::pow(rho, term), 0.02) << term;
    }
    EXPECT_NEAR(std::stod(pictures.whole.metadata.at("neumann_norm")), rho, 0.02);
}

TEST(LightPathExpression, PicturesDoNotDependOnThreads) {
    RenderOptions options;
    options.light_paths = {{"direct", "L(D|G)E"}};
    const auto built = build_scene(*mixed_scene(2), {});
    std::vector<float> first;
    for (int threads : {1, 2}) {
        set_thread_count(threads);
        const Pictures pictures = render_parts(*built, options);
        if (threads == 1) first = pictures.parts[0].second.spectral;
        EXPECT_EQ(first, pictures.parts[0].second.spectral);
    }
    set_thread_count(0);
}

}  // namespace
}  // namespace patina::render
