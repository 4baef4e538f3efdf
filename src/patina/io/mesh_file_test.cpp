#include "patina/io/mesh_file.h"

#include <bit>
#include <cstring>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patina/core/scratch_folder_for_tests.h"

namespace patina::io {
namespace {

using ::testing::HasSubstr;

template <class Reader>
std::string error_of(Reader read) {
    try {
        read();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    return "no error";
}

MeshFile obj(const std::string& text) {
    const ScratchFolder folder;
    return read_obj(folder.write("a.obj", text));
}
MeshFile ply(const std::string& text) {
    const ScratchFolder folder;
    return read_ply(folder.write("a.ply", text));
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

// Signed volume by the divergence theorem: 1/6 sum a . (b x c), positive for outward counter-clockwise faces.
double volume(const TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles)
        sum += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6.0;
    return sum;
}

TEST(ObjFile, AClosedCubeOfQuadsHasItsVolume) {
    std::string text;
    for (int i = 0; i < 8; ++i) text += fmt::format("v {} {} {}\n", i & 1, (i >> 1) & 1, i >> 2);
    text += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    const MeshFile file = obj(text);
    EXPECT_EQ(file.mesh.triangles.size(), 12u);
    EXPECT_EQ(file.mesh.positions.size(), 8u);
    EXPECT_TRUE(file.mesh.normals.empty());
    // Sums of products of zeros and ones are exact, the sixths are not.
    EXPECT_NEAR(volume(file.mesh), 1.0, 1e-6);
}

TEST(ObjFile, CornersWithDifferentNormalsAreDifferentVertices) {
    const MeshFile file =
        obj(square + "vt 0 0\nvt 1 1\nvn 0 0 2\nvn 0 1 0\nf 1/1/1 2/2/1 3/2/-2\nf 1/1/2 3/2/1 4//1 # a comment\n");
    EXPECT_EQ(file.mesh.positions.size(), 5u);  // vertex 1 twice
    EXPECT_EQ(file.mesh.uvs[1], Eigen::Vector2f(1, 1));
    EXPECT_EQ(file.mesh.normals[0], Eigen::Vector3f(0, 0, 1));  // normalized
    EXPECT_THAT(file.warnings, ::testing::ElementsAre(HasSubstr("1 vertices have no texture coordinate")));
}

TEST(ObjFile, MissingNormalsAreComputedAndFlatTrianglesLeftOut) {
    const MeshFile file = obj(square + "vn 0 0 0\nf 1//1 2//1 3//1\nf 1 1 2\nf 1 2 2\n");
    EXPECT_EQ(file.mesh.triangles.size(), 1u);
    EXPECT_EQ(file.mesh.normals[0], Eigen::Vector3f(0, 0, 1));
    EXPECT_EQ(file.warnings.size(), 2u);
}

TEST(ObjFile, ErrorsNameTheLine) {
    const std::pair<std::string, std::string> cases[] = {
        {square + "f 1 2 5\n", "a.obj:5: vertex 5 does not exist (4 are defined so far)"},
        {square + "f 0 1 2\n", "vertex 0 does not exist"},
        {square + "f -5 1 2\n", "vertex -5 does not exist"},
        {square + "f 1 2\n", "a face with 2 corners"},
        {square + "f 1/1 2/1 3/1\n", "texture coordinate 1 does not exist"},
        {"v 0 nan 0\n", "a.obj:1: number \"nan\" is not a finite number"},
        {"v 0 1e300 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n", "vertex 1 has a position that is not finite"},
        {"v 0 0\n", "2 numbers where 3 are expected"},
        {"hello\n", "unknown statement \"hello\""},
        {square, "has no face"},
        {square + "f 1 1 2\n", "no triangle of the mesh has an area"},
        {"", "has no face"},
    };
    for (const auto& [text, expected] : cases)
        EXPECT_THAT(error_of([&, t = text] { obj(t); }), HasSubstr(expected)) << text;
}

template <class T>
void append(std::string& bytes, T value, bool big_endian) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big_endian == (std::endian::native == std::endian::little)) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
}

std::string binary_square(bool big_endian) {
    std::string text = fmt::format(
        "ply\nformat binary_{}_endian 1.0\ncomment a square\nelement vertex 4\nproperty double x\n"
        "property float y\nproperty float z\nproperty uchar red\nproperty float s\nproperty float t\n"
        "element edge 1\nproperty list uchar short pair\nelement face 1\n"
        "property uchar flag\nproperty list uchar int vertex_indices\nend_header\n",
        big_endian ? "big" : "little");
    for (int i = 0; i < 4; ++i) {
        append<double>(text, i == 1 || i == 2, big_endian);
        append<float>(text, i >= 2 ? 1.f : 0.f, big_endian);
        append<float>(text, 0.25f, big_endian);
        append<std::uint8_t>(text, 200, big_endian);
        append<float>(text, 0.5f, big_endian);
        append<float>(text, float(i), big_endian);
    }
    append<std::uint8_t>(text, 2, big_endian);
    append<std::int16_t>(text, 0, big_endian);
    append<std::int16_t>(text, 1, big_endian);
    append<std::uint8_t>(text, 7, big_endian);
    append<std::uint8_t>(text, 4, big_endian);
    for (int i = 0; i < 4; ++i) append<std::int32_t>(text, i, big_endian);
    return text;
}

TEST(PlyFile, BothByteOrdersAndTextGiveTheSameMesh) {
    const std::string ascii =
        "ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n"
        "property float u\r\nproperty float v\r\nelement face 1\r\nproperty list uchar int "
        "vertex_index\r\nend_header\r\n"
        "0 0 .25 .5 0\r\n1 0 .25 .5 1\r\n1 1 .25 .5 2\r\n0 1 .25 .5 3\r\n4 0 1 2 3\r\n";
    const TriangleMesh little = ply(binary_square(false)).mesh, big = ply(binary_square(true)).mesh,
                       text = ply(ascii).mesh;
    EXPECT_EQ(little.triangles.size(), 2u);
    for (const TriangleMesh& mesh : {big, text}) {
        EXPECT_EQ(mesh.positions, little.positions);
        EXPECT_EQ(mesh.uvs, little.uvs);
        EXPECT_EQ(mesh.triangles, little.triangles);
    }
    EXPECT_EQ(little.positions[2], Eigen::Vector3f(1, 1, 0.25f));
}

TEST(PlyFile, ErrorsNameThePlace) {
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
    const std::pair<std::string, std::string> cases[] = {
        {"plx\n", "a.ply:1: not a PLY file"},
        {"ply\nformat ascii 1.0\n", "no end_header"},
        {"ply\nformat ebcdic 1.0\n", "unknown format"},
        {header + corners + "3 0 1 3\n", "names vertex 3"},
        {header + corners + "3 0 1 -1\n", "-1 is no vertex index"},
        {header + corners + "2 0 1\n", "has 2 corners"},
        {header + corners, "truncated"},
        {header + "0 0 inf\n", "a.ply:10: number \"inf\" is not a finite number"},
        {"ply\nformat ascii 1.0\nelement vertex 999999999999\nproperty float x\nend_header\n1\n",
         "999999999999 elements"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nend_header\n", "unknown number type"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n", "need properties x, y and z"},
    };
    for (const auto& [text, expected] : cases)
        EXPECT_THAT(error_of([&, t = text] { ply(t); }), HasSubstr(expected)) << text;
}

// Every cut and every damaged copy is read or refused with an Error.
TEST(PlyFile, SurvivesTruncationAndMutation) {
    const std::string good = binary_square(false);
    const ScratchFolder folder;
    std::mt19937 random(2);
    for (std::size_t copy = 0; copy < good.size() + 500; ++copy) {
        std::string text = good.substr(0, copy < good.size() ? copy : good.size());
        if (copy >= good.size()) text[random() % text.size()] = static_cast<char>(random());
        try {
            read_ply(folder.write("a.ply", text));
            EXPECT_GE(copy, good.size());  // every true prefix lacks something
        } catch (const Error&) {
        }
    }
}

TEST(ObjFile, SurvivesMutation) {
    const std::string good = square + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4//1\nf -1 -2 -3\n";
    const std::string alphabet = "vfn/-. 019e\n#\\\xff";
    const ScratchFolder folder;
    std::mt19937 random(4);
    for (int copy = 0; copy < 1000; ++copy) {
        std::string text = good;
        for (int edit = 0; edit < 3; ++edit) text[random() % text.size()] = alphabet[random() % alphabet.size()];
        try {
            const TriangleMesh mesh = read_obj(folder.write("a.obj", text)).mesh;
            for (const auto& triangle : mesh.triangles)
                for (const std::uint32_t corner : triangle) EXPECT_LT(corner, mesh.positions.size());
        } catch (const Error&) {
        }
    }
}

// sRGB 188 is linear 0.503 (IEC 61966-2-1); other whole numbers stand for 0 .. 1.
TEST(PlyFile, OtherPropertiesAreAttributesByMitsubasNames) {
    const MeshFile file =
        ply("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty float heat\n"
            "property float flow_x\nproperty float flow_y\nproperty float flow_z\nproperty float alone_0\n"
            "element face 1\nproperty list uchar int vertex_indices\nproperty float ink_r\nproperty float ink_g\n"
            "property float ink_b\nproperty ushort age\nend_header\n"
            "0 0 0 188 0 255 9 0.5 1 2 3 7\n1 0 0 0 0 0 9 0.6 4 5 6 8\n1 1 0 0 0 0 9 0.7 0 0 0 9\n0 1 0 0 0 0 9 0.8 0 "
            "0 0 10\n"
            "4 0 1 2 3 0.1 0.2 0.3 65535\n");
    const auto& all = file.mesh.attributes;
    ASSERT_EQ(all.size(), 6u);
    EXPECT_EQ(all[0].name, "vertex_color");
    ASSERT_EQ(all[0].values.size(), 12u);
    EXPECT_NEAR(all[0].values[0], 0.5029, 1e-4);
    EXPECT_EQ(all[0].values[2], 1);
    EXPECT_EQ(all[1].name, "vertex_heat");
    EXPECT_EQ(all[1].values, (std::vector<float>{0.5f, 0.6f, 0.7f, 0.8f}));
    EXPECT_EQ(all[2].name, "vertex_flow");
    EXPECT_EQ(all[2].channels, 3);
    EXPECT_EQ(all[2].values[5], 6);
    EXPECT_EQ(all[3].name, "vertex_alone");
    // Two triangles of one quad share its values.
    EXPECT_EQ(all[4].name, "face_ink_color");
    EXPECT_EQ(all[4].values, (std::vector<float>{0.1f, 0.2f, 0.3f, 0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(all[5].name, "face_age");
    EXPECT_EQ(all[5].values, (std::vector<float>{1, 1}));
}

TEST(PlyFile, ATriangleWithoutAreaTakesItsAttributesAway) {
    const MeshFile file =
        ply("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 3\nproperty float a\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n0 1 0\n1 3 0 1 2\n2 3 0 1 1\n3 3 2 1 0\n");
    EXPECT_EQ(file.mesh.attributes.at(0).values, (std::vector<float>{1, 3}));
}

TEST(ObjFile, NumbersBehindAPositionAreItsColour) {
    const MeshFile file = obj("v 0 0 0\nv 1 0 0 1 0 0.735358\nv 0 1 0 0 1 0\nf 3 2 1\n");
    ASSERT_EQ(file.mesh.attributes.size(), 1u);
    EXPECT_EQ(file.mesh.attributes[0].name, "vertex_color");
    const std::vector<float>& c = file.mesh.attributes[0].values;
    ASSERT_EQ(c.size(), 9u);  // in the order of first use; white where none is given
    EXPECT_EQ(c[1], 1);
    EXPECT_EQ(c[3], 1);
    EXPECT_NEAR(c[5], 0.5, 1e-5);  // 0.735358 of sRGB
    EXPECT_EQ(c[8], 1);
}

// Two meshes in the format of Mitsuba's plugin `serialized`: stored without compression by zlib (RFC 1950, 1951), after
// which come their offsets.
template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}
std::string stored_by_zlib(const std::string& bytes) {
    std::uint32_t a = 1, b = 0;
    for (const char c : bytes) a = (a + static_cast<unsigned char>(c)) % 65521, b = (b + a) % 65521;
    std::string packed("\x78\x01\x01", 3);
    append(packed, static_cast<std::uint16_t>(bytes.size()));
    append(packed, static_cast<std::uint16_t>(~bytes.size()));
    packed += bytes;
    for (const std::uint32_t half : {b, a})
        packed += static_cast<char>(half >> 8), packed += static_cast<char>(half & 255);
    return packed;
}
template <class Real>
std::string serialized_triangle(Real width, std::uint32_t flags, bool with_name) {
    std::string mesh;
    append(mesh, flags);
    if (with_name) mesh += std::string("a name\0", 7);
    append(mesh, std::uint64_t{3});
    append(mesh, std::uint64_t{1});
    for (const Real x : {Real(0), Real(0), Real(0), width, Real(0), Real(0), Real(0), width, Real(0)}) append(mesh, x);
    if (flags & 0x8)
        for (int channel = 0; channel < 9; ++channel) append(mesh, static_cast<Real>(channel / 8.0));
    for (const std::uint32_t corner : {0u, 1u, 2u}) append(mesh, corner);
    return stored_by_zlib(mesh);
}
std::string serialized_file(std::uint16_t version) {
    std::string file;
    std::vector<std::uint64_t> offsets;
    for (const std::string& mesh :
         {serialized_triangle<float>(2, 0x1008, version == 4), serialized_triangle<double>(3, 0x2000, version == 4)}) {
        offsets.push_back(file.size());
        append(file, std::uint16_t{0x041c});
        append(file, version);
        file += mesh;
    }
    for (const std::uint64_t offset : offsets)
        version == 4 ? append(file, offset) : append(file, static_cast<std::uint32_t>(offset));
    append(file, std::uint32_t{2});
    return file;
}

TEST(SerializedFile, HoldsSeveralMeshesOfEitherPrecision) {
    const ScratchFolder folder;
    for (const std::uint16_t version : {std::uint16_t{3}, std::uint16_t{4}}) {
        const auto path = folder.write("a.serialized", serialized_file(version));
        const TriangleMesh first = read_mesh(path, "serialized 0").mesh, second = read_mesh(path, "serialized 1").mesh;
        EXPECT_EQ(first.positions.at(1), Eigen::Vector3f(2, 0, 0));
        EXPECT_EQ(second.positions.at(2), Eigen::Vector3f(0, 3, 0));
        ASSERT_EQ(first.attributes.size(), 1u);
        EXPECT_EQ(first.attributes[0].values.at(4), 0.5f);
        EXPECT_TRUE(second.attributes.empty());
        EXPECT_EQ(second.triangles.size(), 1u);
    }
}

TEST(SerializedFile, BrokenOnesAreRefused) {
    const ScratchFolder folder;
    const std::string good = serialized_file(4);
    for (std::size_t size = 0; size < good.size(); size += 5)
        EXPECT_THROW(read_serialized(folder.write("cut.serialized", good.substr(0, size)), 0), Error) << size;
    EXPECT_THAT(error_of([&] { read_serialized(folder.write("a.serialized", good), 2); }),
                HasSubstr("there is no mesh 2"));
    // More vertices than the file can hold.
    std::string huge = good;
    const std::size_t count = huge.find(std::string("\x03\0\0\0\0\0\0\0", 8));
    huge[count + 3] = 0x7f;
    EXPECT_THAT(error_of([&] { read_serialized(folder.write("b.serialized", huge), 0); }), HasSubstr("are announced"));
}

}  // namespace
}  // namespace patina::io
