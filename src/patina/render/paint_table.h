#pragma once
// A Mueller BRDF table in the form the kernels read: small, in half precision, linear between nodes on all axes.
//
// Axes: polar angles of the viewer and of the light (equidistant in angle, where every Fourier mode is smooth), azimuth
// phi of the outgoing minus the incident propagation direction on 0 .. pi (mirror symmetry gives the rest), wavelength.
// Frames: the x axes are e_theta turned about the ray by -phi/2, that is the direction half way between both azimuths,
// carried up the sphere. Such frames turn nowhere faster than the azimuth does, neither at the normal, where meridian
// planes do, nor at backscattering, where scattering planes do, so that linear interpolation is safe everywhere.
//
// Reciprocity spares half of the pairs of polar angles of the whole matrix: in these frames f(o, i) = S f(i, o)^T S
// with S = diag(1, 1, 1, -1) at the same phi, for exchanging the rays mirrors phi, and turns y over with the direction
// of each ray. Only theta_o <= theta_i is kept.
//
// A path's wavelengths are a quarter of the range apart (Wavelengths::sample), so all four lie at the same place in
// their quarters: a node keeps the four quarters beside each other, and one load brings a column of the matrix for all
// of them. Any other wavelengths are read one by one.

#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "patina/brdf/mueller_table.h"
#include "patina/render/mueller_packet.h"
#include "patina/render/spectrum.h"

namespace patina::render {

// Memory in pages of 2 MB where the system grants them: random reads of 20 MB miss the processor's list of small pages
// nearly every time.
void* allocate_in_large_pages(std::size_t bytes);
template <class T>
struct LargePages {
    using value_type = T;
    LargePages() = default;
    template <class U>
    LargePages(const LargePages<U>&) {}
    T* allocate(std::size_t count) { return static_cast<T*>(allocate_in_large_pages(count * sizeof(T))); }
    void deallocate(T* memory, std::size_t) { std::free(memory); }
    friend bool operator==(const LargePages&, const LargePages&) { return true; }
};

class PaintTable {
  public:
    struct Size {
        int angles = 32, azimuths = 33;
        int intervals = 4;  // of wavelength, in each quarter of the visible range
    };
    explicit PaintTable(const brdf::MuellerTable& table) : PaintTable(table, Size{}) {}
    PaintTable(const brdf::MuellerTable& table, const Size& size);

    // The body BRDF, 1/sr, no cosine. With `first_column_only` the other columns are left as they are.
    void evaluate(const Wavelengths& w, const Vec3& outgoing, const Vec3& incident, bool first_column_only,
                  ScatteringMatrix& f) const;

    // The delta part into the mirror direction: a, b, c, d of a Fresnel matrix with x across the plane of incidence.
    std::array<Float4, 4> specular(const Wavelengths& w, float cos_o) const;

    // Share of unpolarized light in the delta part among all that is reflected to this side, on average over
    // wavelengths.
    float specular_share(float cos_o) const;

    // Draws a direction of the light in proportion, nearly, to the body BRDF times its cosine; and the density of that.
    Vec3 sample(const Vec3& outgoing, const Vec2& u, float choice, float& pdf) const;
    float pdf(const Vec3& outgoing, const Vec3& incident) const;

  private:
    // Of the square of the light's cosine, and of its azimuth from the viewer's, either way alike.
    static constexpr int rows = 32, columns = 16;
    static constexpr int specular_nodes = 361;

    // Index and weight of a linear interpolation on nodes 0 .. count - 1.
    struct Interval {
        int lower;
        float weight;
        Interval(float position, int count) {
            lower = std::clamp(static_cast<int>(position), 0, std::max(count - 2, 0));
            weight = count < 2 ? 0.0f : std::clamp(position - static_cast<float>(lower), 0.0f, 1.0f);
        }
    };
    // Density of sample() in a cell for a viewer's angle, relative to the cosine-weighted hemisphere.
    float cell_density(const Interval& outgoing, int row, int column) const;

    // Where a pair of directions lies on the axes.
    struct Place {
        float theta_o, theta_i, phi;  // in units of nodes, phi in 0 .. pi
        bool mirrored;                // phi was negative
        float cos_half, sin_half;     // of phi / 2, signed
        Vec2 azimuth_o, azimuth_k;    // unit vectors: of the outgoing and of the incident propagation direction
    };
    Place place(const Vec3& outgoing, const Vec3& incident) const;
    // Where a wavelength lies: quarter of the range, node below it in there, and how far beyond that.
    struct WavelengthPlace {
        int quarter, lower;
        float weight;
    };
    WavelengthPlace wavelength_place(float nm) const;
    // The body at `at` for four wavelengths in the order of the quarters: its first column, and all four.
    StokesPacket first_column(const Place& at, const WavelengthPlace& wavelength) const;
    void whole_matrix(const Place& at, const WavelengthPlace& wavelength, StokesPacket* matrix) const;
    // visit(theta_o, theta_i, phi, weights of the lower and of the higher wavelength) for the nodes about a place.
    template <class Visit>
    void for_corners(const Place& at, const WavelengthPlace& wavelength, const Visit& visit) const;
    double wavelength_nm(int index) const;  // of 4 intervals + 1 nodes over the range
    void tabulate_body(const brdf::MuellerTable& table);
    void gather_first_columns();
    void tabulate_specular(const brdf::MuellerTable& table);
    void tabulate_sampling();
    // Place of a pair of polar angles, the smaller first, and an azimuth.
    std::size_t node(int small, int large, int p) const {
        const int pair = small * size_.angles - small * (small - 1) / 2 + large - small;
        return (static_cast<std::size_t>(pair) * size_.azimuths + p) * block_;
    }
    std::size_t first_node(int o, int i, int p) const {
        return (static_cast<std::size_t>(o * size_.angles + i) * size_.azimuths + p) * (16 * nodes_);
    }
    // Light's direction cell by cell, for one node of the viewer's angle.
    struct DirectionCells {
        std::array<float, rows + 1> of_row;                          // cumulative over cos^2
        std::array<std::array<float, columns + 1>, rows> of_column;  // cumulative over the azimuth, for each row
        float density(int row, int column) const {                   // relative to the cosine-weighted hemisphere
            return (of_row[row + 1] - of_row[row]) * (of_column[row][column + 1] - of_column[row][column]) *
                   (rows * columns);
        }
    };

    Size size_;
    double only_wavelength_nm_ = 0;  // of a table that has just one; no intervals then
    int nodes_ = 1;                  // of wavelength in a quarter, both its ends
    int specular_wavelengths_ = 1;   // nodes over the whole range
    std::size_t block_;              // halves a node holds: [node of wavelength][column][row][quarter]
    std::vector<std::uint16_t, LargePages<std::uint16_t>> body_;  // [theta_o <= theta_i][phi][block]
    // What unpolarized light becomes, which is asked for most: beside each other, for memory is read in lines.
    // [theta_o][theta_i][phi][node of wavelength][row][quarter]
    std::vector<std::uint16_t, LargePages<std::uint16_t>> first_columns_;
    std::vector<std::array<float, 4>> specular_;  // [theta][wavelength]
    std::vector<float> specular_share_;           // [theta_o]
    std::vector<DirectionCells> directions_;      // [theta_o]
};

}  // namespace patina::render
