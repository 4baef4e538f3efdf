#include "patina/rt/problem_fingerprint.h"

namespace patina::rt {

namespace {

// Numbers are told apart from their neighbours by their count.
void add_list(Fingerprint& fingerprint, const std::vector<double>& values) {
    fingerprint.add(static_cast<double>(values.size()));
    for (const double value : values) fingerprint.add(value);
}

struct AddBase {
    Fingerprint& fingerprint;

    void operator()(const BlackBase&) const {}
    void operator()(const LambertianBase& base) const { fingerprint.add(base.reflectance); }
    void operator()(const MetalBase& base) const {
        fingerprint.add(base.refractive_index.real());
        fingerprint.add(base.refractive_index.imag());
        if (!base.roughness) return;
        fingerprint.add(base.roughness->alpha);
        fingerprint.add(static_cast<double>(base.roughness->distribution));
    }
};

}  // namespace

void add_to(Fingerprint& fingerprint, const Problem& problem) {
    fingerprint.add(problem.refractive_index_above);
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
