#pragma once
// Mueller matrices of four wavelengths at once, as scattering events produce them and as a path multiplies them up.
//
// Most events are sparse: a depolarizer has one number, a Fresnel event four in its own frame. Each matrix names the x
// axes of the frames it acts between; only a path's throughput is rotated, once an event.

#include "patina/render/packet.h"
#include "patina/render/stokes_frames.h"
#include "patina/render/vec.h"

namespace patina::render {

// S_out = M S_in for light travelling along -incident before and along +outgoing after the event.
struct ScatteringMatrix {
    enum class Form {
        depolarizing,  // m[0] in the corner, zeros elsewhere; the axes mean nothing
        fresnel,       // [[a,b,0,0],[b,a,0,0],[0,0,c,d],[0,0,-d,c]], (a, b, c, d) = m[0..3]
        general        // m[4 * column + row]
    };
    Form form = Form::depolarizing;
    Vec3 x_in, x_out;  // perpendicular to incident and outgoing
    Float4 m[16];

    void set_depolarizing(Float4 value) {
        form = Form::depolarizing;
        m[0] = value;
    }
    void set_fresnel(Float4 a, Float4 b, Float4 c, Float4 d, const Vec3& axis_in, const Vec3& axis_out) {
        form = Form::fresnel;
        m[0] = a, m[1] = b, m[2] = c, m[3] = d;
        x_in = axis_in, x_out = axis_out;
    }
    int entries() const { return form == Form::depolarizing ? 1 : form == Form::fresnel ? 4 : 16; }
    void scale(Float4 factor) {
        for (int i = 0; i < entries(); ++i) m[i] *= factor;
    }
    // Element (0,0): what happens to the intensity of unpolarized light.
    Float4 intensity() const { return m[0]; }
    // The full matrix of one wavelength.
    optics::Mueller matrix(int wavelength) const {
        optics::Mueller full = optics::Mueller::Zero();
        const auto at = [&](int i) { return static_cast<double>(m[i][wavelength]); };
        if (form == Form::depolarizing) full(0, 0) = at(0);
        if (form == Form::fresnel) {
            full(0, 0) = full(1, 1) = at(0);
            full(0, 1) = full(1, 0) = at(1);
            full(2, 2) = full(3, 3) = at(2);
            full(2, 3) = at(3);
            full(3, 2) = -at(3);
        }
        if (form == Form::general)
            for (int i = 0; i < 16; ++i) full(i % 4, i / 4) = at(i);
        return full;
    }
};

// Everything between the light that arrives at the path's current end and the camera: camera Stokes = T S.
class Throughput {
  public:
    // A fresh path: what arrives along the camera ray is what the camera sees, in the frame with this x axis.
    explicit Throughput(const Vec3& camera_axis) : x_axis_(camera_axis) {}

    // Camera Stokes vector of unpolarized light of this radiance that arrives now.
    StokesPacket of_unpolarized(Float4 radiance) const {
        if (rank_ == Rank::identity) return make_stokes(radiance, splat(0), splat(0), splat(0));
        return columns_[0] * spread(radiance);
    }

    // Camera Stokes vector of unpolarized light of this radiance sent through one more event. `outgoing` is the world
    // direction the light leaves to; the axes of `event` are in world coordinates.
    StokesPacket of_unpolarized(Float4 radiance, const ScatteringMatrix& event, const Vec3& outgoing) const {
        if (rank_ == Rank::one || event.form == ScatteringMatrix::Form::depolarizing)
            return of_unpolarized(radiance * event.m[0]);
        const bool general = event.form == ScatteringMatrix::Form::general;
        const Float4 zero = splat(0), u = general ? event.m[2] * radiance : zero,
                     v = general ? event.m[3] * radiance : zero;
        return of_polarized(event.m[0] * radiance, event.m[1] * radiance, u, v, event.x_out, outgoing);
    }

    // Camera Stokes vector of light that arrives now along `direction`, in the frame with this x axis.
    StokesPacket of(const StokesPacket& stokes, const Vec3& x_axis, const Vec3& direction) const {
        if (rank_ == Rank::one) return columns_[0] * spread(stokes_row(stokes, 0));
        return of_polarized(stokes_row(stokes, 0), stokes_row(stokes, 1), stokes_row(stokes, 2), stokes_row(stokes, 3),
                            x_axis, direction);
    }

    // Appends an event (world axes), its weight included.
    void append(const ScatteringMatrix& event, const Vec3& outgoing) {
        if (event.form == ScatteringMatrix::Form::depolarizing) {
            columns_[0] = of_unpolarized(event.m[0]);
            rank_ = Rank::one;
            return;
        }
        if (rank_ == Rank::one) {
            append_to_rank_one(event);
        } else {
            write_identity();
            append_to_full(event, outgoing);
        }
        x_axis_ = event.x_in;
        rank_ = Rank::full;
    }

    void scale(float factor) { scale(splat(factor)); }
    void scale(Float4 factor) {
        write_identity();
        for (int i = 0; i < (rank_ == Rank::one ? 1 : 4); ++i) columns_[i] *= spread(factor);
    }
    // Keeps one wavelength of four, which then stands for all of them.
    void keep_only_hero() { scale(Float4{4, 0, 0, 0}); }
    // Intensity the camera sees of unpolarized light that arrives.
    Float4 intensity() const { return rank_ == Rank::identity ? splat(1) : stokes_row(columns_[0], 0); }
    bool depolarized() const { return rank_ == Rank::one; }
    // The full matrix of one wavelength, for light in the frame with the path's present axis.
    optics::Mueller matrix(int wavelength) const {
        if (rank_ == Rank::identity) return optics::Mueller::Identity();
        optics::Mueller full = optics::Mueller::Zero();
        for (int column = 0; column < (rank_ == Rank::one ? 1 : 4); ++column)
            for (int row = 0; row < 4; ++row) full(row, column) = columns_[column][4 * row + wavelength];
        return full;
    }

  private:
    // identity: nothing has happened yet and the columns are not written; one: only the first column is not zero.
    enum class Rank { identity, one, full };

    void write_identity() {
        if (rank_ != Rank::identity) return;
        const Float4 one = splat(1), none = splat(0);
        columns_[0] = make_stokes(one, none, none, none);
        columns_[1] = make_stokes(none, one, none, none);
        columns_[2] = make_stokes(none, none, one, none);
        columns_[3] = make_stokes(none, none, none, one);
        rank_ = Rank::full;
    }
    // Light (i, q, u, v) that arrives along `direction`, for a path that is not of rank one.
    StokesPacket of_polarized(Float4 i, Float4 q, Float4 u, Float4 v, const Vec3& x_axis, const Vec3& direction) const {
        const DoubleAngle r = rotation_between(direction, x_axis, x_axis_);
        const Float4 turned_q = q * r.cos + u * r.sin, turned_u = u * r.cos - q * r.sin;
        if (rank_ == Rank::identity) return make_stokes(i, turned_q, turned_u, v);
        return columns_[0] * spread(i) + columns_[1] * spread(turned_q) + columns_[2] * spread(turned_u) +
               columns_[3] * spread(v);
    }
    void append_to_rank_one(const ScatteringMatrix& event) {
        const StokesPacket c0 = columns_[0], zero{};
        if (event.form == ScatteringMatrix::Form::fresnel) {
            columns_[0] = c0 * spread(event.m[0]);
            columns_[1] = c0 * spread(event.m[1]);
            columns_[2] = zero;
            columns_[3] = zero;
        } else {
            for (int column = 0; column < 4; ++column) columns_[column] = c0 * spread(event.m[4 * column]);
        }
    }
    void append_to_full(const ScatteringMatrix& event, const Vec3& outgoing) {
        // Refer the path to the frame the event gives its light in.
        const DoubleAngle r = rotation_between(outgoing, event.x_out, x_axis_);
        const StokesPacket c0 = columns_[0], c3 = columns_[3];
        const StokesPacket c1 = columns_[1] * r.cos - columns_[2] * r.sin;
        const StokesPacket c2 = columns_[1] * r.sin + columns_[2] * r.cos;
        // Multiply by the event's matrix.
        if (event.form == ScatteringMatrix::Form::fresnel) {
            const StokesPacket a = spread(event.m[0]), b = spread(event.m[1]), c = spread(event.m[2]),
                               d = spread(event.m[3]);
            columns_[0] = c0 * a + c1 * b;
            columns_[1] = c0 * b + c1 * a;
            columns_[2] = c2 * c - c3 * d;
            columns_[3] = c2 * d + c3 * c;
        } else {
            for (int column = 0; column < 4; ++column) {
                const Float4* m = &event.m[4 * column];
                columns_[column] = c0 * spread(m[0]) + c1 * spread(m[1]) + c2 * spread(m[2]) + c3 * spread(m[3]);
            }
        }
    }

    StokesPacket columns_[4];
    Vec3 x_axis_;
    Rank rank_ = Rank::identity;
};

}  // namespace patina::render
