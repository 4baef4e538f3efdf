// Broken scenes through the program: exit code 3, and words that say what and where.

#include "run_patina.h"
#include <sys/stat.h>

namespace patina::test {
namespace {

class BrokenScene : public PatinaTest {
  protected:
    // Line 2 of the scene is the first of `body`.
    std::string refused(const std::string& body) {
        write_file(folder() / "scene.xml", "<scene version=\"3.0.0\">\n" + body + "\n</scene>\n");
        const Outcome outcome = patina("render scene.xml -o out.exr --spp 1 --size 2x2", 60);
        EXPECT_EQ(outcome.exit_code, 3) << outcome.err.substr(0, 500);
        EXPECT_FALSE(fs::exists(folder() / "out.exr"));
        // Words for a person, whatever the file holds.
        EXPECT_LT(outcome.err.size(), 3000u);
        return outcome.err;
    }
    static bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

    const std::string camera = "<sensor type=\"perspective\"/>\n";  // one line
    const std::string light = "<emitter type=\"constant\"/>\n";     // one line
    const std::string both = camera + light;
};

TEST_F(BrokenScene, NamesWhatIsMissing) {
    EXPECT_PRED2(has, refused(""), "scene.xml:1:1: the scene has no sensor");
    EXPECT_PRED2(has, refused(light), "the scene has no sensor");
    EXPECT_PRED2(has, refused(camera), "the scene is dark");
    EXPECT_PRED2(has, refused(both + "<shape type=\"obj\">\n<string name=\"filename\" value=\"no.obj\"/>\n</shape>"),
                 "scene.xml:5:");
    EXPECT_PRED2(has, refused(both + "<emitter type=\"area\"/>"), "scene.xml:4:1: an area emitter needs a shape");
    EXPECT_PRED2(has, refused(both + "<include filename=\"scene.xml\"/>"), "includes itself");
    EXPECT_PRED2(has, refused(both + "<ref id=\"nobody\"/>"), "scene.xml:4:");
}

// A texture called as the picture's preview is: what was read is not written over.
TEST_F(BrokenScene, KeepsTheFilesItNeeds) {
    write_file(folder() / "start.xml", "<scene version=\"3.0.0\">\n" + both + "</scene>\n");
    ASSERT_EQ(patina("render start.xml -o out.exr --spp 1 --size 2x2", 60).exit_code, 0);
    fs::remove(folder() / "out.exr");
    EXPECT_PRED2(
        has,
        refused(both + "<texture type=\"bitmap\" id=\"t\"><string name=\"filename\" value=\"out.png\"/></texture>"),
        "scene.xml:4:");
}

TEST_F(BrokenScene, NamesGeometryThatIsNone) {
    write_file(folder() / "nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n");
    write_file(folder() / "flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    const auto mesh = [](const char* file) {
        return std::string("<shape type=\"obj\"><string name=\"filename\" value=\"") + file + "\"/></shape>";
    };
    const auto shape = [](const std::string& transform, const std::string& inside = "") {
        return "<shape type=\"rectangle\"><transform name=\"to_world\">" + transform + "</transform>" + inside +
               "</shape>";
    };
    const std::string lamp = "<emitter type=\"area\"/>";
    EXPECT_PRED2(has, refused(both + mesh("nan.obj")), "nan.obj:2");
    EXPECT_PRED2(has, refused(both + mesh("flat.obj")), "no triangle of the mesh has an area");
    EXPECT_PRED2(has, refused(both + shape("<scale x=\"0\"/>")), "scene.xml:4:");
    EXPECT_PRED2(has, refused(both + shape("<scale value=\"1e-30\"/>", lamp)), "scene.xml:4:");
    EXPECT_PRED2(has, refused(both + shape("<translate x=\"nan\"/>")), "scene.xml:4:");
    EXPECT_PRED2(has, refused(both + shape("<translate x=\"1e200\"/>")), "too far away");
    // The advice is one that helps: single precision holds the square of an area up to there.
    EXPECT_PRED2(has, refused(both + shape("<scale value=\"2e11\"/>", lamp)), "keep coordinates below 1e9");
    EXPECT_PRED2(has, refused(both + shape("<matrix value=\"1 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1\"/>")), "scene.xml:4:");
    EXPECT_PRED2(has, refused(both + "<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>"), "radius");
}

// Folders, pipes and devices would be opened and waited for.
TEST_F(BrokenScene, NamesWhatIsNoFile) {
    fs::create_directory(folder() / "folder.obj");
    ASSERT_EQ(::mkfifo((folder() / "pipe.obj").c_str(), 0600), 0);
    for (const char* name : {"folder.obj", "pipe.obj", "/dev/zero"})
        EXPECT_PRED2(
            has, refused(both + "<shape type=\"obj\">\n<string name=\"filename\" value=\"" + name + "\"/>\n</shape>"),
            std::string("\"") + name + "\" is no file");
}

// A float map may hold what no lamp is.
TEST_F(BrokenScene, NamesSurroundingsThatAreTooBright) {
    const float pixels[] = {1, 1, 1, 3e38f, 1, 1};
    write_file(folder() / "sun.pfm",
               "PF\n2 1\n-1.0\n" + std::string(reinterpret_cast<const char*>(pixels), sizeof pixels));
    EXPECT_PRED2(has,
                 refused(camera + "<emitter type=\"envmap\"><string name=\"filename\" value=\"sun.pfm\"/></emitter>"),
                 "pixel (1, 0) is negative, not finite or too bright");
}

// A scene that reads well and shows nothing is worth a word.
TEST_F(BrokenScene, WarnsOfABlackPicture) {
    const auto warning_of = [&](const std::string& body) {
        write_file(folder() / "scene.xml", "<scene version=\"3.0.0\">\n" + body + "\n</scene>\n");
        const Outcome outcome = patina("render scene.xml -o out.exr --spp 4 --size 4x4", 60);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err.substr(0, 500);
        return outcome.err;
    };
    const std::string dark = "<emitter type=\"constant\"><spectrum name=\"radiance\" value=\"0\"/></emitter>";
    const std::string around = "<shape type=\"sphere\"><float name=\"radius\" value=\"10\"/></shape>";
    EXPECT_PRED2(has, warning_of(camera + dark), "the picture is black");
    EXPECT_PRED2(has, warning_of(both + around), "the picture is black");
    EXPECT_FALSE(has(warning_of(both), "the picture is black"));
}

TEST_F(BrokenScene, SurvivesAbsurdSizes) {
    const std::string film =
        "<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" "
        "value=\"1000000000\"/></film></sensor>";
    EXPECT_PRED2(has, refused(light + film), "keep it between 1 and 65536");
    const std::string million(1000000, 'x');
    refused(both + "<shape type=\"" + million + "\"/>");
    refused(both + "<shape type=\"obj\"><string name=\"filename\" value=\"" + million + "\"/></shape>");
    refused(both + "<shape type=\"sphere\"><float name=\"radius\" value=\"" + million + "\"/></shape>");
    refused(both + "<shape type=\"sphere\"><string name=\"" + million + "\" value=\"1\"/></shape>");
    refused("<emitter type=\"constant\"><string name=\"polarization\" value=\"" + million + "\"/></emitter>" + camera);
    refused("<emitter type=\"constant\"><string name=\"stokes\" value=\"" + million + "\"/></emitter>" + camera);
    // A film that fits the numbers and no machine.
    write_file(folder() / "scene.xml", "<scene version=\"3.0.0\">\n" + both + "</scene>\n");
    EXPECT_EQ(patina("render scene.xml -o out.exr --size 65536x65536", 60).exit_code, 2);
}

}  // namespace
}  // namespace patina::test
