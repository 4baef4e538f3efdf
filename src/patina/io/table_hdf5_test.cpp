#include "patina/io/table_hdf5.h"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "patina/brdf/tabulate.h"
#include "patina/core/files.h"
#include "patina/core/scratch_folder_for_tests.h"
#include "patina/optics/fresnel.h"

namespace patina::io {
namespace {

namespace fs = std::filesystem;
using brdf::MuellerTable;
using testing::HasSubstr;

class TableHdf5 : public testing::Test {
  protected:
    fs::path file(const std::string& name) const { return folder_ / name; }

    // Runs Python with h5py on a script; its last word is the exit code.
    int python(const std::string& script) const {
        write_text_file(file("check.py"), script);
        return std::system(fmt::format("/usr/bin/python3 '{}'", file("check.py").string()).c_str());
    }

    ScratchFolder folder_;
};

MuellerTable sample_table() {
    MuellerTable table =
        brdf::tabulate(brdf::single_rayleigh_body(1.0), {.wavelengths_nm = {450, 550, 700}, .nodes = 6, .orders = 3});
    table.body[0].modes.pop_back();
    for (std::size_t w = 0; w < 3; ++w)
        for (int angle = 0; angle <= 90; ++angle)
            table.specular_surface[w][angle] = optics::fresnel_reflection(std::cos(angle * 3.14159 / 180), 1.0,
                                                                          {1.4 + 0.1 * static_cast<double>(w), 0.3});
    table.error_estimate = {1e-4, 2e-4, 3e-4};
    table.provenance = {"patina solve a.toml -o a.h5",
                        "# \"recipe\"\n[base]\ntype = \"none\"\n" + std::string(100000, '#'),
                        "a.toml",
                        "patina 0.1.0",
                        "doubling",
                        {{"TiO2", "DeVore 1951, extrapolated"}, {"µ", "ü\n"}}};
    return table;
}

void expect_equal(const MuellerTable& a, const MuellerTable& b, double tolerance) {
    EXPECT_EQ(a.wavelengths_nm, b.wavelengths_nm);
    EXPECT_EQ(a.mu, b.mu);
    EXPECT_EQ(a.mu_weights, b.mu_weights);
    EXPECT_EQ(a.specular_theta_deg, b.specular_theta_deg);
    EXPECT_EQ(a.error_estimate, b.error_estimate);
    ASSERT_EQ(a.body.size(), b.body.size());
    for (std::size_t w = 0; w < a.body.size(); ++w) {
        ASSERT_EQ(a.body[w].modes.size(), b.body[w].modes.size());
        for (std::size_t m = 0; m < a.body[w].modes.size(); ++m)
            EXPECT_LE((a.body[w].modes[m] - b.body[w].modes[m]).norm(), tolerance * a.body[w].modes[m].norm());
        for (std::size_t k = 0; k < a.specular_theta_deg.size(); ++k) {
            EXPECT_EQ(a.specular_surface[w][k], b.specular_surface[w][k]);
            EXPECT_EQ(a.specular_coherent[w][k], b.specular_coherent[w][k]);
        }
    }
    EXPECT_EQ(a.provenance.command, b.provenance.command);
    EXPECT_EQ(a.provenance.recipe, b.provenance.recipe);
    EXPECT_EQ(a.provenance.recipe_path, b.provenance.recipe_path);
    EXPECT_EQ(a.provenance.software, b.provenance.software);
    EXPECT_EQ(a.provenance.solver, b.provenance.solver);
    EXPECT_EQ(a.provenance.notes, b.provenance.notes);
}

// Version 2: a wavelength with two layers of once scattered light of different order, one of them without end, and
// wavelengths with none.
TEST_F(TableHdf5, KeepsOnceScatteredLight) {
    MuellerTable table = sample_table();
    const std::size_t angles = table.specular_theta_deg.size();
    const std::vector<optics::Mueller> light(angles, optics::Mueller(0.5 * optics::Mueller::Identity()));
    const std::vector<optics::Mueller> dark(angles, optics::Mueller::Zero());
    const optics::ExpansionCoefficients rayleigh{{1, 0, 0.5}, {0, 0, 3},   {0, 0, 0},
                                                 {0, 1.5, 0}, {0, 0, 1.2}, {0, 0, 0}};
    optics::ExpansionCoefficients longer = rayleigh;
    for (auto* list : {&longer.alpha1, &longer.alpha2, &longer.alpha3, &longer.alpha4, &longer.beta1, &longer.beta2})
        list->push_back(0.1);
    table.once_scattered.resize(3);
    table.once_scattered[1] = {{1.5, 0.7, rayleigh, light, light},
                               {1.6, std::numeric_limits<double>::infinity(), longer, light, dark}};
    write_table_hdf5(table, file("a.h5"));
    const MuellerTable back = read_table_hdf5(file("a.h5"));
    ASSERT_EQ(back.once_scattered.size(), 3u);
    EXPECT_TRUE(back.once_scattered[0].empty());
    ASSERT_EQ(back.once_scattered[1].size(), 2u);
    EXPECT_EQ(back.once_scattered[1][1].index_ratio, 1.6);
    EXPECT_TRUE(std::isinf(back.once_scattered[1][1].optical_thickness));
    EXPECT_EQ(back.once_scattered[1][1].scattering.beta2, longer.beta2);
    // The shorter list is filled up with zeros, which add nothing but the rounding of another table's angles.
    const optics::Mueller expected = table.evaluate(550, 0.6, 0.8, 1.0), found = back.evaluate(550, 0.6, 0.8, 1.0);
    EXPECT_LT((expected - found).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_GT((expected - sample_table().evaluate(550, 0.6, 0.8, 1.0)).cwiseAbs().maxCoeff(), 1e-3);

    // Without it there is no group.
    table.once_scattered.clear();
    write_table_hdf5(table, file("b.h5"));
    EXPECT_TRUE(read_table_hdf5(file("b.h5")).once_scattered.empty());
}

TEST_F(TableHdf5, RoundTripKeepsEveryBit) {
    const MuellerTable table = sample_table();
    write_table_hdf5(table, file("a.h5"));
    expect_equal(table, read_table_hdf5(file("a.h5")), 0.0);
}

TEST_F(TableHdf5, SinglePrecisionRoundsToFloat) {
    const MuellerTable table = sample_table();
    write_table_hdf5(table, file("a.h5"), {.single_precision = true});
    expect_equal(table, read_table_hdf5(file("a.h5")), 6e-8);  // half a unit in the last place of a float
}

// The manual's formula in numpy, on the file alone, gives what evaluate() gives; dimensions and units are where h5py
// and xarray look for them.
TEST_F(TableHdf5, H5pyFindsDimensionsUnitsAndConventionsAndTheManualsFormulaHolds) {
    const MuellerTable table = sample_table();
    write_table_hdf5(table, file("a.h5"));
    const std::string manual = read_text_file(fs::path(PATINA_SOURCE_DIR) / "docs/formats/mueller_table_hdf5.md");
    const std::size_t begin = manual.find("```python\n"), end = manual.find("```", begin + 10);
    ASSERT_NE(begin, std::string::npos);

    const optics::Mueller expected = table.evaluate(480, 0.37, 0.81, 2.2);
    std::string numbers;
    for (int k = 0; k < 16; ++k) numbers += fmt::format("{:.17g},", expected(k / 4, k % 4));
    const std::string checks = fmt::format(R"(
import sys
path = {:?}
file = h5py.File(path)
body = file["body"]
assert [d.label for d in body.dims] == ["wavelength_nm", "fourier_order", "mu_out", "stokes_out", "mu_in", "stokes_in"]
assert [d[0].name for d in body.dims] == ["/wavelength_nm", "/fourier_order", "/mu", "/stokes", "/mu_in", "/stokes_in"]
assert body.attrs["units"] == "1/sr" and file["wavelength_nm"].attrs["units"] == "nm"
assert body.shape == (3, 3, 6, 4, 6, 4) and body.chunks == (1, 3, 6, 4, 6, 4) and body.compression == "gzip"
assert [s.decode() for s in file["stokes"][:]] == ["I", "Q", "U", "V"]
assert file.attrs["format"] == "patina-mueller-table" and file.attrs["format_version"] == 1
for name in "brdf stokes azimuth fourier interpolation specular".split():
    assert len(file.attrs["convention_" + name]) > 40
assert file["provenance"].attrs["solver"] == "doubling"
assert file["specular_surface"].dims[1][0].name == "/specular_theta_deg"
expected = np.array([{}]).reshape(4, 4)
found = evaluate(file, 480.0, 0.37, 0.81, 2.2)
assert np.abs(found - expected).max() < 1e-14, (found, expected)
)",
                                           file("a.h5").string(), numbers);
    EXPECT_EQ(python(manual.substr(begin + 10, end - begin - 10) + checks), 0);
}

// Damages a good file with h5py and expects an error that names the file and says the words.
TEST_F(TableHdf5, DamagedFilesAreRefusedByName) {
    write_table_hdf5(sample_table(), file("good.h5"));
    const std::pair<const char*, const char*> damages[] = {
        {"del f['body']", "dataset body is missing"},
        {"del f['mu_weight']", "dataset mu_weight is missing"},
        {"del f.attrs['format']", "not a Mueller BRDF table"},
        {"f.attrs['format'] = 'weather'", "\"weather\""},
        {"f.attrs['format'] = 7", "is not a text"},
        {"f.attrs['format_version'] = 99", "version 99"},
        {"f.attrs['format_version'] = 'one'", "is not an integer"},
        {"del f['body']; f['body'] = 'text'", "does not hold numbers"},
        {"del f['body']; f.create_group('body')", "dataset body is missing"},
        {"del f['body']; f['body'] = np.zeros((3, 2, 6, 4))", "has 4 dimensions"},
        {"del f['body']; f['body'] = np.zeros((3, 2, 5, 4, 6, 4))", "dimension 2 should have 6"},
        {"del f['body']; f.create_dataset('body', (3, 2**40, 6, 4, 6, 4), chunks=(1, 1, 6, 4, 6, 4))",
         "larger than any"},
        {"del f['body']; f.create_dataset('body', (3, 0, 6, 4, 6, 4))", "is empty"},
        {"f['body'][1, 0, 2, 0, 2, 0] = np.nan", "NaN or infinity at 550 nm"},
        {"f['wavelength_nm'][0] = 600", "wavelengths_nm does not ascend"},
        {"f['mu'][0] = -0.5", "mu[0] is -0.5"},
        {"f['error_estimate'][0] = -1", "error_estimate"},
        {"del f['error_estimate']; f['error_estimate'] = np.zeros(7)", "error_estimate has 7"},
    };
    std::string script = "import h5py, shutil\nimport numpy as np\n";
    for (std::size_t k = 0; k < std::size(damages); ++k)
        script += fmt::format("shutil.copy({:?}, {:?})\nwith h5py.File({:?}, 'r+') as f: {}\n",
                              file("good.h5").string(), file(fmt::format("{}.h5", k)).string(),
                              file(fmt::format("{}.h5", k)).string(), damages[k].first);
    ASSERT_EQ(python(script), 0);
    for (std::size_t k = 0; k < std::size(damages); ++k) {
        const fs::path bad = file(fmt::format("{}.h5", k));
        try {
            read_table_hdf5(bad);
            ADD_FAILURE() << damages[k].first << " was accepted";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            EXPECT_THAT(error.what(), testing::AllOf(HasSubstr(bad.string()), HasSubstr(damages[k].second)));
        }
    }
}

constexpr std::size_t seal_size = 34;  // docs/formats/mueller_table_hdf5.md

// Every damaged bit is found, whatever HDF5 makes of it; without its seal a file is still read.
TEST_F(TableHdf5, TheSealTellsEveryDamage) {
    write_table_hdf5(sample_table(), file("good.h5"));
    const std::string good = read_text_file(file("good.h5"));
    std::mt19937 random(2);
    for (int round = 0; round < 100; ++round) {
        std::string bytes = good;
        bytes[random() % (good.size() - seal_size)] ^= static_cast<char>(1 << (random() % 8));
        write_text_file(file("bad.h5"), bytes);
        EXPECT_THROW(read_table_hdf5(file("bad.h5")), Error);
    }
    write_text_file(file("unsealed.h5"), good.substr(0, good.size() - seal_size));
    expect_equal(sample_table(), read_table_hdf5(file("unsealed.h5")), 0.0);
}

// Truncated and, without a seal, randomly overwritten files: an Error(input) or a table that passes validate(), never
// anything else.
TEST_F(TableHdf5, TruncatedAndCorruptedFilesNeverCrash) {
    write_table_hdf5(sample_table(), file("good.h5"));
    const std::string sealed = read_text_file(file("good.h5")), good = sealed.substr(0, sealed.size() - seal_size);
    std::mt19937 random(1);
    testing::internal::CaptureStderr();
    int refused = 0;
    for (int round = 0; round < 300; ++round) {
        std::string bytes = good;
        if (round % 2 == 0) {
            bytes.resize(random() % good.size());
        } else {
            for (int k = 0; k < 20; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
        }
        std::ofstream(file("bad.h5"), std::ios::binary) << bytes;
        try {
            read_table_hdf5(file("bad.h5"));
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
            ++refused;
        }
    }
    EXPECT_GE(refused, 150);  // every truncation
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    for (const char* name : {"missing.h5", "."}) EXPECT_THROW(read_table_hdf5(file(name)), Error);
}

// A file size limit stands for a full disk: the earlier file survives and nothing else is left.
TEST_F(TableHdf5, AFullDiskIsARuntimeErrorAndKeepsTheEarlierFile) {
    write_text_file(file("a.h5"), "earlier");
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit small = before;
    small.rlim_cur = 4096;
    setrlimit(RLIMIT_FSIZE, &small);
    ErrorKind kind = ErrorKind::usage;
    try {
        write_table_hdf5(sample_table(), file("a.h5"));
    } catch (const Error& error) {
        kind = error.kind();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, old_handler);
    EXPECT_EQ(kind, ErrorKind::runtime);
    EXPECT_EQ(read_text_file(file("a.h5")), "earlier");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

}  // namespace
}  // namespace patina::io
