#pragma once
// A scattering matrix tabulated against wavelength and angle, and exact sampling of its a1.

#include <span>
#include <vector>

#include "patina/optics/scattering/expansion.h"
#include "patina/render/phase.h"

namespace patina::render {

// Nodes are equidistant in sqrt(1 - |cos|) in each hemisphere, dense at both poles; linear in the cosine between them
// and in the wavelength. What is drawn from is that very interpolant of a1, so that no weight arises from the table.
class PhaseTable {
  public:
    // One expansion for every wavelength of a regular grid; one alone counts for all wavelengths. A truncated expansion
    // may be negative or polarize more than fully somewhere: a1 is kept above 1e-6 of its mean, and the other elements
    // within what particles can do.
    PhaseTable(std::span<const optics::ExpansionCoefficients> expansions, double first_nm, double step_nm);

    PhaseElements elements(const Wavelengths& w, float cosine) const;
    float sample_cosine(const Wavelengths& w, int lane, float u) const;

  private:
    struct Node {
        float a1, a2, a3, a4, b1, b2;
    };
    struct Place {
        int row = 0;  // wavelength below
        float fraction = 0;
    };
    Place place(float nm) const;
    const Node* row(int index) const { return &nodes_[static_cast<std::size_t>(index) * row_size()]; }
    std::size_t row_size() const { return 2 * static_cast<std::size_t>(cells_ + 1); }
    void append(const std::vector<optics::ScatteringElements>& row);

    int cells_ = 0;  // per hemisphere
    int rows_ = 0;   // wavelengths
    float first_nm_ = 0, step_nm_ = 1;
    bool spheres_ = true;            // a2 = a1 and a4 = a3 throughout
    std::vector<Node> nodes_;        // [wavelength][hemisphere][cells + 1]: from cos = 1 to 0, from cos = -1 to 0
    std::vector<float> cumulative_;  // [wavelength][2 cells + 1]: cells in the order of the nodes
};

}  // namespace patina::render
