#pragma once
// Recipes drawn over what is legal: layers by composition and in optical terms, every base, thin to infinite, black to
// conservative.

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace patina::cross {

// `expansions` are the CSV files that optical layers choose from.
class RandomRecipe {
  public:
    RandomRecipe(std::uint64_t seed, const std::vector<std::string>& expansions)
        : random_(seed), expansions_(expansions) {}

    std::string text() {
        std::string result;
        if (chance(0.6)) result += "[interface]\ntype = \"smooth\"\n";
        const int layers = 1 + whole(3);
        const double shared_index = between(1.3, 1.7);
        for (int k = 0; k < layers; ++k) {
            // Half of the stacks have one binder throughout, the others refract at each layer.
            const double index = k == 0 || chance(0.5) ? shared_index : between(1.3, 1.7);
            result += chance(0.6) ? composition(index) : optical_layer(k + 1 == layers, index);
        }
        return result + base();
    }

  private:
    bool chance(double share) { return between(0.0, 1.0) < share; }
    int whole(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    double log_between(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }

    std::string composition(double index) {
        std::string result = fmt::format("[[layers]]\nthickness_um = {}\nbinder = {{ n = {}, k = {} }}\n",
                                         log_between(0.01, 300.0), index, chance(0.5) ? 0.0 : log_between(1e-9, 1e-4));
        const int pigments = whole(3);
        for (int p = 0; p < pigments; ++p)
            result += fmt::format(
                "[[layers.pigments]]\nmaterial = {{ n = {}, k = {} }}\nvolume_fraction = {}\nsize = {}\n",
                between(0.3, 3.2), chance(0.5) ? 0.0 : log_between(1e-5, 3.0), log_between(1e-3, 0.3), size());
        return result;
    }

    std::string size() {
        const double radius_um = log_between(0.005, 0.3);
        switch (whole(3)) {
            case 0:
                return fmt::format("{{ distribution = \"mono\", radius_um = {} }}", radius_um);
            case 1:
                return fmt::format("{{ distribution = \"lognormal\", median_radius_um = {}, sigma_g = {} }}", radius_um,
                                   between(1.05, 1.4));
            default:
                return fmt::format("{{ distribution = \"gamma\", effective_radius_um = {}, effective_variance = {} }}",
                                   radius_um, between(0.02, 0.15));
        }
    }

    std::string optical_layer(bool lowest, double index) {
        const std::string thickness = lowest && chance(0.2) ? "inf" : fmt::format("{}", log_between(1e-6, 1e3));
        const double kind = between(0.0, 1.0);
        const double albedo = kind < 0.1   ? 0.0
                              : kind < 0.3 ? 1.0
                              : kind < 0.6 ? 1.0 - log_between(1e-6, 1e-2)
                                           : between(0.0, 1.0);
        return fmt::format(
            "[[layers]]\noptical_thickness = {}\nsingle_scattering_albedo = {}\nexpansion = \"{}\"\n"
            "refractive_index = {}\n",
            thickness, albedo, expansions_[whole(static_cast<int>(expansions_.size()))], index);
    }

    std::string base() {
        const std::string metal = fmt::format("[base]\ntype = \"metal\"\nmaterial = {{ n = {}, k = {} }}\n",
                                              between(0.05, 3.0), between(0.5, 8.0));
        switch (whole(4)) {
            case 0:
                return "[base]\ntype = \"none\"\n";
            case 1:
                return fmt::format("[base]\ntype = \"lambertian\"\nreflectance = {}\n", between(0.0, 1.0));
            case 2:
                return metal;
            default:
                return metal + fmt::format("alpha = {}\ndistribution = \"{}\"\n", log_between(0.1, 0.9),
                                           chance(0.5) ? "ggx" : "beckmann");
        }
    }

    std::mt19937_64 random_;
    const std::vector<std::string>& expansions_;
};

}  // namespace patina::cross
