#pragma once
// What one sample of an integrator leaves: Stokes vectors by class of path, for its own pixel and for others.

#include <vector>

#include "patina/render/packet.h"
#include "patina/render/spectrum.h"
#include "patina/render/vec.h"

namespace patina::render {

// Light that reaches the film elsewhere than where the sample looks, of a path that began at a lamp.
struct Splat {
    Vec2 film;  // position in the whole film, (0, 0) .. (1, 1)
    int path_class = 0;
    StokesPacket stokes;  // in the frame of the camera ray there
    Wavelengths wavelengths;
};

class PathRecord {
  public:
    explicit PathRecord(int classes) : sums_(classes, StokesPacket{}) {}

    void begin() {
        for (StokesPacket& sum : sums_) sum = StokesPacket{};
        hit = false;
        splats.clear();
    }
    void add(const StokesPacket& stokes, int path_class) { sums_[path_class] += stokes; }
    void add_splat(const Splat& splat) { splats.push_back(splat); }

    int class_count() const { return static_cast<int>(sums_.size()); }
    const StokesPacket& of_class(int path_class) const { return sums_[path_class]; }
    StokesPacket total() const {
        StokesPacket sum = sums_[0];
        for (std::size_t c = 1; c < sums_.size(); ++c) sum += sums_[c];
        return sum;
    }

    bool hit = false;  // the camera ray met a surface
    std::vector<Splat> splats;

  private:
    std::vector<StokesPacket> sums_;  // in the camera ray's frame
};

}  // namespace patina::render
