#include "patina/render/phases/phase_table.h"

#include <algorithm>
#include <cmath>

#include "patina/core/contract.h"
#include "patina/math/wigner_d.h"

namespace patina::render {

namespace {

using Elements = optics::ScatteringElements;

// What truncated expansions of spheres may differ by from a2 = a1 and a4 = a3, relative to a1 or its mean.
constexpr double truncation = 1e-3;

// F from its expansion (docs/conventions.md).
Elements sum_expansion(const optics::ExpansionCoefficients& c, double cosine) {
    const int order = c.order();
    const auto p = math::wigner_d(order, 0, 0, cosine), plus = math::wigner_d(order, 2, 2, cosine),
               minus = math::wigner_d(order, 2, -2, cosine), cross = math::wigner_d(order, 0, 2, cosine);
    Elements f{};
    double sum = 0, difference = 0;
    for (int l = 0; l <= order; ++l) {
        f.a1 += c.alpha1[l] * p[l];
        f.a4 += c.alpha4[l] * p[l];
        sum += (c.alpha2[l] + c.alpha3[l]) * plus[l];
        difference += (c.alpha2[l] - c.alpha3[l]) * minus[l];
        f.b1 -= c.beta1[l] * cross[l];
        f.b2 -= c.beta2[l] * cross[l];
    }
    f.a2 = 0.5 * (sum + difference);
    f.a3 = 0.5 * (sum - difference);
    return f;
}

// Keeps the matrix one that randomly oriented particles can have, where a truncated expansion goes astray (Hovenier &
// van der Mee 1988, J. Quant. Spectrosc. Radiat. Transf. 40, 1: |a3 - a4| <= a1 - a2, and the root below).
void make_realizable(Elements& f) {
    f.a1 = std::max(f.a1, 1e-6);
    f.a2 = std::clamp(f.a2, -f.a1, f.a1);
    const double half_difference = std::clamp(0.5 * (f.a3 - f.a4), -0.5 * (f.a1 - f.a2), 0.5 * (f.a1 - f.a2));
    double mean = 0.5 * (f.a3 + f.a4);
    const double needed = 2 * std::hypot(f.b1, f.b2, mean), room = f.a1 + f.a2;
    if (needed > room) {
        const double shrink = room / needed;
        f.b1 *= shrink, f.b2 *= shrink, mean *= shrink;
    }
    f.a3 = mean + half_difference;
    f.a4 = mean - half_difference;
}

// The matrix of spheres, from which truncation moved it away a little.
void make_spherical(Elements& f) {
    f.a1 = f.a2 = 0.5 * (f.a1 + f.a2);
    f.a3 = f.a4 = 0.5 * (f.a3 + f.a4);
}

// Cosine of a node counted from a pole.
double node_cosine(int node, int cells) {
    const double u = static_cast<double>(node) / cells;
    return 1 - u * u;
}

}  // namespace

PhaseTable::PhaseTable(std::span<const optics::ExpansionCoefficients> expansions, double first_nm, double step_nm)
    : rows_(static_cast<int>(expansions.size())),
      first_nm_(static_cast<float>(first_nm)),
      step_nm_(static_cast<float>(step_nm)) {
    PATINA_EXPECT(!expansions.empty() && step_nm > 0);
    int order = 2;
    for (const auto& expansion : expansions) order = std::max(order, expansion.order());
    // Oscillations of the highest order are then linear within 3e-4 of their height between nodes.
    cells_ = std::clamp(32 * (order + 1), 256, 8192);

    // Evaluate at the nodes.
    std::vector<std::vector<Elements>> rows;
    for (const auto& expansion : expansions) {
        rows.emplace_back();
        for (double side : {1.0, -1.0})
            for (int i = 0; i <= cells_; ++i) {
                rows.back().push_back(sum_expansion(expansion, side * node_cosine(i, cells_)));
                const Elements& f = rows.back().back();
                const double tolerance = truncation * std::max(f.a1, 1.0);
                if (std::abs(f.a2 - f.a1) > tolerance || std::abs(f.a4 - f.a3) > tolerance) spheres_ = false;
            }
    }
    for (auto& row : rows) {
        for (Elements& f : row) {
            if (spheres_) make_spherical(f);
            make_realizable(f);
        }
        append(row);
    }
}

void PhaseTable::append(const std::vector<Elements>& row) {
    // Sum up the cells' probabilities.
    std::vector<double> sums{0};
    for (int half : {0, 1})
        for (int i = 0; i < cells_; ++i) {
            const std::size_t node = static_cast<std::size_t>(half * (cells_ + 1) + i);
            const double width = node_cosine(i, cells_) - node_cosine(i + 1, cells_);
            sums.push_back(sums.back() + 0.25 * width * (row[node].a1 + row[node + 1].a1));
        }

    // Normalise what is kept: the interpolant.
    const double scale = 1 / sums.back();
    for (const Elements& f : row)
        nodes_.push_back({static_cast<float>(f.a1 * scale), static_cast<float>(f.a2 * scale),
                          static_cast<float>(f.a3 * scale), static_cast<float>(f.a4 * scale),
                          static_cast<float>(f.b1 * scale), static_cast<float>(f.b2 * scale)});
    for (double sum : sums) cumulative_.push_back(static_cast<float>(sum * scale));
    PATINA_EXPECT(nodes_.size() % row_size() == 0);
}

PhaseTable::Place PhaseTable::place(float nm) const {
    if (rows_ == 1) return {};
    const float x = std::clamp((nm - first_nm_) / step_nm_, 0.0f, static_cast<float>(rows_ - 1));
    const int below = std::min(static_cast<int>(x), rows_ - 2);
    return {below, x - static_cast<float>(below)};
}

PhaseElements PhaseTable::elements(const Wavelengths& w, float cosine) const {
    // Find the cell; both hemispheres count from their poles.
    const float from_pole = std::max(0.0f, 1 - std::abs(cosine)), cells = static_cast<float>(cells_);
    const int cell = std::min(static_cast<int>(std::sqrt(from_pole) * cells), cells_ - 1);
    const float t = std::clamp(
        (from_pole * cells * cells - static_cast<float>(cell) * static_cast<float>(cell)) / (2.0f * cell + 1), 0.0f,
        1.0f);
    const int node = (cosine < 0 ? cells_ + 1 : 0) + cell;

    PhaseElements f;
    f.kind = spheres_ ? PhaseElements::Kind::sphere : PhaseElements::Kind::general;
    for (int lane = 0; lane < wavelengths_per_path; ++lane) {
        const Place at = place(w.nm[lane]);
        const auto sum = [&](float Node::*element) {
            const auto in_row = [&](int r) {
                const Node* n = row(r) + node;
                return n[0].*element + t * (n[1].*element - n[0].*element);
            };
            const float below = in_row(at.row);
            return rows_ == 1 ? below : below + at.fraction * (in_row(at.row + 1) - below);
        };
        f.a1[lane] = sum(&Node::a1);
        f.b1[lane] = sum(&Node::b1);
        f.a3[lane] = sum(&Node::a3);
        f.b2[lane] = sum(&Node::b2);
        f.a2[lane] = spheres_ ? f.a1[lane] : sum(&Node::a2);
        f.a4[lane] = spheres_ ? f.a3[lane] : sum(&Node::a4);
    }
    return f;
}

float PhaseTable::sample_cosine(const Wavelengths& w, int lane, float u) const {
    // Between two wavelengths the density is a mix of theirs.
    Place at = place(w.nm[lane]);
    if (u < at.fraction) {
        u /= at.fraction;
        ++at.row;
    } else {
        u = (u - at.fraction) / (1 - at.fraction);
    }
    const auto begin = cumulative_.begin() + static_cast<std::ptrdiff_t>(at.row) * (2 * cells_ + 1);
    const auto above = std::upper_bound(begin + 1, begin + 2 * cells_, u);
    const int cell = static_cast<int>(above - begin) - 1, in_half = cell % cells_;
    const int half = cell / cells_;

    // Within the cell invert the integral of a straight line from p to q: p t + (q - p) t^2 / 2 = y (p + q) / 2.
    const Node* n = row(at.row) + half * (cells_ + 1) + in_half;
    const float p = n[0].a1, q = n[1].a1;
    const float share = *above - *(above - 1);
    const float y = share > 0 ? std::clamp((u - *(above - 1)) / share, 0.0f, 1.0f) : 0.5f;
    const float t = y * (p + q) / (p + std::sqrt(p * p + y * (q * q - p * p)));
    const auto low = static_cast<float>(node_cosine(in_half, cells_)),
               high = static_cast<float>(node_cosine(in_half + 1, cells_));
    const float cosine = low + t * (high - low);
    return half == 0 ? cosine : -cosine;
}

}  // namespace patina::render
