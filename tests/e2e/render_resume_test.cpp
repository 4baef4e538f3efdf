// `patina render --resume`: a render that was stopped, however roughly, ends in the bits it would have had.

#include "run_patina.h"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patina::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

// Glass, a rough metal, a mesh and a lamp, at a size at which a pass takes some hundredths of a second.
const std::string scene = R"(<scene version="3.0.0">
<default name="alpha" value="0.3"/>
<integrator type="path"><integer name="max_depth" value="5"/></integrator>
<sensor type="perspective"><transform name="to_world"><lookat origin="0,-5,2" target="0,0,0.5" up="0,0,1"/></transform>
<film type="hdrfilm"><integer name="width" value="48"/><integer name="height" value="32"/></film></sensor>
<shape type="sphere"><point name="center" value="-0.6,0,0.5"/><float name="radius" value="0.5"/><bsdf type="dielectric"/></shape>
<shape type="sphere"><point name="center" value="0.6,0,0.5"/><float name="radius" value="0.5"/>
<bsdf type="roughconductor"><float name="alpha" value="$alpha"/></bsdf></shape>
<shape type="cube"><transform name="to_world"><scale value="0.3"/><rotate x="1" y="2" z="3" angle="40"/><translate y="-1.2" z="0.6"/></transform>
<bsdf type="plastic"/></shape>
<shape type="rectangle"><transform name="to_world"><scale value="4"/></transform><bsdf type="diffuse"/></shape>
<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="180"/><translate z="3"/></transform>
<emitter type="area"><float name="radiance" value="5"/></emitter></shape>
</scene>)";

class RenderResume : public PatinaTest {
  protected:
    RenderResume() { write_file(folder() / "s.xml", scene); }

    // Starts a render of many samples, sends the signal when the first checkpoint is there (or after a moment), and
    // returns the exit code as a shell sees it.
    int start_and_stop(const std::string& signal, const std::string& options) const {
        std::string script = "cd '";
        script += folder().string() + "'; '" + PATINA_BINARY + "' -q render s.xml -o out.exr " + options;
        script += " >/dev/null 2>&1 & pid=$!; for i in $(seq 1000); do if [ -e out.checkpoint ]; then break; fi; ";
        script += "sleep 0.01; done; kill -" + signal + " $pid; wait $pid";
        const int status = std::system(script.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    std::string samples_of(const std::string& picture) const {
        return json::parse(patina("image info " + picture + " --json").out).at("metadata").at("samples_per_pixel");
    }
    void expect_same_bits(const std::string& one, const std::string& other) const {
        const json difference = json::parse(patina("image diff " + one + " " + other + " --json").out);
        for (const json& component : difference.at("stokes")) EXPECT_EQ(component.at("largest"), 0.0);
        EXPECT_EQ(difference.at("not_finite"), 0);
    }
};

TEST_F(RenderResume, AfterAKillTheBitsAreThoseOfOneRun) {
    for (const std::string integrator : {"path", "bidirectional"}) {
        const std::string options = "--no-png --integrator " + integrator;
        ASSERT_EQ(start_and_stop("KILL", options + " --checkpoint-every 0.05 --spp 100000"), 128 + 9);
        ASSERT_TRUE(fs::exists(folder() / "out.checkpoint"));
        EXPECT_FALSE(fs::exists(folder() / "out.exr"));

        // Some more samples than were done: not a multiple of a pass.
        const std::string state = read_file(folder() / "out.checkpoint"), key = "\"samples\":";
        const int done = std::stoi(state.substr(state.find(key) + key.size()));
        EXPECT_GE(done, 1);
        const std::string spp = " --spp " + std::to_string(done + 21);
        ASSERT_EQ(patina("render s.xml -o out.exr --resume " + options + spp).exit_code, 0);
        EXPECT_FALSE(fs::exists(folder() / "out.checkpoint"));
        ASSERT_EQ(patina("render s.xml -o whole.exr " + options + spp).exit_code, 0);
        expect_same_bits("out.exr", "whole.exr");
        fs::remove(folder() / "out.exr");
    }
}

TEST_F(RenderResume, AfterCtrlCThePictureIsThereAndPartsGoOn) {
    const std::string options = "--no-png --lpe direct=LDE --neumann 2";
    ASSERT_EQ(start_and_stop("INT", options + " --checkpoint-every 0.05 --spp 100000"), 130);
    ASSERT_TRUE(fs::exists(folder() / "out.exr"));
    const int done = std::stoi(samples_of("out.exr"));
    const std::string spp = " --spp " + std::to_string(done + 5);
    ASSERT_EQ(patina("render s.xml -o out.exr --resume " + options + spp).exit_code, 0);
    ASSERT_EQ(patina("render s.xml -o whole.exr " + options + spp).exit_code, 0);
    for (const char* part : {"", ".direct", ".neumann_01", ".neumann_rest"})
        expect_same_bits(std::string("out") + part + ".exr", std::string("whole") + part + ".exr");
}

TEST_F(RenderResume, SamplesCanBeAddedToAFinishedPicture) {
    ASSERT_EQ(patina("render s.xml -o out.exr --spp 8 --no-png --keep-checkpoint").exit_code, 0);
    ASSERT_EQ(patina("render s.xml -o out.exr --spp 40 --no-png --resume").exit_code, 0);
    ASSERT_EQ(patina("render s.xml -o whole.exr --spp 40 --no-png").exit_code, 0);
    expect_same_bits("out.exr", "whole.exr");

    // Fewer samples than there are cannot be had.
    ASSERT_EQ(patina("render s.xml -o out.exr --spp 8 --no-png --keep-checkpoint").exit_code, 0);
    const Outcome fewer = patina("render s.xml -o out.exr --spp 4 --no-png --resume");
    EXPECT_EQ(fewer.exit_code, 2);
    EXPECT_THAT(fewer.err, HasSubstr("has 8 samples per pixel already"));
}

TEST_F(RenderResume, IsRefusedForAnotherPicture) {
    const std::string command = "render s.xml -o out.exr --spp 4 --no-png --keep-checkpoint ";
    ASSERT_EQ(patina(command).exit_code, 0);
    const auto refused = [&](const std::string& more, const std::string& reason) {
        const Outcome outcome = patina(command + "--resume " + more);
        EXPECT_EQ(outcome.exit_code, 3) << more;
        EXPECT_THAT(outcome.err, HasSubstr(reason)) << more;
        EXPECT_THAT(outcome.err, HasSubstr("out.checkpoint")) << more;
    };
    refused("--size 24x16", "--size (not known, now 24x16)");
    refused("--seed 3", "--seed");
    refused("--integrator light", "--integrator");
    refused("--lpe a=LDE", "--lpe a");
    refused("-D alpha=0.4", "the scene or a file it names");

    // A byte of the films is wrong; the file is cut off; it is something else.
    const std::string whole = read_file(folder() / "out.checkpoint");
    std::string bad = whole;
    bad[bad.size() - 1000] ^= 1;
    write_file(folder() / "out.checkpoint", bad);
    refused("", "its hash is wrong");
    write_file(folder() / "out.checkpoint", whole.substr(0, whole.size() / 2));
    refused("", "ends too soon");
    write_file(folder() / "out.checkpoint", std::string(5000, 'x'));
    refused("", "does not begin as one");
}

TEST_F(RenderResume, WithoutACheckpointBeginsAnew) {
    const Outcome outcome = patina("render s.xml -o out.exr --spp 2 --no-png --resume");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("begins anew"));
}

}  // namespace
}  // namespace patina::test
