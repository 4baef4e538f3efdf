#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patina/core/error.h"
#include "patina/rt/solver.h"
#include "patina/rt/test_problems.h"

namespace patina::rt {
namespace {

using testing_problems::physical_expansion;

std::string complaint(const Problem& problem) {
    try {
        validate(problem);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    return "";
}

TEST(Validate, RefusesWhatNatureRefuses) {
    const Problem good{
        1.0, {{1.0, 0.9, physical_expansion(1), 1.5}, {2.0, 0.9, physical_expansion(2), 1.4}}, LambertianBase{0.3}};
    EXPECT_EQ(complaint(good), "");
    const double nan = std::nan("");
    const std::vector<std::pair<std::function<void(Problem&)>, std::string>> cases{
        {[](Problem& p) { p.layers.clear(); }, "no layer"},
        {[](Problem& p) { p.layers[1].single_scattering_albedo = 1.01; }, "layer 1"},
        {[](Problem& p) { p.layers[0].single_scattering_albedo = -0.1; }, "layer 0"},
        {[=](Problem& p) { p.layers[0].single_scattering_albedo = nan; }, "albedo"},
        {[](Problem& p) { p.layers[0].optical_thickness = -1; }, "negative"},
        {[=](Problem& p) { p.layers[0].optical_thickness = nan; }, "thickness"},
        {[](Problem& p) { p.layers[0].optical_thickness = std::numeric_limits<double>::infinity(); }, "last layer"},
        {[](Problem& p) { p.layers[0].expansion.beta2.pop_back(); }, "unequal length"},
        {[](Problem& p) { p.layers[0].expansion.alpha1[0] = 2; }, "normalized"},
        {[](Problem& p) { p.layers[0].expansion.alpha1[1] = 3.1; }, "at most 3"},
        {[=](Problem& p) { p.layers[0].expansion.alpha4[1] = nan; }, "not a number"},
        {[](Problem& p) { p.layers[0].expansion = {}; }, "no expansion"},
        {[](Problem& p) { p.layers[0].refractive_index = 0.5; }, "refractive index"},
        {[](Problem& p) { p.refractive_index_above = 0.0; }, "above"},
        {[](Problem& p) { p.base = LambertianBase{1.5}; }, "reflectance 1.5"},
        {[](Problem& p) {
             p.base = MetalBase{{1.0, -2.0}};
         },
         "base"}};
    for (const auto& [spoil, word] : cases) {
        Problem bad = good;
        spoil(bad);
        EXPECT_THAT(complaint(bad), testing::HasSubstr(word));
    }
}

TEST(Validate, FieldRequestsMustPointIntoTheStack) {
    const Problem problem{1.0, {{1.0, 0.9, physical_expansion(1), 1.5}}, BlackBase{}};
    const FieldRequest good{0.5, {1, 0, 0, 0}, {0.0, 1.0}, {0.5}, {0.0}};
    const auto refused = [&](auto spoil) {
        FieldRequest bad = good;
        spoil(bad);
        EXPECT_THROW(solver_named("doubling").field(problem, bad, {.streams = 2}), Error);
    };
    refused([](FieldRequest& r) { r.mu_i = 0.0; });
    refused([](FieldRequest& r) { r.mu_i = 1.5; });
    refused([](FieldRequest& r) { r.mu_o = {-0.1}; });
    refused([](FieldRequest& r) { r.optical_depths = {1.5}; });
    refused([](FieldRequest& r) { r.optical_depths = {std::nan("")}; });
    refused([](FieldRequest& r) { r.phi = {std::nan("")}; });
    refused([](FieldRequest& r) { r.incident[2] = std::nan(""); });
}

}  // namespace
}  // namespace patina::rt
