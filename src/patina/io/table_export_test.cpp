#include <cstring>
#include <filesystem>
#include <random>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patina/brdf/tabulate.h"
#include "patina/core/constants.h"
#include "patina/core/files.h"
#include "patina/core/scratch_folder_for_tests.h"
#include "patina/io/table_csv.h"
#include "patina/io/table_merl.h"
#include "patina/io/table_pbsdf.h"

namespace patina::io {
namespace {

namespace fs = std::filesystem;
using brdf::HalfAngleTable;
using brdf::MuellerTable;
using testing::HasSubstr;

class TableExport : public testing::Test {
  protected:
    fs::path file(const std::string& name) const { return folder_ / name; }

    template <class Read>
    void expect_refused(const Read& read, const std::string& bytes, const char* words) const {
        write_text_file(file("bad"), bytes);
        try {
            read(file("bad"));
            ADD_FAILURE() << "accepted: " << words;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            EXPECT_THAT(error.what(), testing::AllOf(HasSubstr(file("bad").string()), HasSubstr(words)));
        }
    }

    ScratchFolder folder_;
};

MuellerTable rayleigh_table() {
    return brdf::tabulate(brdf::single_rayleigh_body(5.0), {.wavelengths_nm = {400, 700}, .nodes = 8, .orders = 3});
}

TEST_F(TableExport, PbsdfRoundTripKeepsEveryBitAndTheDocumentedLayout) {
    const HalfAngleTable table = to_half_angles(rayleigh_table(), {.theta_h = 4, .theta_d = 5, .phi_d = 7});
    write_table_pbsdf(table, file("a.pbsdf"));
    const HalfAngleTable back = read_table_pbsdf(file("a.pbsdf"));
    EXPECT_EQ(back.mueller, table.mueller);
    EXPECT_EQ(back.wavelengths_nm, (std::vector<double>{450, 500, 550, 600, 650}));
    for (int k = 0; k < 7; ++k) EXPECT_NEAR(back.phi_d[k], table.phi_d[k], 2e-7);  // stored as float

    // The bytes, as the layout says: magic, version, field count, then the first field's name, rank, type and data.
    const std::string bytes = read_text_file(file("a.pbsdf"));
    EXPECT_EQ(bytes.substr(0, 12), std::string("tensor_file\0", 12));
    EXPECT_EQ(bytes.substr(12, 6), std::string("\1\0\5\0\0\0", 6));
    EXPECT_EQ(bytes.substr(18, 9), std::string("\7\0theta_h", 9));
    EXPECT_EQ(bytes.substr(27, 3), std::string("\2\0\12", 3));
    std::uint64_t offset = 0, shape[2] = {};
    std::memcpy(&offset, bytes.data() + 30, 8);
    std::memcpy(shape, bytes.data() + 38, 16);
    EXPECT_EQ(offset % 8, 0u);
    EXPECT_EQ(shape[0], 1u);
    EXPECT_EQ(shape[1], 4u);
    float last = 0;
    std::memcpy(&last, bytes.data() + offset + 3 * sizeof(float), sizeof last);
    EXPECT_FLOAT_EQ(last, static_cast<float>(pi / 2));
}

TEST_F(TableExport, BadPbsdfFilesAreRefusedByField) {
    const HalfAngleTable table = to_half_angles(rayleigh_table(), {.theta_h = 4, .theta_d = 5, .phi_d = 7});
    write_table_pbsdf(table, file("a.pbsdf"));
    const std::string good = read_text_file(file("a.pbsdf"));
    const auto changed = [&](std::size_t place, std::string_view bytes) {
        std::string result = good;
        return result.replace(place, bytes.size(), bytes);
    };
    expect_refused(read_table_pbsdf, "", "not a tensor file");
    expect_refused(read_table_pbsdf, changed(12, "\2"), "version 2.0");
    expect_refused(read_table_pbsdf, changed(20, "gamma_h"), "theta_h is missing");
    expect_refused(read_table_pbsdf, changed(29, "\3"), "field theta_h has the type 3");
    expect_refused(read_table_pbsdf, changed(38, std::string_view("\0", 1)), "shape (0, 4)");
    expect_refused(read_table_pbsdf, changed(30, "\377\377\377\377\377\377\377\377"), "beyond the end");
    expect_refused(read_table_pbsdf, changed(46, "\377\377\377\377\377\377\377\377"), "larger than the file");
    expect_refused(read_table_pbsdf, good.substr(0, good.size() - 1), "field M reaches beyond");
    expect_refused(read_table_pbsdf, good.substr(0, 40), "truncated");

    // Truncations and random bytes: an Error(input) or a valid table.
    std::mt19937 random(2);
    for (int round = 0; round < 500; ++round) {
        std::string bytes = good;
        if (round % 2 == 0)
            bytes.resize(random() % bytes.size());
        else
            for (int k = 0; k < 4; ++k) bytes[random() % 300] = static_cast<char>(random());
        write_text_file(file("bad"), bytes);
        try {
            read_table_pbsdf(file("bad"));
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
        }
    }
}

TEST_F(TableExport, PbsdfHoldsWholeNanometresOnly) {
    HalfAngleTable table = to_half_angles(rayleigh_table(), {.theta_h = 2, .theta_d = 2, .phi_d = 2});
    table.wavelengths_nm[0] = 450.5;
    EXPECT_THROW(write_table_pbsdf(table, file("a.pbsdf")), Error);
}

// A cell of MERL's grid at theta_h = 30 deg is 1.2 deg wide: the nearest cell's value errs by that times the slope,
// which for Rayleigh scattering in a deep layer is at most a few times the value per radian.
TEST_F(TableExport, MerlHoldsTheBrdfToItsCellSizeAndKeepsItThroughAFile) {
    const MuellerTable table = rayleigh_table();
    Eigen::Matrix3Xd weights(3, 2);
    weights << 1, 0, 0.5, 0.5, 0, 2;
    std::size_t clamped = 99;
    write_table_merl(to_merl(table, weights, &clamped), file("a.binary"));
    EXPECT_EQ(clamped, 0u);
    const brdf::MerlTable back = read_table_merl(file("a.binary"));
    for (double phi_d : {-2.5, -0.4, 0.3, 1.5, 3.0})
        for (double theta_h : {0.05, 0.5}) {
            const brdf::HalfAngles angles{theta_h, 0.6, phi_d};
            const brdf::DirectionPair pair = directions(angles);
            const double f = table.evaluate(400, pair.o.z(), pair.i.z(), relative_azimuth(pair))(0, 0);
            EXPECT_LT((back.evaluate(angles) - Eigen::Vector3d(f, f, 2 * f)).norm(), 0.03 * f);
        }
}

TEST_F(TableExport, BadMerlFilesAreRefused) {
    expect_refused(read_table_merl, "", "0 x 0 x 0");
    expect_refused(read_table_merl, std::string("\132\0\0\0\132\0\0\0\264\0\0\0", 12), "the file has 12 bytes");
}

TEST_F(TableExport, CsvHasOneLineADirectionAndTheElementsInOrder) {
    const MuellerTable table = rayleigh_table();
    write_table_csv(table, file("a.csv"),
                    {.wavelengths_nm = {500}, .theta_i_deg = {20, 50}, .theta_o_deg = {30}, .phi_deg = {0, 77}});
    std::istringstream text(read_text_file(file("a.csv")));
    std::string line;
    std::getline(text, line);
    EXPECT_EQ(line.substr(0, 54), "wavelength_nm,theta_i_deg,theta_o_deg,phi_deg,m00,m01,");
    std::vector<double> last;
    int lines = 0;
    while (std::getline(text, line)) {
        ++lines;
        last.clear();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) last.push_back(std::stod(cell));
    }
    ASSERT_EQ(lines, 4);
    ASSERT_EQ(last.size(), 20u);
    EXPECT_EQ(last[1], 50);
    EXPECT_EQ(last[3], 77);
    const optics::Mueller f = table.evaluate(500, std::cos(radians(30)), std::cos(radians(50)), radians(77));
    for (int k = 0; k < 16; ++k) EXPECT_NEAR(last[4 + k], f(k / 4, k % 4), 1e-9 * f(0, 0));
    EXPECT_THROW(write_table_csv(table, file("a.csv"), {.theta_o_deg = {95}}), Error);
}

}  // namespace
}  // namespace patina::io
