#pragma once
// Recipes drawn over what is legal: layers by composition and in optical terms, tinted binders, every distribution of
// sizes and way to count it, birefringent and packed particles, every interface and analytic base, thin to infinite,
// black to conservative.

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
        if (chance(0.6)) result += interface();
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

    // Lobes of rougher facets are within what the few streams of a comparison carry.
    std::string interface() {
        if (chance(0.7)) return "[interface]\ntype = \"smooth\"\n";
        return fmt::format("[interface]\ntype = \"rough\"\nalpha = {}\ndistribution = \"{}\"\n", log_between(0.3, 0.9),
                           chance(0.5) ? "ggx" : "beckmann");
    }

    std::string composition(double index) {
        constexpr const char* packings[] = {"auto", "auto", "independent", "percus-yevick"};
        const double k = chance(0.5) ? 0.0 : chance(0.7) ? log_between(1e-9, 1e-4) : log_between(1e-4, 0.04);
        std::string result =
            fmt::format("[[layers]]\nthickness_um = {}\nbinder = {{ n = {}, k = {} }}\npacking = \"{}\"\n",
                        log_between(0.01, 300.0), index, k, packings[whole(4)]);
        const int pigments = whole(3);
        for (int p = 0; p < pigments; ++p)
            result += fmt::format("[[layers.pigments]]\n{}volume_fraction = {}\nsize = {}\n", pigment_material(),
                                  log_between(1e-3, 0.3), size());
        return result;
    }

    std::string pigment_material() {
        const double n = between(0.3, 3.2), k = chance(0.5) ? 0.0 : log_between(1e-5, 3.0);
        if (chance(0.85)) return fmt::format("material = {{ n = {}, k = {} }}\n", n, k);
        return fmt::format(
            "material_ordinary = {{ n = {0}, k = {2} }}\nmaterial_extraordinary = {{ n = {1}, k = {2} }}\n", n,
            n * between(0.85, 1.15), k);
    }

    std::string size() {
        const double r = log_between(0.005, 0.3);
        constexpr const char* counted[] = {"number", "area", "volume"};
        const std::string weighting = fmt::format(", weighting = \"{}\" }}", counted[whole(3)]);
        switch (whole(7)) {
            case 0:
                return fmt::format("{{ distribution = \"mono\", radius_um = {} }}", r);
            case 1:
                return fmt::format("{{ distribution = \"lognormal\", median_radius_um = {}, sigma_g = {}", r,
                                   between(1.05, 1.4)) +
                       weighting;
            case 2:
                return fmt::format("{{ distribution = \"gamma\", effective_radius_um = {}, effective_variance = {}", r,
                                   between(0.02, 0.15)) +
                       weighting;
            case 3:
                return fmt::format("{{ distribution = \"modified-gamma\", alpha = {}, gamma = {}, mode_radius_um = {}",
                                   between(2.0, 8.0), between(0.7, 2.0), 0.5 * r) +
                       weighting;
            case 4:
                return fmt::format(
                           "{{ distribution = \"power-law\", exponent = {}, min_radius_um = {}, max_radius_um = {}",
                           between(2.0, 5.0), 0.3 * r, 1.5 * r) +
                       weighting;
            case 5:
                return fmt::format("{{ distribution = \"rosin-rammler\", scale_radius_um = {}, spread = {}", 0.7 * r,
                                   between(2.0, 5.0)) +
                       weighting;
            default:
                return fmt::format("{{ distribution = \"histogram\", edges_um = [{}, {}, {}], fractions = [1, {}]",
                                   0.5 * r, r, 1.6 * r, between(0.1, 3.0)) +
                       weighting;
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
