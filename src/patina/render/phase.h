#pragma once
// Scattering inside a medium: what every phase function offers.
//
// The particles are randomly oriented (or spheres), so that scattering depends on the angle alone: the matrix F of
// docs/conventions.md, in the frame of the scattering plane, normalised to (1/2) int a1 dcos = 1. A ray scattered into
// the solid angle dw carries F / (4 pi) dw. Angles are drawn from a1 of one of the path's wavelengths, with density
// a1 / 2 per cosine.

#include <concepts>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "patina/core/properties.h"
#include "patina/render/mueller_packet.h"
#include "patina/render/render.h"
#include "patina/render/spectrum.h"

namespace patina::render {

// F at one scattering angle for the path's wavelengths; `kind` says which elements differ from what it implies.
struct PhaseElements {
    enum class Kind {
        scalar,  // a1 alone: the light leaves unpolarized
        sphere,  // a2 = a1, a4 = a3
        general
    };
    Kind kind = Kind::scalar;
    Float4 a1, a2, a3, a4, b1, b2;
};

// F between the scattering plane's frames in the renderer's signs (stokes_frames.h: U turns, so b2 changes its sign),
// for light that travels along k_in and leaves along k_out. x is in the plane: x = k x n, n across the plane.
inline ScatteringMatrix phase_matrix(const PhaseElements& f, const Vec3& k_in, const Vec3& k_out) {
    ScatteringMatrix m;
    if (f.kind == PhaseElements::Kind::scalar) {
        m.set_depolarizing(f.a1);
        return m;
    }
    const Vec3 across = common_perpendicular(k_in, k_out);
    const Vec3 x_in = k_in.cross(across), x_out = k_out.cross(across);
    if (f.kind == PhaseElements::Kind::sphere) {
        m.set_fresnel(f.a1, f.b1, f.a3, -f.b2, x_in, x_out);
        return m;
    }
    m.form = ScatteringMatrix::Form::general;
    m.x_in = x_in, m.x_out = x_out;
    for (Float4& element : m.m) element = splat(0);
    m.m[0] = f.a1, m.m[1] = m.m[4] = f.b1, m.m[5] = f.a2;
    m.m[10] = f.a3, m.m[11] = f.b2, m.m[14] = -f.b2, m.m[15] = f.a4;
    return m;
}

template <class Model>
concept PhaseModel = requires(const Model model, const Wavelengths& w, float x, int lane) {
    // F at a cosine of the scattering angle in [-1, 1].
    { model.elements(w, x) } -> std::same_as<PhaseElements>;
    // A cosine with density a1 / 2 at wavelength `lane`, from x in [0, 1).
    { model.sample_cosine(w, lane, x) } -> std::same_as<float>;
};

// What a phase function's constructor from a scene file is given.
struct PhaseBuilder {
    const SceneResources* resources;
    std::map<std::string, std::string>* notes;  // provenance that belongs into the picture's metadata
};

}  // namespace patina::render
