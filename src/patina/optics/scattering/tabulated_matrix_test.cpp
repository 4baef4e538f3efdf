#include "patina/optics/scattering/tabulated_matrix.h"

#include "patina/core/constants.h"
#include "patina/optics/scattering/expansion.h"

namespace patina::optics {
namespace {

ScatteringTable table_of(const ExpansionCoefficients& c, int intervals) {
    ScatteringTable t;
    for (int i = 0; i <= intervals; ++i) {
        t.angles_deg.push_back(180.0 * i / intervals);
        const ScatteringElements f = evaluate(c, std::cos(pi * i / intervals));
        t.a1.push_back(f.a1), t.a2.push_back(f.a2), t.a3.push_back(f.a3), t.a4.push_back(f.a4);
        t.b1.push_back(f.b1), t.b2.push_back(f.b2);
    }
    return t;
}

// A made-up law of low orders with a2 != a1 and a4 != a3.
const ExpansionCoefficients smooth{{1, 0.9, 0.5, 0.1},    {0, 0, 0.8, 0.1},  {0, 0, 0.1, 0.1},
                                   {0.1, 0.5, 0.1, 0.02}, {0, 0, 0.3, 0.05}, {0, 0, 0.1, -0.03}};

double largest_error(int intervals) {
    const ExpansionCoefficients c = expand(table_of(smooth, intervals), 1e-12);
    double error = 0.0;
    for (int l = 0; l <= 3; ++l)
        error = std::max({error, std::abs(c.alpha1[l] - smooth.alpha1[l]), std::abs(c.alpha2[l] - smooth.alpha2[l]),
                          std::abs(c.alpha3[l] - smooth.alpha3[l]), std::abs(c.alpha4[l] - smooth.alpha4[l]),
                          std::abs(c.beta1[l] - smooth.beta1[l]), std::abs(c.beta2[l] - smooth.beta2[l])});
    return error;
}

TEST(TabulatedMatrix, ConvergesWithTheFourthPowerOfTheSpacing) {
    // Splines: h^4, so 16 from 18 to 36 intervals; 1 degree gives the digits tables have.
    EXPECT_GT(largest_error(18) / largest_error(36), 12.0);
    EXPECT_LT(largest_error(180), 1e-7);
}

TEST(TabulatedMatrix, ScaleDoesNotMatter) {
    ScatteringTable t = table_of(smooth, 180);
    for (auto* column : {&t.a1, &t.a2, &t.a3, &t.a4, &t.b1, &t.b2})
        for (double& value : *column) value *= 37.0;
    const ExpansionCoefficients c = expand(t, 1e-9);
    EXPECT_NEAR(c.alpha1[0], 1.0, 1e-13);
    EXPECT_NEAR(c.beta1[2], smooth.beta1[2], 1e-7);
}

TEST(TabulatedMatrix, RefusesWhatIsNotAScatteringMatrix) {
    const ScatteringTable good = table_of(smooth, 18);
    EXPECT_NO_THROW(validate(good));
    const auto refused = [&](auto change) {
        ScatteringTable bad = good;
        change(bad);
        EXPECT_THROW(validate(bad), Error);
        EXPECT_THROW(expand(bad, 1e-6), Error);
    };
    refused([](ScatteringTable& t) { t.b2.pop_back(); });
    refused([](ScatteringTable& t) { t.angles_deg[3] = t.angles_deg[2]; });
    refused([](ScatteringTable& t) { t.angles_deg.back() = 170.5; });
    refused([](ScatteringTable& t) { t.a1[4] = -1.0; });
    refused([](ScatteringTable& t) { t.b1[4] = 2 * t.a1[4]; });
    refused([](ScatteringTable& t) { t.a4[4] = std::nan(""); });
    refused([](ScatteringTable& t) { t = {}; });
}

}  // namespace
}  // namespace patina::optics
