#include "patina/render/scene_white.h"

namespace patina::render {

namespace {

// An environment map's pixels colour it, but their mean is D65 for the greys most of them are.
const Spectrum& light_of(const Emitter& emitter) {
    struct Light {
        const Spectrum& operator()(const AreaEmitter& e) const { return e.radiance; }
        const Spectrum& operator()(const PointEmitter& e) const { return e.intensity; }
        const Spectrum& operator()(const DirectionalEmitter& e) const { return e.irradiance; }
        const Spectrum& operator()(const SpotEmitter& e) const { return e.intensity; }
        const Spectrum& operator()(const ConstantEmitter& e) const { return e.radiance; }
        const Spectrum& operator()(const EnvironmentEmitter& e) const { return e.illuminant; }
    };
    return std::visit(Light{}, emitter);
}

Vec3 xyz_of(const Spectrum& light, const ColourMatching& matching) {
    Vec3 sum = Vec3::Zero();
    constexpr int step = 2;  // nm
    for (int node = 0; node + step < spectrum_nodes; node += step) {
        const float value = light.at(Wavelengths::all_at(wavelength_min_nm + static_cast<float>(node)))[0];
        const Float4 xyz = matching.xyz(node);
        sum += value * Vec3(xyz[0], xyz[1], xyz[2]);
    }
    return sum;
}

}  // namespace

Vec3 white_of_emitters(const std::vector<Emitter>& emitters, const Geometry& geometry, const ColourMatching& matching) {
    Vec3 white = Vec3::Zero();
    for (const Emitter& emitter : emitters) {
        const Spectrum& light = light_of(emitter);
        const float average = light.average();
        if (average > 0) white += xyz_of(light, matching) * (emitted_power(emitter, geometry) / average);
    }
    return white;
}

}  // namespace patina::render
