#pragma once
// What the camera sees of an emitter's light at the end of a path: the first column of the throughput for unpolarized
// light, all of it for the rest.

#include "patina/render/emitters.h"

namespace patina::render {

// Light of this radiance that the emitter sends along `travel` arrives now.
inline StokesPacket arriving(const Throughput& throughput, const Lights& lights, int emitter, Float4 radiance,
                             const Vec3& travel) {
    if (!lights.polarized(emitter)) return throughput.of_unpolarized(radiance);
    const LightBeam beam = lights.beam(emitter, radiance, travel);
    return throughput.of(beam.stokes, beam.x_axis, beam.direction);
}

// The same through one more event (world axes), after which the light leaves to `outgoing`.
inline StokesPacket arriving(const Throughput& throughput, const Lights& lights, int emitter, Float4 radiance,
                             const Vec3& travel, const ScatteringMatrix& event, const Vec3& outgoing) {
    if (!lights.polarized(emitter)) return throughput.of_unpolarized(radiance, event, outgoing);
    LightBeam beam = lights.beam(emitter, radiance, travel);
    beam.scatter(event, outgoing);
    return throughput.of(beam.stokes, beam.x_axis, beam.direction);
}

}  // namespace patina::render
