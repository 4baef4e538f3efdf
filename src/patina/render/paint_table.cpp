#include "patina/render/paint_table.h"

#include <bit>

#include "patina/core/constants.h"
#include "patina/core/parallel.h"
#include "patina/render/sampling.h"

namespace patina::render {

namespace {

// Half precision: 11 bits, a relative error of 5e-4 at most, down to 6e-8.
std::uint16_t to_half(float value) {
    const auto half = static_cast<_Float16>(value);
    return std::bit_cast<std::uint16_t>(half);
}
Float4 load_halves(const std::uint16_t* p) {
#if defined(__F16C__)
    return (Float4)_mm_cvtph_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)));
#else
    Float4 result;
    for (int i = 0; i < 4; ++i) result[i] = static_cast<float>(std::bit_cast<_Float16>(p[i]));
    return result;
#endif
}

// acos for x in [-1, 1] to 2e-8 plus rounding (Abramowitz & Stegun 1964, eq. 4.4.46).
float fast_acos(float x) {
    const float a = std::min(std::abs(x), 1.0f);
    float p = -0.0012624911f;
    for (float c :
         {0.0066700901f, -0.0170881256f, 0.0308918810f, -0.0501743046f, 0.0889789874f, -0.2145988016f, 1.5707963050f})
        p = p * a + c;
    const float positive = p * std::sqrt(1 - a);
    return x < 0 ? pi_f - positive : positive;
}

// Index and weight of a linear interpolation on nodes 0 .. count - 1.
struct Interval {
    int lower;
    float weight;
    Interval(float position, int count) {
        lower = std::clamp(static_cast<int>(position), 0, std::max(count - 2, 0));
        weight = count < 2 ? 0.0f : std::clamp(position - static_cast<float>(lower), 0.0f, 1.0f);
    }
};

Vec2 unit_azimuth(float x, float y, const Vec2& fallback) {
    const float length2 = x * x + y * y;
    return length2 > 1e-14f ? Vec2(Vec2(x, y) / std::sqrt(length2)) : fallback;
}

std::vector<double> angle_cosines(int count) {
    std::vector<double> mu(count);
    for (int i = 0; i < count; ++i) mu[i] = std::max(0.0, std::cos(0.5 * pi * i / (count - 1)));
    return mu;
}

float wavelength_position(float nm, int count) {
    return (nm - wavelength_min_nm) * (static_cast<float>(count - 1) / wavelength_range_nm);
}

double node_wavelength_nm(int index, int count, const brdf::MuellerTable& table) {
    if (count == 1) return table.wavelengths_nm.front();
    return wavelength_min_nm + wavelength_range_nm * index / (count - 1);
}

}  // namespace

PaintTable::PaintTable(const brdf::MuellerTable& table, const Size& size) : size_(size) {
    if (table.wavelengths_nm.size() == 1) size_.wavelengths = 1;
    block_ = 16 * static_cast<std::size_t>(size_.wavelengths);
    tabulate_body(table);
    tabulate_specular(table);
    tabulate_sampling();
}

void PaintTable::tabulate_body(const brdf::MuellerTable& table) {
    body_.resize(node(size_.angles, 0, 0));
    const std::vector<double> mu = angle_cosines(size_.angles);
    std::vector<double> phi(size_.azimuths);
    for (int p = 0; p < size_.azimuths; ++p) phi[p] = pi * p / (size_.azimuths - 1);
    parallel_for(0, size_.wavelengths, [&](std::ptrdiff_t w) {
        const int wavelength = static_cast<int>(w);
        const brdf::MuellerGrid grid =
            table.evaluate_grid(node_wavelength_nm(wavelength, size_.wavelengths, table), mu, mu, phi);
        for (int o = 0; o < size_.angles; ++o)
            for (int i = 0; i < size_.angles; ++i)
                for (int p = 0; p < size_.azimuths; ++p) {
                    // Turn e_theta by -phi/2 on both sides.
                    const DoubleAngle turn{static_cast<float>(std::cos(phi[p])), static_cast<float>(-std::sin(phi[p]))};
                    const optics::Mueller m = rotator(turn) * from_solver(grid.at(o, i, p)) * rotator(turn).transpose();
                    // An interpolated table may fall short of zero by little where it is steep.
                    const double keep = m(0, 0) > 0 ? 1.0 : 0.0;
                    std::uint16_t* block = &body_[node(o, i, p)];
                    for (int column = 0; column < 4; ++column)
                        for (int row = 0; row < 4; ++row)
                            block[(column * size_.wavelengths + wavelength) * 4 + row] =
                                to_half(static_cast<float>(keep * m(row, column)));
                }
    });
}

void PaintTable::tabulate_specular(const brdf::MuellerTable& table) {
    specular_.resize(static_cast<std::size_t>(specular_nodes) * size_.wavelengths);
    for (int i = 0; i < specular_nodes; ++i) {
        const double mu = std::max(0.0, std::cos(0.5 * pi * i / (specular_nodes - 1)));
        for (int w = 0; w < size_.wavelengths; ++w) {
            // From x in the plane of incidence to x across it: Q changes its sign, and U does a second time.
            const optics::Mueller m = table.specular(node_wavelength_nm(w, size_.wavelengths, table), mu);
            specular_[static_cast<std::size_t>(i) * size_.wavelengths + w] = {
                static_cast<float>(m(0, 0)), static_cast<float>(-m(0, 1)), static_cast<float>(m(2, 2)),
                static_cast<float>(m(2, 3))};
        }
    }
}

void PaintTable::tabulate_sampling() {
    constexpr int sub = 2;  // evaluations a cell and axis
    const Wavelengths w = Wavelengths::sample(0.125f);
    directions_.resize(size_.angles);
    specular_share_.resize(size_.angles);
    for (int o = 0; o < size_.angles; ++o) {
        // A hair off the horizon and the normal, where cells must keep a share all the same.
        const float theta_o = std::min(0.5f * pi_f * o / (size_.angles - 1), 0.5f * pi_f - 1e-3f);
        const Vec3 outgoing(std::sin(theta_o), 0, std::cos(theta_o));
        std::array<std::array<double, cells>, cells> weight{};
        double total = 0;
        for (int row = 0; row < cells; ++row)
            for (int column = 0; column < cells; ++column) {
                for (int a = 0; a < sub; ++a)
                    for (int b = 0; b < sub; ++b) {
                        const float cos_i = std::sqrt((row + (a + 0.5f) / sub) / cells);
                        const float azimuth = 2 * pi_f * (column + (b + 0.5f) / sub) / cells;
                        const float sin_i = safe_sqrt(1 - cos_i * cos_i);
                        ScatteringMatrix f;
                        evaluate(w, outgoing, {sin_i * std::cos(azimuth), sin_i * std::sin(azimuth), cos_i}, true, f);
                        weight[row][column] += std::max(0.0f, mean(f.m[0])) / (sub * sub);
                    }
                total += weight[row][column];
            }
        // Every cell keeps a chance: what is small on average need not be at each wavelength.
        const double floor = total > 0 ? 0.02 * total / (cells * cells) : 1.0;
        DirectionCells& d = directions_[o];
        double rows_total = 0;
        std::array<double, cells> row_sum{};
        for (int row = 0; row < cells; ++row) {
            for (double& cell : weight[row]) row_sum[row] += (cell += floor);
            rows_total += row_sum[row];
        }
        d.rows[0] = 0;
        for (int row = 0; row < cells; ++row) {
            d.rows[row + 1] = row + 1 == cells ? 1.0f : d.rows[row] + static_cast<float>(row_sum[row] / rows_total);
            d.columns[row][0] = 0;
            for (int c = 0; c < cells; ++c)
                d.columns[row][c + 1] =
                    c + 1 == cells ? 1.0f : d.columns[row][c] + static_cast<float>(weight[row][c] / row_sum[row]);
        }
        // Albedo = pi times the mean of f over the cosine-weighted hemisphere; reciprocity makes it the share sent
        // here.
        const double body = pi * total / (cells * cells);
        const double mirror = mean(specular(w, outgoing.z())[0]);
        specular_share_[o] = static_cast<float>(mirror > 0 ? mirror / (mirror + body) : 0.0);
    }
}

PaintTable::Place PaintTable::place(const Vec3& outgoing, const Vec3& incident) const {
    Place at;
    const float to_nodes = static_cast<float>(size_.angles - 1) * (2 * inv_pi_f);
    at.theta_o = fast_acos(outgoing.z()) * to_nodes;
    at.theta_i = fast_acos(incident.z()) * to_nodes;
    // Light travels along -incident. A direction along the normal takes the other's azimuth.
    const Vec2 other = unit_azimuth(-incident.x(), -incident.y(), Vec2::UnitX());
    at.azimuth_o = unit_azimuth(outgoing.x(), outgoing.y(), other);
    at.azimuth_k = unit_azimuth(-incident.x(), -incident.y(), at.azimuth_o);
    const float cos_phi = std::clamp(at.azimuth_o.dot(at.azimuth_k), -1.0f, 1.0f);
    const float sin_phi = at.azimuth_k.x() * at.azimuth_o.y() - at.azimuth_k.y() * at.azimuth_o.x();
    at.mirrored = sin_phi < 0;
    at.phi = fast_acos(cos_phi) * (static_cast<float>(size_.azimuths - 1) * inv_pi_f);
    at.cos_half = std::sqrt(0.5f * (1 + cos_phi));
    at.sin_half = std::copysign(std::sqrt(0.5f * (1 - cos_phi)), sin_phi);
    return at;
}

void PaintTable::evaluate(const Wavelengths& w, const Vec3& outgoing, const Vec3& incident, bool first_column_only,
                          ScatteringMatrix& f) const {
    const Place at = place(outgoing, incident);
    const Interval o(at.theta_o, size_.angles), i(at.theta_i, size_.angles), p(at.phi, size_.azimuths);

    // The eight corners, and for each wavelength its two nodes.
    const std::uint16_t* corner[8];
    float corner_weight[8];
    for (int c = 0; c < 8; ++c) {
        const int co = c & 1, ci = (c >> 1) & 1, cp = c >> 2;
        corner[c] = &body_[node(o.lower + co, i.lower + ci, p.lower + cp)];
        corner_weight[c] =
            (co ? o.weight : 1 - o.weight) * (ci ? i.weight : 1 - i.weight) * (cp ? p.weight : 1 - p.weight);
    }
    int lower[wavelengths_per_path], step = size_.wavelengths > 1 ? 4 : 0;
    float fraction[wavelengths_per_path];
    for (int k = 0; k < wavelengths_per_path; ++k) {
        const Interval interval(wavelength_position(w.nm[k], size_.wavelengths), size_.wavelengths);
        lower[k] = 4 * interval.lower;
        fraction[k] = interval.weight;
    }

    // Sum up column by column: four Stokes rows at once, then turned to four wavelengths at once.
    f.form = ScatteringMatrix::Form::general;
    for (int column = 0; column < (first_column_only ? 1 : 4); ++column) {
        Float4 low[wavelengths_per_path]{}, high[wavelengths_per_path]{};
        for (int c = 0; c < 8; ++c) {
            const std::uint16_t* block = corner[c] + column * size_.wavelengths * 4;
            for (int k = 0; k < wavelengths_per_path; ++k) {
                low[k] += corner_weight[c] * load_halves(block + lower[k]);
                high[k] += corner_weight[c] * load_halves(block + lower[k] + step);
            }
        }
        for (int k = 0; k < wavelengths_per_path; ++k) low[k] += (high[k] - low[k]) * fraction[k];
        for (int row = 0; row < 4; ++row) {
            // Mirroring the azimuth changes the sign of what couples (I, Q) with (U, V).
            const float sign = at.mirrored && (row < 2) != (column < 2) ? -1.0f : 1.0f;
            f.m[4 * column + row] = sign * Float4{low[0][row], low[1][row], low[2][row], low[3][row]};
        }
    }

    // x = e_theta cos(phi/2) - e_phi sin(phi/2) for both rays.
    const auto axis = [&](const Vec3& k, const Vec2& azimuth) {
        const float sin_theta = std::sqrt(k.x() * k.x() + k.y() * k.y());
        const Vec3 e_theta(k.z() * azimuth.x(), k.z() * azimuth.y(), -sin_theta), e_phi(-azimuth.y(), azimuth.x(), 0);
        return Vec3(e_theta * at.cos_half - e_phi * at.sin_half);
    };
    f.x_out = axis(outgoing, at.azimuth_o);
    f.x_in = axis(-incident, at.azimuth_k);
}

std::array<Float4, 4> PaintTable::specular(const Wavelengths& w, float cos_o) const {
    const Interval theta(fast_acos(cos_o) * (2 * inv_pi_f * (specular_nodes - 1)), specular_nodes);
    std::array<Float4, 4> result;
    for (int k = 0; k < wavelengths_per_path; ++k) {
        const Interval at(wavelength_position(w.nm[k], size_.wavelengths), size_.wavelengths);
        const int next = size_.wavelengths > 1 ? 1 : 0;
        const auto* row0 = &specular_[static_cast<std::size_t>(theta.lower) * size_.wavelengths + at.lower];
        const auto* row1 = row0 + size_.wavelengths;
        for (int e = 0; e < 4; ++e)
            result[e][k] = (1 - theta.weight) * ((1 - at.weight) * row0[0][e] + at.weight * row0[next][e]) +
                           theta.weight * ((1 - at.weight) * row1[0][e] + at.weight * row1[next][e]);
    }
    return result;
}

float PaintTable::specular_share(float cos_o) const {
    const Interval at(fast_acos(cos_o) * (2 * inv_pi_f * (size_.angles - 1)), size_.angles);
    return (1 - at.weight) * specular_share_[at.lower] + at.weight * specular_share_[at.lower + 1];
}

Vec3 PaintTable::sample(const Vec3& outgoing, const Vec2& u, float choice, float& density) const {
    // Take one of the two nearest nodes of the viewer's angle, then a row, then a cell.
    const Interval at(fast_acos(outgoing.z()) * (2 * inv_pi_f * (size_.angles - 1)), size_.angles);
    const DirectionCells& d = directions_[at.lower + (choice < at.weight ? 1 : 0)];
    const auto pick = [](const std::array<float, cells + 1>& cumulative, float x) {
        int cell = 0;
        for (int step = cells / 2; step > 0; step /= 2)
            if (cumulative[cell + step] <= x) cell += step;
        return std::pair(cell,
                         std::min((x - cumulative[cell]) / (cumulative[cell + 1] - cumulative[cell]), 0x1.fffffep-1f));
    };
    const auto [row, row_rest] = pick(d.rows, u.x());
    const auto [column, column_rest] = pick(d.columns[row], u.y());
    const float cos2 = (row + row_rest) / cells, azimuth = 2 * pi_f * (column + column_rest) / cells;
    const float sin_i = safe_sqrt(1 - cos2), c = std::cos(azimuth), s = std::sin(azimuth);
    const Vec2 axis = unit_azimuth(outgoing.x(), outgoing.y(), Vec2::UnitX());
    const Vec3 incident(sin_i * (c * axis.x() - s * axis.y()), sin_i * (c * axis.y() + s * axis.x()), std::sqrt(cos2));
    density = pdf(outgoing, incident);
    return incident;
}

float PaintTable::pdf(const Vec3& outgoing, const Vec3& incident) const {
    const Interval at(fast_acos(outgoing.z()) * (2 * inv_pi_f * (size_.angles - 1)), size_.angles);
    const Vec2 axis = unit_azimuth(outgoing.x(), outgoing.y(), Vec2::UnitX());
    const float x = incident.x() * axis.x() + incident.y() * axis.y();
    const float y = incident.y() * axis.x() - incident.x() * axis.y();
    float azimuth = std::atan2(y, x) * (0.5f * inv_pi_f);
    azimuth = azimuth < 0 ? azimuth + 1 : azimuth;
    const int row = std::min(static_cast<int>(incident.z() * incident.z() * cells), cells - 1);
    const int column = std::min(static_cast<int>(azimuth * cells), cells - 1);
    const float relative = (1 - at.weight) * directions_[at.lower].density(row, column) +
                           at.weight * directions_[at.lower + 1].density(row, column);
    return relative * incident.z() * inv_pi_f;
}

}  // namespace patina::render
