#include "patina/io/mitsuba_xml.h"

#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patina/core/files.h"
#include "patina/core/scratch_folder_for_tests.h"

namespace patina::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::shared_ptr<const Properties> parse(const std::string& body,
                                        const std::map<std::string, std::string>& parameters = {}) {
    return parse_mitsuba_scene("<scene version=\"3.0.0\">\n" + body + "\n</scene>", "scene.xml", parameters);
}

// The message of the Error(input) that reading `body` must end with.
std::string error_of(const std::string& body) {
    try {
        parse(body);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    return "no error";
}

SpectrumSpec spectrum_of(const std::string& element) {
    return *parse("<bsdf type=\"diffuse\">" + element + "</bsdf>")->only_child("bsdf")->spectrum("s");
}

Eigen::Matrix4d transform_of(const std::string& operations) {
    return parse("<shape type=\"cube\"><transform name=\"t\">" + operations + "</transform></shape>")
        ->only_child("shape")
        ->transform("t");
}

TEST(MitsubaXml, ReadsAPlainMitsubaSceneUnmodified) {
    const auto scene = read_mitsuba_scene(fs::path(PATINA_SOURCE_DIR) / "examples/polar_balls.xml", {{"spp", "16"}});
    EXPECT_EQ(scene->category, "scene");
    EXPECT_EQ(scene->children_of("shape").size(), 4u);
    EXPECT_EQ(scene->children_of("emitter").size(), 1u);

    const auto stokes = scene->only_child("integrator");
    EXPECT_EQ(stokes->type, "stokes");
    EXPECT_EQ(stokes->only_child("integrator")->type, "path");
    EXPECT_EQ(stokes->only_child("integrator")->integer("max_depth", 0), 8);

    // A parameter of the command line wins over the file's default, the others keep theirs.
    const auto sensor = scene->only_child("sensor");
    EXPECT_EQ(sensor->only_child("sampler")->integer("sample_count", 0), 16);
    EXPECT_EQ(sensor->only_child("film")->integer("width", 0), 256);
    EXPECT_EQ(sensor->only_child("film")->only_child("rfilter")->type, "box");
    EXPECT_EQ(sensor->number("fov"), 40);

    // The camera stands at its origin and looks at its target.
    const Eigen::Matrix4d camera = sensor->transform("to_world");
    const Eigen::Vector3d forward = (Eigen::Vector3d(0, 0.8, 0) - Eigen::Vector3d(0, 2.2, 6)).normalized();
    EXPECT_TRUE(camera.col(3).isApprox(Eigen::Vector4d(0, 2.2, 6, 1), 1e-15));
    EXPECT_TRUE(camera.col(2).head<3>().isApprox(forward, 1e-15));
    // Mitsuba's camera has +x to its left; with y up and looking along -z that is world -x.
    EXPECT_TRUE(camera.col(0).isApprox(Eigen::Vector4d(-1, 0, 0, 0), 1e-15));

    const auto gold = scene->children_of("shape")[1]->only_child("bsdf");
    EXPECT_EQ(gold->string("material"), "Au");
    EXPECT_EQ(gold->number("alpha"), 0.1);
}

TEST(MitsubaXml, LaterTransformsApplyAfterEarlierOnes) {
    // Rotate x by -90 degrees, then scale by 8, then move: the point (0,1,0) goes to (0,0,-1), (0,0,-8), (1,0,-8).
    const Eigen::Matrix4d matrix =
        transform_of("<rotate x='1' angle='-90'/><scale value='8'/><translate x='1' y='0'/>");
    const Eigen::Vector4d moved = matrix * Eigen::Vector4d(0, 1, 0, 1);
    // A rotation by 90 degrees in double is right to a rounding error of 8.
    EXPECT_LT((moved - Eigen::Vector4d(1, 0, -8, 1)).norm(), 1e-14);
}

TEST(MitsubaXml, MatricesAreRowMajorAndThreeByThreeIsLinear) {
    const Eigen::Matrix4d four = transform_of("<matrix value='1 0 0 5, 0 1 0 6, 0 0 1 7, 0 0 0 1'/>");
    EXPECT_EQ(four.col(3), Eigen::Vector4d(5, 6, 7, 1));
    const Eigen::Matrix4d three = transform_of("<matrix value='1 2 0 0 1 0 0 0 1'/>");
    EXPECT_EQ(three(0, 1), 2);
    EXPECT_EQ(three.col(3), Eigen::Vector4d(0, 0, 0, 1));
}

TEST(MitsubaXml, ScalarsKeepTheirTypes) {
    const auto node = parse(
                          "<shape type='x'><integer name='i' value='-3'/><float name='f' value='+1.5e-1'/>"
                          "<boolean name='b' value='true'/><string name='s' value='a &lt; b'/>"
                          "<point name='p' x='1' z='-2'/><vector name='v' value='1, 2 3'/></shape>")
                          ->only_child("shape");
    EXPECT_EQ(node->integer("i", 0), -3);
    EXPECT_EQ(node->number("f"), 0.15);
    EXPECT_TRUE(node->boolean("b", false));
    EXPECT_EQ(node->string("s"), "a < b");
    EXPECT_EQ(node->vector("p", {}), Eigen::Vector3d(1, 0, -2));
    EXPECT_EQ(node->vector("v", {}), Eigen::Vector3d(1, 2, 3));
}

TEST(MitsubaXml, ReadsEverySpectrumForm) {
    using Kind = SpectrumSpec::Kind;
    EXPECT_EQ(spectrum_of("<spectrum name='s' value='0.5'/>").values, std::vector<double>{0.5});

    const auto pairs = spectrum_of("<spectrum name='s' value='400:1, 500:2 600:0.5'/>");
    EXPECT_EQ(pairs.kind, Kind::sampled);
    EXPECT_EQ(pairs.wavelengths_nm, (std::vector<double>{400, 500, 600}));
    EXPECT_EQ(pairs.values, (std::vector<double>{1, 2, 0.5}));

    const auto regular = spectrum_of(
        "<spectrum type='regular' name='s'><string name='values' value='1, 2, 3'/>"
        "<float name='wavelength_min' value='400'/><float name='wavelength_max' value='600'/></spectrum>");
    EXPECT_EQ(regular.wavelengths_nm, (std::vector<double>{400, 500, 600}));
    const auto short_regular =
        spectrum_of("<spectrum name='s' value='1 2 3' wavelength_min='400' wavelength_max='600'/>");
    EXPECT_EQ(short_regular.wavelengths_nm, regular.wavelengths_nm);

    const auto irregular = spectrum_of(
        "<spectrum type='irregular' name='s'><string name='wavelengths' value='400, 700'/>"
        "<string name='values' value='.1, .2'/></spectrum>");
    EXPECT_EQ(irregular.wavelengths_nm, (std::vector<double>{400, 700}));

    const auto blackbody =
        spectrum_of("<spectrum type='blackbody' name='s'><float name='temperature' value='5000'/></spectrum>");
    EXPECT_EQ(blackbody.kind, Kind::blackbody);
    EXPECT_EQ(blackbody.values, (std::vector<double>{5000, 1}));
    // D65 is what an emitter of white rgb shines with.
    const auto d65 = spectrum_of("<spectrum type='d65' name='s'><float name='scale' value='2'/></spectrum>");
    EXPECT_EQ(d65.kind, Kind::rgb);
    EXPECT_EQ(d65.values, (std::vector<double>{2, 2, 2}));

    const auto rgb = spectrum_of("<rgb name='s' value='0.1, 0.2, 0.3'/>");
    EXPECT_EQ(rgb.kind, Kind::rgb);
    EXPECT_EQ(rgb.values, (std::vector<double>{0.1, 0.2, 0.3}));
    // Encoded 0x80 is 0.2158605 linear (IEC 61966-2-1).
    EXPECT_NEAR(spectrum_of("<rgb name='s' value='#8000ff'/>").values[0], 0.2158605, 1e-7);
}

TEST(MitsubaXml, ParametersAreReplacedInBracesAndByTheLongestKnownName) {
    const auto node =
        parse(
            "<default name='res' value='25'/><default name='resx' value='7'/><default name='copy' value='${res}6'/>"
            "<film type='f'><string name='a' value='$resx_$res${res}1'/><integer name='b' value='$copy'/></film>")
            ->only_child("film");
    EXPECT_EQ(node->string("a"), "7_25251");
    EXPECT_EQ(node->integer("b", 0), 256);
}

TEST(MitsubaXml, TakesWhatPythonWritesAndSpectraOfOneNumber) {
    const auto node = parse(
                          "<bsdf type='a'><boolean name='t' value='True'/><boolean name='f' value=' FALSE '/>"
                          "<spectrum name='n' value='45'/><spectrum name='s' value='400:1, 500:2'/></bsdf>")
                          ->only_child("bsdf");
    EXPECT_TRUE(node->boolean("t", false));
    EXPECT_FALSE(node->boolean("f", true));
    EXPECT_EQ(node->number("n"), 45);
    EXPECT_THROW(node->number("s"), Error);
}

TEST(MitsubaXml, ReferencesShareTheNodeEvenBeforeItsDefinition) {
    const auto scene = parse(
        "<shape type='sphere'><ref id='gold' name='bsdf'/></shape><bsdf type='diffuse' id='gold'/>"
        "<alias id='gold' as='yellow'/><shape type='cube'><ref id='yellow'/></shape>");
    const auto gold = scene->only_child("bsdf");
    EXPECT_EQ(scene->children_of("shape")[0]->named_child("bsdf"), gold);
    EXPECT_EQ(scene->children_of("shape")[1]->only_child("bsdf"), gold);
}

TEST(MitsubaXml, IncludesResolveBesideTheIncludingFileAndShareParameters) {
    const ScratchFolder folder;
    folder.write("parts/red.spd", "# nm value\n400 0.1\n700, 0.9\n");
    folder.write("parts/materials.xml",
                 "<scene version='3.0.0'><bsdf type='diffuse' id='$name'>"
                 "<spectrum name='s' filename='red.spd'/></bsdf></scene>");
    const auto path = folder.write("scene.xml",
                                   "<scene version='3.0.0'><default name='name' value='red'/>"
                                   "<include filename='parts/materials.xml'/>"
                                   "<shape type='sphere'><ref id='red'/></shape></scene>");
    const auto bsdf = read_mitsuba_scene(path)->only_child("shape")->only_child("bsdf");
    EXPECT_EQ(bsdf->spectrum("s")->values, (std::vector<double>{0.1, 0.9}));
}

TEST(MitsubaXml, FileNamesBecomePathsOfExistingFiles) {
    const ScratchFolder folder;
    folder.write("meshes/a.ply", "x");
    const auto path = folder.write("scene.xml",
                                   "<scene version='3.0.0'><path value='meshes'/><shape type='ply'>"
                                   "<string name='filename' value='a.ply'/></shape></scene>");
    EXPECT_TRUE(fs::exists(read_mitsuba_scene(path)->only_child("shape")->string("filename")));
    EXPECT_THAT(error_of("<shape type='ply'><string name='filename' value='gone.ply'/></shape>"),
                HasSubstr("scene.xml:2:50: there is no file \"gone.ply\""));
}

TEST(MitsubaXml, APropertyGivenAgainInAnIncludeIsRefused) {
    const ScratchFolder folder;
    folder.write("b.xml", "<scene version='3.0.0'><float name='x' value='2'/></scene>");
    const auto path =
        folder.write("a.xml", "<scene version='3.0.0'><float name='x' value='1'/><include filename='b.xml'/></scene>");
    EXPECT_THROW(read_mitsuba_scene(path), Error);
}

TEST(MitsubaXml, CyclicIncludesAreRefused) {
    const ScratchFolder folder;
    folder.write("b.xml", "<scene version='3.0.0'><include filename='a.xml'/></scene>");
    const auto path = folder.write("a.xml", "<scene version='3.0.0'><include filename='b.xml'/></scene>");
    EXPECT_THROW(read_mitsuba_scene(path), Error);
}

TEST(MitsubaXml, ErrorsNamePlaceReasonAndRemedy) {
    const std::pair<std::string, std::string> cases[] = {
        {"<shape type='sphere'>\n  <float name='radius' value='1O'/></shape>",
         "scene.xml:3:31: value \"1O\" is not a number"},
        {"<float name='a' value='nan'/>", "not a finite number"},
        {"<float name='a' value='1e999'/>", "out of range"},
        {"<integer name='a' value='1.5'/>", "\"1.5\" is not an integer"},
        {"<boolean name='a' value='yes'/>", "write true or false"},
        {"<shpe type='sphere'/>", "did you mean \"shape\"?"},
        {"<float nmae='a' value='1'/>", "did you mean \"name\"?"},
        {"<float name='a' name='b' value='1'/>", "is given twice"},
        {"<float name='a' value='1'/><float name='a' value='2'/>", "property \"a\" is given twice"},
        {"<float name='a' value='$sp'/><default name='spp' value='1'/>", "the scene defines none"},
        {"<default name='spp' value='1'/><float name='a' value='$ssp'/>", "did you mean \"spp\"?"},
        {"<float name='a' value='${spp'/>", "no closing brace"},
        {"<ref id='gold'/><bsdf type='a' id='golf'/>", "did you mean \"golf\"?"},
        {"<bsdf type='a' id='x'/><bsdf type='a' id='x'/>", "id \"x\" is given twice (first at scene.xml:2:1)"},
        {"<bsdf type='a' id='x'><ref id='y'/></bsdf><bsdf type='b' id='y'><ref id='x'/></bsdf>", "contains itself"},
        {"<bsdf id='x'/>", "needs an attribute \"type\""},
        {"<spectrum name='s' value='400:1, 300:2'/>", "must ascend"},
        {"<spectrum name='s' value='1 2 3'/>", "without wavelengths"},
        {"<spectrum name='s' type='blackbdy'/>", "did you mean \"blackbody\"?"},
        {"<rgb name='s' value='1 2'/>", "has 2 numbers"},
        {"<transform name='t'><scale value='0'/></transform>", "flattens space"},
        {"<transform name='t'><lookat origin='1,1,1' target='1,1,1' up='0,1,0'/></transform>", "looks nowhere"},
        {"<transform name='t'><lookat origin='0,0,0' target='0,1,0' up='0,1,0'/></transform>", "along its up vector"},
        {"<transform name='t'><rotate angle='3'/></transform>", "no length"},
        {"<transform name='t'><matrix value='1 2 3'/></transform>", "16 or 9"},
        {"<shape type='a'>stray</shape>", "text \"stray\" inside <shape>"},
        {"<include filename='no.xml'/>", "there is no file \"no.xml\""},
        {"<shape type='a'>", "not well-formed XML"},
    };
    for (const auto& [body, expected] : cases) EXPECT_THAT(error_of(body), HasSubstr(expected)) << body;
}

TEST(MitsubaXml, RefusesOtherVersionsAndUnusedParameters) {
    EXPECT_THROW(parse_mitsuba_scene("<scene version='0.6.0'/>", "a.xml"), Error);
    EXPECT_THROW(parse_mitsuba_scene("<scene/>", "a.xml"), Error);
    EXPECT_THROW(parse_mitsuba_scene("", "a.xml"), Error);
    EXPECT_THROW(parse_mitsuba_scene(std::string("<scene version='3.0.0'>\0</scene>", 32), "a.xml"), Error);
    EXPECT_THROW(parse("", {{"spp", "4"}}), Error);
}

TEST(MitsubaXml, HostileInputEndsSoonWithAnError) {
    const std::string million(1000000, '1');
    EXPECT_THAT(error_of("<float name='a' value='" + million + "'/>"), HasSubstr("1000000 characters"));
    EXPECT_LT(error_of("<float name='a' value='" + million + "'/>").size(), 500u);
    EXPECT_LT(error_of("<float name='" + million + "' value='1'/>").size(), 500u);
    EXPECT_LT(error_of("<" + std::string(1000000, 'a') + "/>").size(), 2000u);

    // A hundred thousand nested elements.
    std::string deep;
    for (int i = 0; i < 100000; ++i) deep += "<bsdf type='a'>";
    for (int i = 0; i < 100000; ++i) deep += "</bsdf>";
    EXPECT_THAT(error_of(deep), HasSubstr("nested too deeply"));

    // Thirty doubling references unfold to 2^30 nodes; a chain of a thousand is a thousand deep.
    std::string doubling, chain;
    for (int i = 0; i < 30; ++i)
        doubling += fmt::format("<bsdf type='a' id='n{0}'><ref id='n{1}'/><ref id='n{1}'/></bsdf>", i, i + 1);
    EXPECT_THAT(error_of(doubling + "<bsdf type='a' id='n30'/>"), HasSubstr("unfolds beyond reason"));
    for (int i = 0; i < 1000; ++i) chain += fmt::format("<bsdf type='a' id='n{}'><ref id='n{}'/></bsdf>", i, i + 1);
    EXPECT_THAT(error_of(chain + "<bsdf type='a' id='n1000'/>"), HasSubstr("too deeply"));

    // Entities are never expanded, and defaults made of defaults cannot explode.
    const std::string bomb =
        "<!DOCTYPE s [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;&a;'>]>"
        "<scene version='3.0.0'><string name='x' value='&b;'/></scene>";
    EXPECT_EQ(parse_mitsuba_scene(bomb, "bomb.xml")->string("x"), "&b;");
    std::string defaults = "<default name='p0' value='0123456789'/>";
    for (int i = 1; i < 40; ++i)
        defaults += fmt::format("<default name='p{}' value='${{p{}}}${{p{}}}'/>", i, i - 1, i - 1);
    EXPECT_THAT(error_of(defaults), HasSubstr("too long"));
}

// Every damaged copy of a good scene is read or refused with an Error; nothing else escapes.
TEST(MitsubaXml, SurvivesThousandsOfMutations) {
    const std::string good = read_text_file(fs::path(PATINA_SOURCE_DIR) / "examples/polar_balls.xml");
    const std::string alphabet = "<>/\"'=$&;#{}-., 019eE\n\x01\xff!?[]abcxyz";
    std::mt19937 random(1);
    const auto below = [&](std::size_t bound) { return random() % bound; };
    int refused = 0;
    constexpr int copies = 4000;
    for (int copy = 0; copy < copies; ++copy) {
        std::string text = good;
        for (std::size_t edits = 1 + below(4); edits > 0 && !text.empty(); --edits) {
            const std::size_t at = below(text.size()), length = 1 + below(20);
            const auto kind = below(4);
            if (kind == 0) text[at] = alphabet[below(alphabet.size())];
            if (kind == 1) text.erase(at, length);
            if (kind == 2) text.insert(at, text.substr(below(text.size()), length));
            if (kind == 3) text.resize(std::max<std::size_t>(at, 1));
        }
        try {
            parse_mitsuba_scene(text, "mutated.xml");
        } catch (const Error&) {
            ++refused;
        }
    }
    // Cutting a quarter of the edits' tails alone refuses well over half; harmless edits (numbers, comments) remain.
    EXPECT_GT(refused, copies / 2);
    EXPECT_LT(refused, copies);
}

}  // namespace
}  // namespace patina::io
