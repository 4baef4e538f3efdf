#include "patina/render/bsdfs/measured.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/sampling.h"

namespace patina::render {

namespace {

constexpr float facet_share = 0.5f;

Vec3 draw(const Microfacets& facets, const Vec3& outgoing, float u, const Vec2& u2) {
    if (u >= facet_share) return cosine_hemisphere(u2);
    const Vec3 m = facets.sample(outgoing, u2);
    return 2 * outgoing.dot(m) * m - outgoing;
}

float density(const Microfacets& facets, const Vec3& outgoing, const Vec3& incident) {
    const Vec3 m = (outgoing + incident).normalized();
    const float of_facets = facets.density(m) / (4 * outgoing.z() * (1 + facets.lambda(outgoing)));
    return facet_share * of_facets + (1 - facet_share) * incident.z() * inv_pi_f;
}

template <class Model>
bool sample_table(const Model& model, const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2,
                  BsdfSample& sample) {
    if (outgoing.z() <= 0) return false;
    sample.incident = draw(model.proposal, outgoing, u, u2);
    return weigh_by_all_lobes(model, point, outgoing, sample);
}

Microfacets proposal_of(const Properties& node) {
    Microfacets facets;
    facets.kind = MicrofacetKind::ggx;
    const double alpha = node.number("alpha_sample", 0.1);
    if (!(alpha >= 1e-3 && alpha <= 2))
        throw input_error(node.location_of("alpha_sample"), "roughness out of range", fmt::format("it is {}", alpha),
                          "keep it between 0.001 and 2");
    facets.alpha_x = facets.alpha_y = static_cast<float>(alpha);
    return facets;
}

const ParameterDescriptor filename_parameter = {"filename", "path", "", "", "", "the file"};
const ParameterDescriptor alpha_parameter = {"alpha_sample", "number",     "",
                                             "0.1",          "0.001 .. 2", "roughness of the facets drawn from"};

}  // namespace

bool MeasuredPolarized::sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2,
                               BsdfSample& sample) const {
    return sample_table(*this, point, outgoing, u, u2, sample);
}

bool MeasuredPolarized::evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident,
                                 BsdfValue& value) const {
    if (outgoing.z() <= 0 || incident.z() <= 0) return false;
    const brdf::HalfAngles angles = brdf::half_angles(incident.cast<double>(), outgoing.cast<double>());
    value.f.form = ScatteringMatrix::Form::general;
    for (int k = 0; k < wavelengths_per_path; ++k) {
        const float nm = only_wavelength_nm > 0 ? only_wavelength_nm : point.wavelengths->nm[k];
        const optics::Mueller m = table->evaluate(nm, angles);
        for (int e = 0; e < 16; ++e) value.f.m[e][k] = static_cast<float>(m(e % 4, e / 4)) * incident.z();
    }
    value.f.x_in = value.f.x_out = common_perpendicular(incident, outgoing);
    value.pdf = density(proposal, outgoing, incident);
    return true;
}

PluginDescriptor MeasuredPolarized::describe() {
    return {"bsdf",
            "measured_polarized",
            "A Mueller BRDF table in Mitsuba's .pbsdf format.",
            {filename_parameter,
             alpha_parameter,
             {"wavelength", "number", "nm", "-1", "", "above 0: use only what was measured there"}}};
}

MeasuredPolarized MeasuredPolarized::build(const Properties& node, const BsdfBuilder& builder) {
    MeasuredPolarized m;
    const std::string path = node.string("filename");
    m.proposal = proposal_of(node);
    m.only_wavelength_nm = static_cast<float>(node.number("wavelength", -1.0));
    if (!builder.resources->load_half_angle_table)
        throw Error(ErrorKind::not_built, node.where.to_string() + ": measured tables are not available");
    m.table = builder.resources->load_half_angle_table(path);
    m.table->validate(node.location_of("filename"));
    return m;
}

bool Merl::sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const {
    return sample_table(*this, point, outgoing, u, u2, sample);
}

bool Merl::evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const {
    if (outgoing.z() <= 0 || incident.z() <= 0) return false;
    const brdf::HalfAngles angles = brdf::half_angles(incident.cast<double>(), outgoing.cast<double>());
    // Negative marks what was not measured.
    const Vec3 rgb = table->evaluate(angles).cwiseMax(0.0).cast<float>() * incident.z();
    const Wavelengths& w = *point.wavelengths;
    value.f.set_depolarizing(basis[0].at(w) * rgb[0] + basis[1].at(w) * rgb[1] + basis[2].at(w) * rgb[2]);
    value.pdf = density(proposal, outgoing, incident);
    return true;
}

PluginDescriptor Merl::describe() {
    return {"bsdf", "merl", "A BRDF of the MERL database (RGB, depolarizing).", {filename_parameter, alpha_parameter}};
}

Merl Merl::build(const Properties& node, const BsdfBuilder& builder) {
    Merl m;
    const std::string path = node.string("filename");
    m.proposal = proposal_of(node);
    if (!builder.resources->load_merl_table)
        throw Error(ErrorKind::not_built, node.where.to_string() + ": measured tables are not available");
    m.table = builder.resources->load_merl_table(path);

    // Smooth spectra of the three primaries, scaled to add up to 1 at every wavelength.
    std::array<SigmoidCoefficients, 3> primaries;
    for (int c = 0; c < 3; ++c)
        primaries[c] = sigmoid_coefficients(Eigen::Vector3d::Constant(0.05) + 0.85 * Eigen::Vector3d::Unit(c));
    for (int c = 0; c < 3; ++c)
        m.basis[c] = Spectrum([&](double nm) {
            const Wavelengths w = Wavelengths::all_at(static_cast<float>(nm));
            const auto value = [&](int k) { return static_cast<double>(sigmoid_reflectance(primaries[k], w)[0]); };
            return value(c) / (value(0) + value(1) + value(2));
        });
    return m;
}

}  // namespace patina::render
