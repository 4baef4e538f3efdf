#include "patina/jobs/plot.h"

#include <cstdlib>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patina/brdf/tabulate.h"
#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/jobs/plot_gnuplot.h"
#include "patina/jobs/plot_style.h"
#include "patina/optics/fresnel.h"

namespace patina::jobs {
namespace {

namespace fs = std::filesystem;
using brdf::MuellerTable;
using testing::HasSubstr;

// Scattering that depolarizes in part, under a smooth surface: every figure has something to show.
MuellerTable sample_table(double optical_thickness) {
    MuellerTable table = brdf::tabulate(
        [=](double nm, double mu_o, double mu_i, double phi) -> optics::Mueller {
            const double depth = optical_thickness * std::pow(550 / nm, 4);
            return brdf::single_rayleigh_body(depth)(nm, mu_o, mu_i, phi) +
                   brdf::lambertian_body(0.3 * (1 - std::exp(-depth / 5)))(nm, mu_o, mu_i, phi);
        },
        {.wavelengths_nm = {400, 450, 500, 550, 600, 650, 700}, .nodes = 16, .orders = 3});
    for (std::size_t w = 0; w < table.wavelengths_nm.size(); ++w)
        for (int angle = 0; angle <= 90; ++angle)
            table.specular_surface[w][angle] = optics::fresnel_reflection(std::cos(radians(angle)), 1.0, 1.5);
    return table;
}

class Plot : public testing::Test {
  protected:
    void SetUp() override {
        // PATINA_PLOT_DIR keeps the figures, to be looked at.
        const char* kept = std::getenv("PATINA_PLOT_DIR");
        keep_ = kept != nullptr;
        folder_ = keep_ ? fs::path(kept) : fs::temp_directory_path() / fmt::format("patina_plot_test_{}", ::getpid());
        fs::create_directories(folder_);
    }
    void TearDown() override {
        if (!keep_) fs::remove_all(folder_);
    }
    fs::path file(const std::string& name) const { return folder_ / name; }

    bool keep_ = false;
    fs::path folder_;
};

TEST_F(Plot, DrawsEveryKindAsPngAndSvg) {
    const MuellerTable table = sample_table(0.5);
    for (const std::string& name : plot_kind_names()) {
        plot(table, {.kind = plot_kind_named(name)}, file(name + ".png"));
        EXPECT_EQ(read_text_file(file(name + ".png")).substr(1, 3), "PNG");
        plot(table, {.kind = plot_kind_named(name)}, file(name + ".svg"));
        const std::string svg = read_text_file(file(name + ".svg"));
        EXPECT_THAT(svg, testing::AllOf(HasSubstr("<svg"), HasSubstr("</svg>")));
        EXPECT_LT(svg.size(), 8u << 20) << name;
    }
}

TEST_F(Plot, OverlaysTablesWithTheirLabels) {
    const MuellerTable tables[] = {sample_table(0.1), sample_table(0.5), sample_table(2), sample_table(10)};
    std::vector<PlottedTable> plotted;
    for (const auto& [table, label] :
         {std::pair{&tables[0], "τ = 0.1"}, {&tables[1], "τ = 0.5"}, {&tables[2], "τ = 2"}, {&tables[3], "τ = 10"}})
        plotted.push_back({table, label, ""});
    for (PlotKind kind : {PlotKind::lobe, PlotKind::dolp, PlotKind::spectrum, PlotKind::albedo}) {
        const std::string name = "several_" + plot_kind_names()[static_cast<int>(kind)];
        plot(plotted, {.kind = kind}, file(name + ".png"));
        plot(plotted, {.kind = kind}, file(name + ".svg"));
        EXPECT_THAT(read_text_file(file(name + ".svg")), HasSubstr("τ = 0.5"));
    }
    EXPECT_THROW(plot(plotted, {.kind = PlotKind::mueller}, file("a.png")), Error);
}

// Titles and labels are texts, whatever they hold: gnuplot would run `...` and system() inside double quotes.
TEST_F(Plot, TextsAreNeverCommands) {
    const MuellerTable table = sample_table(0.5);
    const std::string trap = fmt::format("it's `touch {0}` \"\n system('touch {0}') @{{x}}", file("trapped").string());
    const PlottedTable plotted{&table, trap, "#zz'`x`"};
    plot(std::span(&plotted, 1), {.kind = PlotKind::dolp, .title = trap}, file("it's `a` b.svg"));
    EXPECT_FALSE(fs::exists(file("trapped")));
    EXPECT_THAT(read_text_file(file("it's `a` b.svg")), HasSubstr("it's `touch"));
    EXPECT_EQ(gnuplot_quoted("a'b\nc"), "'a''b c'");
}

TEST_F(Plot, WhatCannotBeDrawnIsAnErrorOfTheRightKind) {
    const MuellerTable table = sample_table(0.5);
    const auto kind_of = [&](auto&& draw) {
        try {
            draw();
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::interrupted;
    };
    EXPECT_EQ(kind_of([&] { plot_kind_named("lobes"); }), ErrorKind::usage);
    EXPECT_EQ(kind_of([&] { plot(table, {.theta_i_deg = 95}, file("a.png")); }), ErrorKind::usage);
    EXPECT_EQ(kind_of([&] { plot(table, {.wavelength_nm = -1}, file("a.png")); }), ErrorKind::usage);
    EXPECT_EQ(kind_of([&] { plot(table, {}, file("a.pdf")); }), ErrorKind::usage);
    EXPECT_EQ(kind_of([&] { plot(table, {}, file("nowhere") / "a.png"); }), ErrorKind::runtime);
    GnuplotScript wrong;
    wrong.line("plot nonsense(");
    EXPECT_EQ(kind_of([&] { draw_with_gnuplot(wrong, {}, file("a.png")); }), ErrorKind::runtime);

    const std::string path = std::getenv("PATH");
    ::setenv("PATH", "/nonexistent", 1);
    EXPECT_EQ(kind_of([&] { plot(table, {}, file("a.png")); }), ErrorKind::not_built);
    ::setenv("PATH", path.c_str(), 1);
    EXPECT_FALSE(fs::exists(file("a.png")));
}

TEST_F(Plot, DarkTablesAreDrawnToo) {
    const MuellerTable table = brdf::tabulate(brdf::lambertian_body(0.0), {.nodes = 4, .orders = 1});
    for (const std::string& name : plot_kind_names())
        EXPECT_NO_THROW(plot(table, {.kind = plot_kind_named(name), .theta_i_deg = 0}, file("dark_" + name + ".svg")))
            << name;
}

TEST(NiceStep, IsOneTwoOrFiveTimesAPowerOfTen) {
    EXPECT_DOUBLE_EQ(nice_step(1.0, 5), 0.2);
    EXPECT_DOUBLE_EQ(nice_step(0.034, 4), 0.01);
    EXPECT_DOUBLE_EQ(nice_step(1.7, 4), 0.5);
    EXPECT_DOUBLE_EQ(nice_step(90.0, 10), 10.0);
}

}  // namespace
}  // namespace patina::jobs
