#include "patina/render/scene_white.h"

#include "patina/render/spectrum.h"
#include "patina/render/vec.h"

namespace patina::render {

namespace {

bool looks_like_daylight(const SpectrumSpec& spec) {
    if (spec.kind == SpectrumSpec::Kind::rgb) return true;
    if (spec.kind != SpectrumSpec::Kind::sampled) return false;
    const Spectrum table = emission_table(spec, {});
    const ColourMatching matching;
    Float4 xyz{};
    for (int nm = 380; nm < 780; ++nm)
        xyz += matching.xyz(nm - 380) * table.at(Wavelengths::all_at(static_cast<float>(nm)))[0];
    const float sum = xyz[0] + xyz[1] + xyz[2];
    if (!(sum > 0)) return false;
    // CIE 15:2018: D65 and the equal-energy stimulus.
    const Vec2 xy(xyz[0] / sum, xyz[1] / sum), daylight(0.3127f, 0.3290f), uniform(1 / 3.0f, 1 / 3.0f);
    return (xy - daylight).norm() < (xy - uniform).norm();
}

bool shines_daylight(const Properties& emitter) {
    if (emitter.type == "envmap") return true;
    for (const Properties::Entry& entry : emitter.entries)
        if (const auto* spec = std::get_if<SpectrumSpec>(&entry.value); spec && looks_like_daylight(*spec)) return true;
    return false;
}

}  // namespace

bool lit_by_daylight(const Properties& scene) {
    for (const Properties::Child& child : scene.children) {
        const Properties& node = *child.node;
        if (node.category == "emitter" && shines_daylight(node)) return true;
        if (node.category == "shape" && lit_by_daylight(node)) return true;
    }
    return false;
}

}  // namespace patina::render
