#include "patina/jobs/sweep.h"

#include <cmath>
#include <fstream>
#include <limits>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/core/scratch_folder_for_tests.h"
#include "patina/jobs/paint.h"
#include "patina/jobs/sweep_point.h"

namespace patina::jobs {
namespace {

namespace fs = std::filesystem;
using ::testing::DoubleNear;
using ::testing::ElementsAre;

const std::string recipe_text = R"([[layers]]
thickness_um = 10
binder = { n = 1.5 }
[[layers.pigments]]
material = { n = 2.75 }
volume_fraction = 0.15
size = { distribution = "mono", radius_um = 0.1 }
)";

class SweepFolder : public ::testing::Test {
  protected:
    SweepRequest request(const std::string& recipe = recipe_text) const {
        write_text_file(folder_ / "paint.toml", recipe);
        SweepRequest request;
        request.recipe = folder_ / "paint.toml";
        request.axes = {parse_sweep_axis("layers.0.thickness_um=1:100:3log"),
                        parse_sweep_axis("layers.0.pigments.0.volume_fraction=0.1:0.2:2")};
        request.options.stack.wavelengths_nm = {550.0};
        request.options.stack.streams = 4;
        request.folder = folder_ / "out";
        return request;
    }

    const ScratchFolder folder_;
};

TEST(SweepAxis, IsEvenInTheValueOrItsLogarithm) {
    EXPECT_THAT(parse_sweep_axis("a.b=0.02:0.35:12").values, ::testing::SizeIs(12));
    EXPECT_THAT(parse_sweep_axis("a=0:1:3").values, ElementsAre(0.0, 0.5, 1.0));
    EXPECT_THAT(parse_sweep_axis("a=1:100:3log").values, ElementsAre(1.0, DoubleNear(10.0, 1e-11), 100.0));
    EXPECT_THAT(parse_sweep_axis("a=5:1:2").values, ElementsAre(5.0, 1.0));
    EXPECT_THAT(parse_sweep_axis("a=5:5:1").values, ElementsAre(5.0));
    EXPECT_EQ(parse_sweep_axis("layers.0.thickness_um=1:2:2").key, "layers.0.thickness_um");
}

TEST(SweepAxis, NonsenseIsAUsageError) {
    for (const char* text : {"",          "a",         "a=",         "=1:2:3",
                             "a=1",       "a=1:2",     "a=1:2:0",    "a=1:2:-3",
                             "a=1:2:2.5", "a=1:2:x",   "a=x:2:3",    "a=1:y:3",
                             "a=1:2:1",   "a=2:2:4",   "a=0:2:3log", "a=-1:2:3log",
                             "a=nan:2:3", "a=1:inf:3", "a=1:2:3:4",  "a=1:2:99999999999",
                             "a=1:2:3lag"})
        try {
            parse_sweep_axis(text);
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage) << text;
        }
}

TEST_F(SweepFolder, ASecondRunComputesNothingAndGivesTheSame) {
    const SweepResult first = sweep(request());
    EXPECT_EQ(first.points, 6u);
    EXPECT_EQ(first.computed, 6u);
    const std::string csv = read_text_file(folder_ / "out/sweep.csv");
    const SweepResult second = sweep(request());
    EXPECT_EQ(second.computed, 0u);
    EXPECT_EQ(second.reused, 6u);
    EXPECT_EQ(read_text_file(folder_ / "out/sweep.csv"), csv);
    EXPECT_TRUE(fs::exists(folder_ / "out/sweep.h5"));
}

TEST_F(SweepFolder, AFinerGridReusesThePointsItShares) {
    sweep(request());
    SweepRequest finer = request();
    finer.axes[1] = parse_sweep_axis("layers.0.pigments.0.volume_fraction=0.1:0.2:3");
    const SweepResult result = sweep(finer);
    EXPECT_EQ(result.reused, 6u);
    EXPECT_EQ(result.computed, 3u);
}

TEST_F(SweepFolder, AChangedRecipeOrOptionComputesAgain) {
    sweep(request());
    const SweepResult changed = sweep(request(recipe_text + "[base]\ntype = \"lambertian\"\nreflectance = 0.5\n"));
    EXPECT_EQ(changed.reused, 0u);
    EXPECT_EQ(changed.foreign, 6u);
    SweepRequest other = request();
    other.options.white_reflectance = 0.9;
    EXPECT_EQ(sweep(other).reused, 0u);
}

// Points share work; that must not show in a single bit.
TEST_F(SweepFolder, PointsHaveTheBitsOfIndependentReports) {
    SweepRequest thickness = request();
    thickness.axes = {parse_sweep_axis("layers.0.thickness_um=5:50:3")};
    const SweepResult result = sweep(thickness);
    ASSERT_EQ(result.values.size(), 3u);
    for (std::size_t p = 0; p < 3; ++p) {
        PaintRequest alone{.options = thickness.options, .angular = false, .target_lab = {}, .command = {}};
        const coating::Recipe recipe = coating::read_recipe(
            thickness.recipe, {fmt::format("layers.0.thickness_um={}", thickness.axes[0].values[p])});
        const SweepPoint point = sweep_point(paint(recipe, alone).metrics);
        for (std::size_t q = 0; q < point.quantities.size(); ++q)
            if (std::isfinite(point.quantities[q])) {
                EXPECT_EQ(result.values[p][q], point.quantities[q]) << result.columns[q];
            }
    }
}

TEST_F(SweepFolder, DamagedPointsAreComputedAgain) {
    sweep(request());
    int damaged = 0;
    for (const auto& entry : fs::directory_iterator(folder_ / "out/points")) {
        if (damaged == 0) fs::resize_file(entry.path(), 20);
        if (damaged == 1) write_text_file(entry.path(), "{}");
        if (damaged == 2) write_text_file(entry.path(), R"({"schema": "patina/sweep-point/1", "key": 7})");
        ++damaged;
    }
    const SweepResult result = sweep(request());
    EXPECT_EQ(result.computed, 3u);
    EXPECT_EQ(result.reused, 3u);
}

TEST_F(SweepFolder, BadPointsAreRefusedBeforeAnyWork) {
    SweepRequest bad = request();
    bad.axes[1] = parse_sweep_axis("layers.0.pigments.0.volume_fraction=0.1:0.9:5");
    EXPECT_THROW(sweep(bad), Error);
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    bad = request();
    bad.axes[1] = bad.axes[0];
    EXPECT_THROW(sweep(bad), Error);
}

TEST_F(SweepFolder, AStoppedSweepKeepsWhatIsDone) {
    CancelToken cancel;
    const JobControl control{[&](const ProgressReport& report) {
                                 if (report.stage == "sweep" && report.done == 2) cancel.request_stop();
                             },
                             &cancel};
    const SweepResult stopped = sweep(request(), control);
    EXPECT_TRUE(stopped.interrupted);
    EXPECT_EQ(stopped.computed, 2u);
    EXPECT_FALSE(fs::exists(folder_ / "out/sweep.csv"));
    EXPECT_EQ(sweep(request()).reused, 2u);
}

TEST_F(SweepFolder, UndefinedQuantitiesSurviveTheFile) {
    const std::vector<SweepQuantity> quantities = sweep_quantities(false);
    SweepPoint point;
    point.quantities.assign(quantities.size(), 0.1);
    point.quantities[1] = std::numeric_limits<double>::quiet_NaN();
    point.wavelengths_nm = {550.0};
    point.reflectance_45_0 = {1.0 / 3.0};
    write_sweep_point(folder_ / "p.json", "00ff", quantities, {"a=1"}, point);
    const auto back = read_sweep_point(folder_ / "p.json", "00ff", quantities);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->quantities[0], 0.1);
    EXPECT_TRUE(std::isnan(back->quantities[1]));
    EXPECT_EQ(back->reflectance_45_0, point.reflectance_45_0);
    EXPECT_FALSE(read_sweep_point(folder_ / "p.json", "00fe", quantities));
}

}  // namespace
}  // namespace patina::jobs
