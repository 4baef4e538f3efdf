#include "patina/rt/problem_fingerprint.h"

namespace patina::rt {

namespace {

// Numbers are told apart from their neighbours by their count.
void add_list(Fingerprint& fingerprint, const std::vector<double>& values) {
    fingerprint.add(static_cast<double>(values.size()));
    for (const double value : values) fingerprint.add(value);
}

void add_roughness(Fingerprint& fingerprint, const std::optional<RoughSurface>& roughness) {
    if (!roughness) return;
    fingerprint.add(roughness->alpha);
    fingerprint.add(static_cast<double>(roughness->distribution));
}

struct AddBase {
    Fingerprint& fingerprint;

    void operator()(const BlackBase&) const {}
    void operator()(const LambertianBase& base) const { fingerprint.add(base.reflectance); }
    void operator()(const MetalBase& base) const {
        fingerprint.add(base.refractive_index.real());
        fingerprint.add(base.refractive_index.imag());
        add_roughness(fingerprint, base.roughness);
    }
    // By what it does at a few cosines.
    void operator()(const SurfaceBase& base) const {
        const Eigen::VectorXd mu = Eigen::VectorXd::LinSpaced(5, 0.1, 0.97);
        for (int m = 0; m <= base.surface->order(); ++m)
            for (const double value : base.surface->mode(m, mu).reshaped()) fingerprint.add(value);
        for (const double cosine : mu)
            for (const double value : base.surface->specular(cosine).reshaped()) fingerprint.add(value);
    }
};

}  // namespace

void add_to(Fingerprint& fingerprint, const Problem& problem) {
    fingerprint.add(problem.refractive_index_above);
    fingerprint.add(problem.top_roughness ? "rough" : "smooth");
    add_roughness(fingerprint, problem.top_roughness);
    fingerprint.add(static_cast<double>(problem.layers.size()));
    for (const Layer& layer : problem.layers) {
        fingerprint.add(layer.optical_thickness);
        fingerprint.add(layer.single_scattering_albedo);
        fingerprint.add(layer.refractive_index);
        const optics::ExpansionCoefficients& x = layer.expansion;
        for (const auto* list : {&x.alpha1, &x.alpha2, &x.alpha3, &x.alpha4, &x.beta1, &x.beta2})
            add_list(fingerprint, *list);
    }
    fingerprint.add(static_cast<double>(problem.base.index()));
    std::visit(AddBase{fingerprint}, problem.base);
}

}  // namespace patina::rt
