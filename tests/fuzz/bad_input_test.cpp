// Whatever a file holds, reading it ends with values that make sense or with a patina::Error: never with a crash, a
// hang, a number that is none, or another exception. PATINA_FUZZ_ROUNDS asks for more rounds than an everyday run has.

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>

#include "mutations.h"
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "patina/brdf/half_angle_table.h"
#include "patina/brdf/tabulate.h"
#include "patina/coating/optical_problem.h"
#include "patina/coating/scattering_csv.h"
#include "patina/core/files.h"
#include "patina/io/bitmap_file.h"
#include "patina/io/mesh_file.h"
#include "patina/io/mitsuba_xml.h"
#include "patina/io/png_file.h"
#include "patina/io/stokes_exr.h"
#include "patina/io/table_hdf5.h"
#include "patina/io/table_merl.h"
#include "patina/io/table_pbsdf.h"
#include "patina/optics/optical_constants_file.h"
#include "patina/spectral/spectrum_file.h"

namespace patina::fuzz {
namespace {

namespace fs = std::filesystem;

int rounds(int everyday) {
    const char* wanted = std::getenv("PATINA_FUZZ_ROUNDS");
    return wanted ? std::max(1, std::atoi(wanted)) : everyday;
}

class BadInput : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(::testing::TempDir()) / fmt::format("patina_fuzz_{}", ::getpid());
        fs::create_directories(folder_ / "data");
        for (const char* name : {"rutile_like_matrix.csv", "rutile_like_cross_sections.csv", "siewert_problem_IIA.csv",
                                 "yellow_dye_binder.csv"})
            fs::copy_file(source("examples/data") / name, folder_ / "data" / name, fs::copy_options::skip_existing);
    }
    void TearDown() override {
        if (!HasFailure()) fs::remove_all(folder_);
    }

    static fs::path source(const std::string& name) { return fs::path(PATINA_SOURCE_DIR) / name; }
    static std::string source_text(const std::string& name) { return read_text_file(source(name)); }
    const fs::path& folder() const { return folder_; }

    // Reads `count` mutations of each text; `read` throws Error or checks what it got. A failing input is kept.
    void try_texts(const std::vector<std::string>& texts, int count, const std::string& name,
                   const std::function<void(const std::string&)>& read) {
        for (std::size_t t = 0; t < texts.size(); ++t)
            for (int round = 0; round < count; ++round) {
                Mutator mutator(static_cast<unsigned>(1000003 * t + static_cast<std::size_t>(round)));
                try_one(mutator.text(texts[t]), fmt::format("{}_{}_{}", name, t, round), read);
            }
    }
    void try_binary(const std::string& bytes, int count, const std::string& name,
                    const std::function<void(const std::string&)>& read) {
        for (int round = 0; round < count; ++round) {
            Mutator mutator(static_cast<unsigned>(round));
            try_one(mutator.binary(bytes), fmt::format("{}_{}", name, round), read);
        }
    }

    // The file of a reader that takes a path.
    fs::path write(const std::string& name, const std::string& bytes) const {
        // A new file: file systems flush one that is written over, which takes far longer than to read it.
        fs::remove(folder_ / name);
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }

    int refused = 0, accepted = 0;

  private:
    void try_one(const std::string& input, const std::string& name,
                 const std::function<void(const std::string&)>& read) {
        const auto start = std::chrono::steady_clock::now();
        std::string problem;
        try {
            read(input);
            ++accepted;
        } catch (const Error& error) {
            ++refused;
            // A reason that can be read.
            if (std::string_view(error.what()).size() > 5000) problem = "an endless message";
            if (std::string_view(error.what()).empty()) problem = "no reason";
        } catch (const std::exception& other) {
            problem = fmt::format("{}: {}", typeid(other).name(), std::string_view(other.what()).substr(0, 300));
        }
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        // Far above what any reader takes, also on a busy machine under a sanitizer.
        if (seconds.count() > 30.0) problem = fmt::format("{:.1f} s", seconds.count());
        if (problem.empty()) return;
        ADD_FAILURE() << name << ": " << problem;
        write("failing_" + name, input);
    }

    fs::path folder_;
};

void expect_finite(bool finite, const char* what) {
    if (!finite) throw std::runtime_error(std::string(what) + " is not finite or out of range");
}

void check(const optics::ExpansionCoefficients& c) {
    for (const auto* column : {&c.alpha1, &c.alpha2, &c.alpha3, &c.alpha4, &c.beta1, &c.beta2}) {
        expect_finite(column->size() == c.alpha1.size(), "the number of coefficients");
        for (const double value : *column) expect_finite(std::isfinite(value), "a coefficient");
    }
}

void check(const rt::Problem& problem) {
    for (const rt::Layer& layer : problem.layers) {
        expect_finite(layer.optical_thickness >= 0.0, "an optical thickness");
        expect_finite(layer.single_scattering_albedo >= 0.0 && layer.single_scattering_albedo <= 1.0, "an albedo");
        expect_finite(std::isfinite(layer.refractive_index) && layer.refractive_index > 0.0, "an index");
        check(layer.expansion);
    }
}

// Layers whose setting up takes no time: the sweep over sizes is another test's.
bool is_cheap(const coating::Recipe& recipe) {
    for (const coating::RecipeLayer& layer : recipe.layers)
        if (const auto* composition = std::get_if<coating::Composition>(&layer.content))
            for (const coating::Pigment& pigment : composition->pigments)
                if (const auto* spheres = std::get_if<coating::Spheres>(&pigment.particles))
                    if (optics::effective_radius_um(spheres->size) > 1.0 || composition->pigments.size() > 4)
                        return false;
    return recipe.layers.size() <= 6;
}

brdf::MuellerTable small_table() {
    return brdf::tabulate(brdf::single_rayleigh_body(1.0), {.wavelengths_nm = {450, 650}, .nodes = 3, .orders = 3});
}

TEST_F(BadInput, Recipes) {
    std::vector<std::string> texts;
    for (const char* name : {"tio2_on_aluminium", "white_wall_paint", "tinted_enamel", "external_particles",
                             "siewert_problem_IIA", "paper/fe2o3"})
        texts.push_back(source_text(fmt::format("examples/{}.toml", name)));
    io::write_table_hdf5(small_table(), folder() / "base.h5");
    texts.push_back(
        "volume_solids = 0.4\n[interface]\ntype = \"rough\"\nalpha = 0.2\ndistribution = \"beckmann\"\n[[layers]]\n"
        "thickness_um = 5\nbinder = { n = 1.5, k = 1e-3 }\n[[layers.pigments]]\nmaterial = { n = 2 }\npvc_percent = 5\n"
        "size = { distribution = \"gamma\", weighting = \"volume\", effective_radius_um = 0.1, effective_variance = "
        "0.1 }\n[base]\ntype = \"table\"\nfile = \"base.h5\"\nrefractive_index = 1.5\n");
    int round = 0;
    try_texts(texts, rounds(250), "recipe", [&](const std::string& text) {
        const coating::Recipe recipe = coating::parse_recipe(text, "fuzz.toml", folder());
        if (++round % 8 == 0 && is_cheap(recipe)) check(coating::optical_problem(recipe, 550.0, 1e-2).problem);
    });
    EXPECT_GT(refused, 100);
    EXPECT_GT(accepted, 100);
}

TEST_F(BadInput, Settings) {
    const std::string recipe = source_text("examples/tinted_enamel.toml");
    const std::vector<std::string> settings{
        "layers.0.thickness_um=30", "layers.0.pigments.0.weight_percent=3", "base={ type = \"none\" }",
        "layers.0.pigments.1.size={ distribution = \"mono\", radius_um = 0.2 }", "title=words"};
    try_texts(settings, rounds(150), "setting",
              [&](const std::string& setting) { coating::parse_recipe(recipe, "fuzz.toml", folder(), {setting}); });
    EXPECT_GT(refused, 50);
}

TEST_F(BadInput, OpticalConstants) {
    const auto check_constants = [](const optics::OpticalConstants& constants) {
        const double low = constants.wavelength_min_nm(), high = constants.wavelength_max_nm();
        for (const double wavelength : {low, 0.5 * low + 0.5 * high, high}) {
            const std::complex<double> index = constants.at(wavelength);
            expect_finite(std::isfinite(index.real()) && index.real() > 0.0, "n");
            expect_finite(std::isfinite(index.imag()) && index.imag() >= 0.0, "k");
        }
    };
    std::vector<std::string> pages;
    for (const char* name : {"Al", "acrylic", "TiO2-rutile-o", "Fe2O3-o", "SiO2"})
        pages.push_back(source_text(fmt::format("data/materials/{}.yml", name)));
    try_texts(pages, rounds(80), "yaml", [&](const std::string& text) {
        check_constants(optics::parse_optical_constants_yaml(text, "fuzz.yml", "fuzz").constants);
    });
    try_texts({source_text("examples/data/yellow_dye_binder.csv")}, rounds(300), "csv", [&](const std::string& text) {
        check_constants(optics::parse_optical_constants_csv(text, "fuzz.csv", "fuzz").constants);
    });
    EXPECT_GT(refused, 100);
    EXPECT_GT(accepted, 50);
}

TEST_F(BadInput, ScatteringFiles) {
    try_texts({source_text("examples/data/siewert_problem_IIA.csv")}, rounds(300), "expansion",
              [&](const std::string& text) {
                  for (const auto& law : coating::read_expansion_csv(write("expansion.csv", text)))
                      check(law.expansion);
              });
    // A table of seven angles keeps the splines short.
    const std::string matrix =
        "# "
        "F\nangle_deg,F11,F12,F22,F33,F34,F44\n0,2,0,2,2,0,2\n30,1.8,-0.1,1.8,1.7,0.1,1.7\n60,1.3,-0.5,1.3,1,0.2,1\n90,"
        "1,-1,1,0,0,0\n120,1.2,-0.7,1.2,-1,0,-1\n150,1.7,-0.2,1.7,-1.7,0,-1.7\n180,2,0,2,-2,0,-2\n";
    try_texts({matrix}, rounds(300), "matrix", [&](const std::string& text) {
        for (const auto& law : coating::read_matrix_csv(write("matrix.csv", text))) check(law.expansion);
    });
    try_texts({source_text("examples/data/rutile_like_cross_sections.csv")}, rounds(200), "cross",
              [&](const std::string& text) {
                  for (const auto& row : coating::read_cross_sections_csv(write("cross.csv", text)))
                      expect_finite(std::isfinite(row.extinction_um2) && row.scattering_um2 <= row.extinction_um2,
                                    "a cross section");
              });
    EXPECT_GT(refused, 200);
    EXPECT_GT(accepted, 50);
}

TEST_F(BadInput, Spectra) {
    try_texts({"# lamp\n400 1\n500 3\n600 2\n700 1.5\n", "wavelength_um,reflectance\n0.4,0.1\n0.6,0.3\n"}, rounds(400),
              "spectrum", [](const std::string& text) {
                  const spectral::Spectrum spectrum =
                      spectral::parse_spectrum(text, "fuzz.spd", spectral::Outside::hold);
                  for (const double wavelength : {1.0, 450.0, 550.0, 1e6})
                      expect_finite(std::isfinite(spectrum(wavelength)), "a value");
              });
    EXPECT_GT(refused, 100);
    EXPECT_GT(accepted, 100);
}

TEST_F(BadInput, Scenes) {
    const std::vector<std::string> scenes{source_text("examples/polar_balls.xml"),
                                          source_text("examples/painted_spheres.xml")};
    try_texts(scenes, rounds(150), "scene",
              [&](const std::string& text) { io::read_mitsuba_scene(write("scene.xml", text)); });
    EXPECT_GT(refused, 50);
}

// A sealed table with any damage is refused; only what has lost its seal reaches the library.
TEST_F(BadInput, Tables) {
    io::write_table_hdf5(small_table(), folder() / "good.h5");
    const std::string sealed = read_text_file(folder() / "good.h5");
    try_binary(sealed, rounds(300), "table",
               [&](const std::string& bytes) { io::read_table_hdf5(write("table.h5", bytes)).validate(); });
    EXPECT_GT(refused, 100);
}

TEST_F(BadInput, ExportedTables) {
    const brdf::HalfAngleTable exported =
        brdf::to_half_angles(small_table(), {.theta_h = 4, .theta_d = 3, .phi_d = 5, .wavelengths_nm = {450, 650}});
    io::write_table_pbsdf(exported, folder() / "good.pbsdf");
    try_binary(read_text_file(folder() / "good.pbsdf"), rounds(600), "pbsdf", [&](const std::string& bytes) {
        const brdf::HalfAngleTable table = io::read_table_pbsdf(write("table.pbsdf", bytes));
        table.validate();
        (void)table.evaluate(500.0, {0.3, 0.4, 0.5});
    });
    EXPECT_GT(refused, 200);
    EXPECT_GT(accepted, 20);
}

TEST_F(BadInput, Meshes) {
    const std::string obj =
        "# o\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 2 4 -2\n";
    try_texts({obj}, rounds(300), "obj", [&](const std::string& text) { io::read_obj(write("mesh.obj", text)); });
    const std::string head =
        "property float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar "
        "int vertex_indices\nend_header\n";
    const std::string ascii = "ply\nformat ascii 1.0\nelement vertex 3\n" + head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    try_texts({ascii}, rounds(300), "ply", [&](const std::string& text) { io::read_ply(write("mesh.ply", text)); });
    const std::string binary = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + head +
                               std::string(36, '\0') + std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
    try_binary(binary, rounds(300), "binary_ply",
               [&](const std::string& bytes) { io::read_ply(write("mesh.ply", bytes)); });
    EXPECT_GT(refused, 100);
    EXPECT_GT(accepted, 30);
}

TEST_F(BadInput, Pictures) {
    StokesImage picture;
    picture.width = picture.full_width = 4, picture.height = picture.full_height = 3;
    picture.bin_edges_nm = {400, 500, 600};
    picture.spectral.assign(12 * 2 * 4, 0.5f);
    picture.rgb.assign(12 * 12, 0.25f);
    picture.alpha.assign(12, 1.0f);
    io::write_stokes_exr(folder() / "good.exr", picture);
    try_binary(read_text_file(folder() / "good.exr"), rounds(300), "exr",
               [&](const std::string& bytes) { io::read_stokes_exr(write("picture.exr", bytes)); });
    Bitmap bitmap{"", 2, 2, {"R", "G", "B"}, std::vector<float>(12, 0.5f)};
    io::write_png(folder() / "good.png", bitmap);
    try_binary(read_text_file(folder() / "good.png"), rounds(300), "png",
               [&](const std::string& bytes) { io::read_png(write("picture.png", bytes)); });
    const std::string pfm = "PF\n2 1\n-1.0\n" + std::string(24, '\x3f');
    try_binary(pfm, rounds(200), "pfm", [&](const std::string& bytes) { io::read_pfm(write("picture.pfm", bytes)); });
    const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n" + std::string(32, '\x70');
    try_binary(hdr, rounds(200), "hdr", [&](const std::string& bytes) { io::read_hdr(write("picture.hdr", bytes)); });
    EXPECT_GT(refused, 100);
}

// A MERL file is 33 MB of numbers after three integers: heads and sizes alone can be wrong, and a number.
TEST_F(BadInput, MerlTables) {
    const std::string head{"\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0", 12};
    try_binary(head + std::string(200, '\0'), rounds(100), "merl",
               [&](const std::string& bytes) { io::read_table_merl(write("table.binary", bytes)); });
    EXPECT_EQ(accepted, 0);
    std::string whole = head + std::string(8 * 3 * brdf::MerlTable::plane_size, '\0');
    EXPECT_NO_THROW(io::read_table_merl(write("table.binary", whole)));
    whole[12 + 7] = '\x7f', whole[12 + 6] = '\xf8';
    EXPECT_THROW(io::read_table_merl(write("table.binary", whole)), Error);
}

}  // namespace
}  // namespace patina::fuzz
