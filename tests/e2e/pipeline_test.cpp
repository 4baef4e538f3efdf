// The main job as a user runs it: recipe to table to figure, scene to polarized picture.

#include "run_patina.h"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "patina/io/png_file.h"

namespace patina::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class Pipeline : public PatinaTest {
  protected:
    std::string quick_render(const std::string& scene, const std::string& more) const {
        return "render " + example(scene).string() + " --size 48x27 --no-png " + more;
    }
    json info_of(const std::string& picture) const {
        return json::parse(patina("image info " + picture + " --json").out);
    }
};

TEST_F(Pipeline, TheExampleSolvesChecksInspectsAndPlots) {
    ASSERT_EQ(
        patina("solve " + example("tio2_on_aluminium.toml").string() + " -o a.h5 --wavelengths 450:650:50").exit_code,
        0);
    const Outcome check = patina("check a.h5 --json");
    EXPECT_EQ(check.exit_code, 0) << check.out;
    EXPECT_TRUE(json::parse(check.out).at("passed"));
    EXPECT_THAT(patina("inspect a.h5").out,
                HasSubstr("Devore. Refractive indices of rutile"));  // each material names its publication
    for (const char* kind : {"lobe", "mueller", "dolp", "spectrum"}) {
        const Outcome plot = patina(std::string("plot a.h5 --kind ") + kind + " -o " + kind + ".svg");
        EXPECT_EQ(plot.exit_code, 0) << plot.err;
        EXPECT_GT(fs::file_size(folder() / (std::string(kind) + ".svg")), 2000u);
    }
    EXPECT_EQ(patina("plot a.h5 --kind lobe -o lobe.png").exit_code, 0);
}

// Nothing scatters in a varnish: over a mirror its body BRDF is zero, which is no reason to doubt it or to take more
// streams than the fewest.
TEST_F(Pipeline, AClearVarnishOnAMirrorIsBlackAndConverged) {
    write_file(folder() / "varnish.toml",
               "[interface]\ntype = \"smooth\"\n[[layers]]\nthickness_um = 20\nbinder = { n = 1.5, k = 1e-5 }\n"
               "[base]\ntype = \"metal\"\nmaterial = { n = 0.63, k = 7.04 }\n");
    const Outcome outcome = patina("solve varnish.toml -o varnish.h5 --wavelengths 550 --tolerance 1e-4 --json");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const json solved = json::parse(outcome.out);
    EXPECT_TRUE(solved.at("converged"));
    EXPECT_LT(solved.at("plan").at("streams"), 10);
    EXPECT_NEAR(solved.at("body")[0].at("reflectance_45_deg"), 0.0, 1e-12);
}

TEST_F(Pipeline, FieldReproducesARowOfSiewertsTables) {
    const Outcome outcome = patina("field " + example("siewert_problem_IIA.toml").string() +
                                   " --theta-i-deg 53.13010235415598 --theta-o-deg 60 --phi-deg 90 --tau 0 --json");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const json row = json::parse(outcome.out).at("radiance").at(0);
    EXPECT_EQ(row.at("direction"), "up");
    EXPECT_TRUE(row.at("wavelength_nm").is_null());
    // Siewert (2000), tables 4-7, u = -0.5: one unit of the last digit printed.
    const double published[] = {1.24626e-1, 5.12123e-3, -8.04140e-3, 7.49254e-5};
    const double unit[] = {1e-6, 1e-8, 1e-8, 1e-10};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(row.at("stokes").at(i).get<double>(), published[i], unit[i]);
}

// Paint polarizes most towards its rim, least where one looks along the normal; the sky reflects in it.
TEST_F(Pipeline, PaintedSpheresAreRenderedWithPolarization) {
    ASSERT_EQ(patina(quick_render("painted_spheres.xml", "-o s.exr --spp 16")).exit_code, 0);
    const json info = info_of("s.exr");
    EXPECT_EQ(info.at("not_finite"), 0);
    EXPECT_GT(info.at("mean")[0], 0.1);
    EXPECT_GT(info.at("mean_dolp"), 0.003);
    EXPECT_EQ(patina("image dolp s.exr -o dolp.png").exit_code, 0);
    EXPECT_EQ(patina("image aolp s.exr -o aolp.png").exit_code, 0);
    EXPECT_GT(fs::file_size(folder() / "dolp.png"), 200u);
}

// A view says what its colours mean, unless its pixels are wanted as data.
TEST_F(Pipeline, ViewsHaveLegendsUnlessToldOtherwise) {
    ASSERT_EQ(patina("render " + example("polar_balls.xml").string() + " -o s.exr --size 96x112 --spp 4").exit_code, 0);
    for (const std::string view : {"aolp", "type", "chirality", "docp", "dolp", "stokes", "noise"}) {
        ASSERT_EQ(patina("image " + view + " s.exr -o with.png").exit_code, 0) << view;
        ASSERT_EQ(patina("image " + view + " s.exr -o without.png --no-legend").exit_code, 0) << view;
        EXPECT_GT(io::read_png(folder() / "with.png").width, 96) << view;
        EXPECT_EQ(io::read_png(folder() / "without.png").width, 96) << view;
    }
}

TEST_F(Pipeline, LightTracingSaysWhatItLeavesOut) {
    const Outcome glass = patina(quick_render("polar_balls.xml", "-o g.exr --spp 1 --integrator light"));
    EXPECT_EQ(glass.exit_code, 0) << glass.err;
    EXPECT_THAT(glass.err, HasSubstr("light tracing leaves out"));
    EXPECT_EQ(patina(quick_render("polar_balls.xml", "-o p.exr --spp 1")).err.find("leaves out"), std::string::npos);
}

// Mitsuba's names of what has other names here.
TEST_F(Pipeline, MitsubasIntegratorsHaveTheirNames) {
    const std::string size = " --size 24x24 --spp 4 --no-png ";
    const std::string direct = R"(<integrator type="direct"><integer name="emitter_samples" value="2"/></integrator>)",
                      path = R"(<integrator type="path"><integer name="max_depth" value="2"/></integrator>)";
    std::string scene = read_file(example("polar_balls.xml"));
    const std::size_t begin = scene.find("<integrator"), end = scene.rfind("</integrator>") + 13;
    for (const auto& [name, integrator] : {std::pair("direct", direct), std::pair("path", path)}) {
        write_file(folder() / (std::string(name) + ".xml"), scene.substr(0, begin) + integrator + scene.substr(end));
        const Outcome outcome = patina(std::string("render ") + name + ".xml -o " + name + ".exr" + size);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    }
    EXPECT_EQ(info_of("direct.exr").at("mean"), info_of("path.exr").at("mean"));
    const std::string balls = "render " + example("polar_balls.xml").string() + size;
    ASSERT_EQ(patina(balls + "-o l.exr --integrator light").exit_code, 0);
    ASSERT_EQ(patina(balls + "-o p.exr --integrator ptracer").exit_code, 0);
    EXPECT_EQ(info_of("l.exr").at("mean"), info_of("p.exr").at("mean"));
}

TEST_F(Pipeline, AMitsubaSceneRendersUnmodifiedAndWithMitsubasChannelNames) {
    const Outcome outcome = patina("render " + example("polar_balls.xml").string() +
                                   " -o b.exr --size 32x32 --spp 4 --stokes-rgb --no-png");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(read_file(folder() / "b.exr"), HasSubstr("S3.B"));
}

TEST_F(Pipeline, TheSameSeedGivesTheSameBitsOnOneAndTwoThreads) {
    const std::string scene = example("polar_balls.xml").string();
    for (const char* threads : {"1", "2"})
        ASSERT_EQ(
            patina("render " + scene + " -o t" + threads + ".exr --size 40x40 --spp 8 --seed 7 --no-png -j " + threads)
                .exit_code,
            0);
    const json difference = json::parse(patina("image diff t1.exr t2.exr --json").out);
    for (const json& component : difference.at("stokes")) EXPECT_EQ(component.at("largest"), 0.0);
}

TEST_F(Pipeline, AnInterruptedRenderKeepsItsPicture) {
    const std::string command = "cd '" + folder().string() + "' && timeout -s INT 4 '" + PATINA_BINARY +
                                "' -q render '" + example("polar_balls.xml").string() +
                                "' -o i.exr --size 64x64 --spp 1000000 --no-png >/dev/null 2>&1; echo $? > code";
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(read_file(folder() / "code"), "124\n");  // timeout's own code: it had to stop the program
    ASSERT_TRUE(fs::exists(folder() / "i.exr"));
    EXPECT_GT(info_of("i.exr").at("mean")[0], 0.1);
}

struct BadScene {
    const char* name;
    const char* body;
    const char* message;
};

void PrintTo(const BadScene& scene, std::ostream* os) {
    *os << scene.name;
}

class BadScenes : public PatinaTest, public ::testing::WithParamInterface<BadScene> {};

TEST_P(BadScenes, AreRefusedWithAPlaceAndAReason) {
    write_file(folder() / "bad.xml", GetParam().body);
    const Outcome outcome = patina("render bad.xml -o bad.exr --spp 1", 60);
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(GetParam().message));
    EXPECT_THAT(outcome.err, HasSubstr("bad.xml"));
    EXPECT_FALSE(fs::exists(folder() / "bad.exr"));
}

const BadScene bad_scenes[] = {
    {"Empty", "", "bad.xml"},
    {"Truncated", "<scene version=\"3.0.0\"><shape type=\"sphere\">", "bad.xml:1:"},
    {"UnknownShape", "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>\n<shape type=\"sfere\"/>\n</scene>",
     "did you mean \"sphere\"?"},
    {"UnknownProperty",
     "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>\n<shape type=\"sphere\">\n<float name=\"radios\" "
     "value=\"1\"/>\n</shape>\n</scene>",
     "did you mean \"radius\"?"},
    {"NotANumber",
     "<scene version=\"3.0.0\">\n<shape type=\"sphere\">\n<float name=\"radius\" value=\"big\"/>\n</shape>\n</scene>",
     "bad.xml:3:"},
    {"Nan",
     "<scene version=\"3.0.0\">\n<shape type=\"sphere\">\n<float name=\"radius\" value=\"nan\"/>\n</shape>\n</scene>",
     "bad.xml:3:"},
    {"MissingMesh",
     "<scene version=\"3.0.0\">\n<shape type=\"ply\">\n<string name=\"filename\" "
     "value=\"no.ply\"/>\n</shape>\n</scene>",
     "no.ply"},
    {"MissingRecipe",
     "<scene version=\"3.0.0\">\n<shape type=\"sphere\"><bsdf type=\"paint\">\n<string name=\"recipe\" "
     "value=\"no.toml\"/>\n</bsdf></shape>\n</scene>",
     "no.toml"},
    {"CyclicInclude", "<scene version=\"3.0.0\">\n<include filename=\"bad.xml\"/>\n</scene>", "bad.xml:2:"},
    {"UnknownReference", "<scene version=\"3.0.0\">\n<shape type=\"sphere\"><ref id=\"gold\"/></shape>\n</scene>",
     "gold"},
    {"ZeroRadius",
     "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>\n<shape type=\"sphere\">\n<float name=\"radius\" "
     "value=\"0\"/>\n</shape>\n</scene>",
     "radius"},
    {"NoSensor", "<scene version=\"3.0.0\">\n<shape type=\"sphere\"/>\n</scene>", "sensor"},
};

INSTANTIATE_TEST_SUITE_P(Scenes, BadScenes, ::testing::ValuesIn(bad_scenes),
                         [](const auto& param) { return param.param.name; });

TEST_F(Pipeline, AMillionCharactersInAnAttributeAreRefusedQuickly) {
    write_file(folder() / "long.xml",
               "<scene version=\"3.0.0\"><shape type=\"" + std::string(1'000'000, 'x') + "\"/></scene>");
    const Outcome outcome = patina("render long.xml -o x.exr", 20);
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_LT(outcome.err.size(), 2000u);
}

TEST_F(Pipeline, BrokenTablesAndPicturesAreRefused) {
    write_file(folder() / "noise.h5", "not an HDF5 file");
    write_file(folder() / "noise.exr", "not an EXR file");
    for (const char* command : {"check noise.h5", "inspect noise.h5", "plot noise.h5 -o x.svg",
                                "image dolp noise.exr -o x.png", "image info nowhere.exr"})
        EXPECT_EQ(patina(command, 30).exit_code, 3) << command;
    EXPECT_FALSE(fs::exists(folder() / "x.png"));
}

}  // namespace
}  // namespace patina::test
