// Scenes broken at random: each is refused with a reason, or renders without a pixel that is no number.

#include <filesystem>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "patina/core/error.h"
#include "patina/core/scratch_folder_for_tests.h"
#include "patina/io/mitsuba_xml.h"
#include "patina/jobs/render.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr const char* head = R"(<scene version="3.0.0">
<default name="index" value="1.5"/>
<integrator type="path">
<integer name="max_depth" value="5"/>
</integrator>
<sensor type="perspective">
<transform name="to_world">
<lookat origin="0.5, -4, 2" target="0, 0, 0.5" up="0, 0, 1"/>
</transform>
<float name="fov" value="40"/>
<float name="shutter_close" value="0.5"/>
<film type="hdrfilm">
<integer name="width" value="3"/>
<integer name="height" value="3"/>
<rfilter type="gaussian"/>
</film>
</sensor>
)";

// What the renderer knows, in three scenes.
const char* const bodies[] = {
    R"(<bsdf type="roughconductor" id="gold">
<string name="material" value="Au"/>
<float name="alpha" value="0.3"/>
</bsdf>
<shape type="sphere">
<point name="center" x="0" y="0" z="0.5"/>
<float name="radius" value="0.5"/>
<ref id="gold"/>
</shape>
<shape type="rectangle">
<transform name="to_world">
<scale value="3"/>
<rotate x="1" angle="5"/>
</transform>
<bsdf type="diffuse">
<texture type="checkerboard" name="reflectance">
<rgb name="color0" value="0.8, 0.2, 0.1"/>
<transform name="to_uv">
<scale x="4" y="4"/>
</transform>
</texture>
</bsdf>
</shape>
<shape type="disk">
<transform name="to_world">
<rotate y="1" angle="180"/>
<translate z="3"/>
</transform>
<emitter type="area">
<rgb name="radiance" value="4, 3, 2"/>
<string name="polarization" value="elliptical"/>
<float name="polarization_degree" value="0.7"/>
</emitter>
</shape>
</scene>
)",
    R"(<shape type="obj">
<string name="filename" value="roof.obj"/>
<bsdf type="dielectric">
<float name="int_ior" value="$index"/>
</bsdf>
</shape>
<shape type="ply" id="tile">
<string name="filename" value="tile.ply"/>
<boolean name="face_normals" value="true"/>
<bsdf type="twosided">
<bsdf type="plastic">
<spectrum name="diffuse_reflectance" value="400:0.1, 500:0.6, 700:0.3"/>
</bsdf>
</bsdf>
</shape>
<emitter type="spot">
<transform name="to_world">
<lookat origin="2, -2, 4" target="0, 0, 0" up="0, 0, 1"/>
</transform>
<float name="cutoff_angle" value="30"/>
<float name="intensity" value="20"/>
</emitter>
<emitter type="constant">
<string name="stokes" value="1, 0.2, 0.1, -0.3"/>
<spectrum name="radiance" type="blackbody">
<float name="temperature" value="5000"/>
<float name="scale" value="1e-13"/>
</spectrum>
</emitter>
</scene>
)",
    R"(<shape type="shapegroup" id="pair">
<shape type="cube">
<transform name="to_world">
<scale x="0.3" y="0.3" z="0.3"/>
</transform>
<bsdf type="blendbsdf">
<float name="weight" value="0.4"/>
<bsdf type="phong"/>
<bsdf type="roughdielectric">
<float name="alpha" value="0.2"/>
</bsdf>
</bsdf>
</shape>
</shape>
<shape type="instance">
<ref id="pair"/>
<animation name="to_world">
<transform time="0">
<translate x="-0.5" z="0.5"/>
</transform>
<transform time="0.4">
<rotate z="1" angle="40"/>
<translate x="0.5" z="0.5"/>
</transform>
</animation>
</shape>
<shape type="rectangle">
<transform name="to_world">
<matrix value="2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 1"/>
</transform>
<bsdf type="orennayar">
<float name="sigma" value="20"/>
</bsdf>
<sensor type="irradiancemeter"/>
</shape>
<emitter type="directional">
<vector name="direction" x="0.2" y="0.3" z="-1"/>
<float name="irradiance" value="2"/>
</emitter>
<emitter type="point">
<point name="position" x="0" y="0" z="2"/>
</emitter>
</scene>
)"};

class SceneFuzz : public testing::Test {
  protected:
    static constexpr const char* obj =
        "v -1 0 0\nv 1 0 0\nv 0 1 1\nv 0 -1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n"
        "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 4/3/1 2/2/1\n";
    static constexpr const char* ply =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
        "-2 -2 0\n2 -2 0\n2 2 0\n-2 2 0\n3 0 1 2\n3 0 2 3\n";

    void write(const char* name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    // Builds and renders; the message when it is refused, "" when all pixels are numbers.
    std::string outcome(const std::string& text, const char* integrator) const {
        std::vector<std::string> warnings;
        try {
            const auto tree = io::parse_mitsuba_scene(text, folder_ / "scene.xml");
            const auto scene = render::build_scene(*tree, jobs::scene_resources(warnings));
            render::RenderOptions options;
            options.size = {3, 3};
            options.samples_per_pixel = 1;
            options.integrator = integrator;
            const StokesImage image = render::render(*scene, options);
            for (float value : image.spectral) EXPECT_TRUE(std::isfinite(value)) << text;
            for (float value : image.rgb) EXPECT_TRUE(std::isfinite(value)) << text;
            return "";
        } catch (const Error& error) {
            EXPECT_NE(error.kind(), ErrorKind::runtime) << error.what() << "\n" << text.substr(0, 4000);
            return error.what();
        }
    }
    std::string mutated(std::string text, bool is_scene) {
        const int changes = 1 + static_cast<int>(random_() % 2);
        for (int i = 0; i < changes; ++i) mutate(text, is_scene);
        return text;
    }

    ScratchFolder folder_;
    std::mt19937 random_{20260};

  private:
    void mutate(std::string& text, bool is_scene) {
        static const char* const numbers[] = {"nan",    "inf",  "-inf", "-1",    "0",          "1e308", "-1e308",
                                              "1e-300", "1e30", "1e19", "1e-19", "2147483648", "1e",    "",
                                              "x",      "-0.0", "0.5",  "90",    "1e400",      "$index"};
        static const char* const words[] = {"sphere",        "cube",  "constant", "envmap",   "to_world",   "filename",
                                            "circular",      "mask",  "null",     "instance", "shapegroup", "normalmap",
                                            "radiancemeter", "paint", "thinlens", "area"};
        const std::size_t at = random_() % text.size();
        switch (random_() % (is_scene ? 7 : 5)) {
            case 0:
            case 1: {  // another number
                const std::size_t from = text.find_first_of("-0123456789", at);
                if (from == std::string::npos) return;
                const std::size_t to = std::min(text.find_first_not_of("-+.0123456789e", from), text.size());
                text.replace(from, to - from, numbers[random_() % std::size(numbers)]);
                return;
            }
            case 2: {  // a line left out
                const std::size_t from = text.rfind('\n', at), to = text.find('\n', at + 1);
                if (from != std::string::npos && to != std::string::npos) text.erase(from, to - from);
                return;
            }
            case 3: {  // a line twice
                const std::size_t from = text.rfind('\n', at), to = text.find('\n', at + 1);
                if (from != std::string::npos && to != std::string::npos) text.insert(to, text.substr(from, to - from));
                return;
            }
            case 4:  // another character
                text[at] = static_cast<char>(32 + random_() % 95);
                return;
            default: {  // another word
                const std::size_t quote = text.find("=\"", at);
                if (quote == std::string::npos) return;
                const std::size_t end = text.find('"', quote + 2);
                if (end != std::string::npos)
                    text.replace(quote + 2, end - quote - 2, words[random_() % std::size(words)]);
            }
        }
    }
};

TEST_F(SceneFuzz, BrokenScenesAreRefusedOrRendered) {
    write("roof.obj", obj);
    write("tile.ply", ply);
    for (const char* body : bodies) ASSERT_EQ(outcome(std::string(head) + body, "path"), "");
    int refused = 0;
    constexpr int rounds = 900;
    for (int round = 0; round < rounds; ++round) {
        const std::string text = mutated(std::string(head) + bodies[round % 3], true);
        refused += outcome(text, round % 2 ? "path" : "bidirectional").empty() ? 0 : 1;
        if (testing::Test::HasFailure()) return;
    }
    // The fuzz does something, and not only refusals.
    EXPECT_GT(refused, rounds / 5);
    EXPECT_LT(refused, rounds * 9 / 10);
}

TEST_F(SceneFuzz, BrokenMeshesAreRefusedOrRendered) {
    for (int round = 0; round < 300; ++round) {
        write("roof.obj", round % 2 ? mutated(obj, false) : obj);
        write("tile.ply", round % 2 ? ply : mutated(ply, false));
        outcome(std::string(head) + bodies[1], "path");
        if (testing::Test::HasFailure()) return;
    }
}

}  // namespace
}  // namespace patina
