#include <cmath>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/rt/solver.h"

namespace patina::rt {

namespace {

Error bad(const std::string& problem, const std::string& why, const std::string& suggestion) {
    return input_error(SourceLocation{}, problem, why, suggestion);
}

void validate_roughness(const std::optional<RoughSurface>& surface, const std::string& name) {
    if (surface && !(surface->alpha > 0.0 && surface->alpha <= 1.0))
        throw bad(fmt::format("{} has alpha = {}", name, surface->alpha), "it lies in (0, 1]",
                  surface->alpha > 1.0 ? "at most 1" : "leave it smooth");
}

void validate_expansion(const optics::ExpansionCoefficients& x, const std::string& name) {
    if (x.alpha1.empty())
        throw bad(name + " has no expansion coefficients", "alpha1 is empty", "give at least alpha1 = [1]");
    const std::size_t size = x.alpha1.size();
    for (const auto* list : {&x.alpha2, &x.alpha3, &x.alpha4, &x.beta1, &x.beta2})
        if (list->size() != size)
            throw bad(name + " has expansion coefficients of unequal length",
                      fmt::format("alpha1 has {}, another has {}", size, list->size()),
                      "give all six for every degree");
    for (const auto* list : {&x.alpha1, &x.alpha2, &x.alpha3, &x.alpha4, &x.beta1, &x.beta2})
        for (double value : *list)
            if (!std::isfinite(value)) throw bad(name + " has an expansion coefficient that is not a number", "", "");
    if (std::abs(x.alpha1[0] - 1.0) > 1e-6)
        throw bad(fmt::format("{} has alpha1[0] = {}", name, x.alpha1[0]), "the phase function must be normalized",
                  "divide by it");
    for (std::size_t l = 0; l < size; ++l)
        if (std::abs(x.alpha1[l]) > (2.0 * l + 1.0) * (1.0 + 1e-6))
            throw bad(fmt::format("{} has alpha1[{}] = {}", name, l, x.alpha1[l]),
                      "no positive phase function has a coefficient above 2l+1", fmt::format("at most {}", 2 * l + 1));
}

void validate_layer(const Layer& layer, std::size_t k, std::size_t count) {
    const std::string name = fmt::format("layer {}", k);
    const double tau = layer.optical_thickness, albedo = layer.single_scattering_albedo, n = layer.refractive_index;
    if (!(tau >= 0.0))
        throw bad(fmt::format("{} has optical thickness {}", name, tau), "it cannot be negative", "0 or more");
    if (std::isinf(tau) && k + 1 < count)
        throw bad(name + " is infinitely thick", "nothing below it can be seen", "make it the last layer");
    if (!(albedo >= 0.0 && albedo <= 1.0))
        throw bad(fmt::format("{} has single-scattering albedo {}", name, albedo),
                  "scattered light is a part of the extinguished", albedo > 1.0 ? "at most 1" : "at least 0");
    if (!(n >= 1.0 && std::isfinite(n)))
        throw bad(fmt::format("{} has refractive index {}", name, n), "the host must be transparent", "1 or more");
    validate_expansion(layer.expansion, name);
}

}  // namespace

void validate(const Problem& problem) {
    if (problem.layers.empty()) throw bad("the problem has no layer", "", "give at least one");
    const double above = problem.refractive_index_above;
    if (!(above >= 1.0 && std::isfinite(above)))
        throw bad(fmt::format("the medium above has refractive index {}", above), "", "1 for air");
    for (std::size_t k = 0; k < problem.layers.size(); ++k) validate_layer(problem.layers[k], k, problem.layers.size());
    if (const auto* lambertian = std::get_if<LambertianBase>(&problem.base))
        if (!(lambertian->reflectance >= 0.0 && lambertian->reflectance <= 1.0))
            throw bad(fmt::format("the base has reflectance {}", lambertian->reflectance),
                      "it is a fraction of the light", lambertian->reflectance > 1.0 ? "at most 1" : "at least 0");
    validate_roughness(problem.top_roughness, "the top interface");
    if (const auto* known = std::get_if<SurfaceBase>(&problem.base); known && !known->surface)
        throw bad("the base has no surface", "", "give its reflection");
    if (const auto* metal = std::get_if<MetalBase>(&problem.base)) {
        const auto m = metal->refractive_index;
        validate_roughness(metal->roughness, "the base");
        if (!(m.real() >= 0.0 && m.imag() >= 0.0 && std::isfinite(m.real()) && std::isfinite(m.imag()) &&
              std::abs(m) > 0.0))
            throw bad(fmt::format("the base has refractive index {} + {} i", m.real(), m.imag()),
                      "n and k cannot be negative, and k > 0 absorbs", "0 or more");
    }
}

}  // namespace patina::rt
