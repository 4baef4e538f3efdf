#include "patina/render/paint_table.h"

#include <bit>
#include <cstdlib>
#include <new>

#include <sys/mman.h>

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
constexpr std::uint16_t half_sign = 0x8000;
// A column of a Mueller matrix for four wavelengths: 16 halves.
StokesPacket load_column(const std::uint16_t* p) {
#if defined(__AVX512F__)
    return (StokesPacket)_mm512_cvtph_ps(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p)));
#elif defined(__F16C__)
    const auto half = [](const std::uint16_t* from) {
        return (Float8)_mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
    };
    return {half(p), half(p + 8)};
#else
    const auto element = [p](int row) {
        Float4 four;
        for (int i = 0; i < 4; ++i) four[i] = static_cast<float>(std::bit_cast<_Float16>(p[4 * row + i]));
        return four;
    };
    return make_stokes(element(0), element(1), element(2), element(3));
#endif
}

// V changes its sign where light goes the other way.
const StokesPacket other_way = make_stokes(splat(1), splat(1), splat(1), splat(-1));

// Adds S M^T S, the matrix for light that goes the other way, to another's columns.
void add_reversed(const StokesPacket* m, StokesPacket* columns) {
    for (int c = 0; c < 4; ++c) {
        const StokesPacket row =
            make_stokes(stokes_row(m[0], c), stokes_row(m[1], c), stokes_row(m[2], c), stokes_row(m[3], c));
        columns[c] += (c == 3 ? -row : row) * other_way;
    }
}

// The four lanes turned by `steps` to the left: lane k takes what lane k + steps held.
Float4 turned(Float4 x, int steps) {
    static constexpr Mask4 order[4] = {{0, 1, 2, 3}, {1, 2, 3, 0}, {2, 3, 0, 1}, {3, 0, 1, 2}};
    return __builtin_shuffle(x, order[steps]);
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

Vec2 unit_azimuth(float x, float y, const Vec2& fallback) {
    const float length2 = x * x + y * y;
    return length2 > 1e-14f ? Vec2(Vec2(x, y) / std::sqrt(length2)) : fallback;
}

// Whether they lie as Wavelengths::sample puts them, but for rounding.
bool equally_spaced(const Wavelengths& w) {
    constexpr float quarter = 0.25f * wavelength_range_nm;
    float expected = w.nm[0];
    for (int k = 1; k < wavelengths_per_path; ++k) {
        expected += expected + quarter > wavelength_max_nm - 1e-3f ? quarter - wavelength_range_nm : quarter;
        if (std::abs(w.nm[k] - expected) > 2e-3f) return false;
    }
    return true;
}

std::vector<double> angle_cosines(int count) {
    std::vector<double> mu(count);
    for (int i = 0; i < count; ++i) mu[i] = std::max(0.0, std::cos(0.5 * pi * i / (count - 1)));
    return mu;
}

}  // namespace

void* allocate_in_large_pages(std::size_t bytes) {
    constexpr std::size_t page = std::size_t{2} << 20;
    const std::size_t whole = (bytes + page - 1) / page * page;
    void* memory = std::aligned_alloc(page, whole);
    if (memory == nullptr) throw std::bad_alloc();
#if defined(MADV_HUGEPAGE)
    madvise(memory, whole, MADV_HUGEPAGE);  // a wish; it may be refused
#endif
    return memory;
}

PaintTable::PaintTable(const brdf::MuellerTable& table, const Size& size) : size_(size) {
    if (table.wavelengths_nm.size() == 1) {
        only_wavelength_nm_ = table.wavelengths_nm.front();
        size_.intervals = 0;
    }
    nodes_ = size_.intervals + 1;
    specular_wavelengths_ = 4 * size_.intervals + 1;
    block_ = 64 * static_cast<std::size_t>(nodes_);
    tabulate_body(table);
    gather_first_columns();
    tabulate_specular(table);
    tabulate_sampling();
}

double PaintTable::wavelength_nm(int index) const {
    if (size_.intervals == 0) return only_wavelength_nm_;
    return wavelength_min_nm + wavelength_range_nm * index / (4 * size_.intervals);
}

PaintTable::WavelengthPlace PaintTable::wavelength_place(float nm) const {
    const float position = std::clamp((nm - wavelength_min_nm) * (4 / wavelength_range_nm), 0.0f, 3.9999998f);
    const int quarter = static_cast<int>(position);
    const Interval in_quarter((position - static_cast<float>(quarter)) * static_cast<float>(size_.intervals), nodes_);
    return {quarter, in_quarter.lower, in_quarter.weight};
}

void PaintTable::tabulate_body(const brdf::MuellerTable& table) {
    body_.assign(node(size_.angles - 1, size_.angles - 1, size_.azimuths), 0);
    const std::vector<double> mu = angle_cosines(size_.angles);
    std::vector<double> phi(size_.azimuths);
    for (int p = 0; p < size_.azimuths; ++p) phi[p] = pi * p / (size_.azimuths - 1);
    parallel_for(0, specular_wavelengths_, [&](std::ptrdiff_t w) {
        const int wavelength = static_cast<int>(w);
        const brdf::MuellerGrid grid = table.evaluate_grid(wavelength_nm(wavelength), mu, mu, phi);
        for (int o = 0; o < size_.angles; ++o)
            for (int i = o; i < size_.angles; ++i)
                for (int p = 0; p < size_.azimuths; ++p) {
                    // Turn e_theta by -phi/2 on both sides.
                    const DoubleAngle turn{static_cast<float>(std::cos(phi[p])), static_cast<float>(-std::sin(phi[p]))};
                    const optics::Mueller m = rotator(turn) * from_solver(grid.at(o, i, p)) * rotator(turn).transpose();
                    // An interpolated table may fall short of zero by little where it is steep.
                    const double keep = m(0, 0) > 0 ? 1.0 : 0.0;
                    std::uint16_t* block = &body_[node(o, i, p)];
                    for (int quarter = 0; quarter < 4; ++quarter) {
                        // The end of a quarter is the beginning of the next.
                        const int place = size_.intervals == 0 ? 0 : wavelength - quarter * size_.intervals;
                        if (place < 0 || place >= nodes_) continue;
                        for (int column = 0; column < 4; ++column)
                            for (int row = 0; row < 4; ++row)
                                block[((place * 4 + column) * 4 + row) * 4 + quarter] =
                                    to_half(static_cast<float>(keep * m(row, column)));
                    }
                }
    });
}

void PaintTable::gather_first_columns() {
    first_columns_.assign(first_node(size_.angles - 1, size_.angles - 1, size_.azimuths), 0);
    for (int o = 0; o < size_.angles; ++o)
        for (int i = 0; i < size_.angles; ++i)
            for (int p = 0; p < size_.azimuths; ++p)
                for (int place = 0; place < nodes_; ++place) {
                    const std::uint16_t* matrix = &body_[node(std::min(o, i), std::max(o, i), p)] + 64 * place;
                    std::uint16_t* column = &first_columns_[first_node(o, i, p)] + 16 * place;
                    // Of the matrix for light that goes the other way it is the first row, V with the other sign.
                    for (int row = 0; row < 4; ++row)
                        for (int quarter = 0; quarter < 4; ++quarter)
                            column[4 * row + quarter] = o <= i
                                                            ? matrix[4 * row + quarter]
                                                            : matrix[16 * row + quarter] ^ (row == 3 ? half_sign : 0);
                }
}

void PaintTable::tabulate_specular(const brdf::MuellerTable& table) {
    specular_.resize(static_cast<std::size_t>(specular_nodes) * specular_wavelengths_);
    for (int i = 0; i < specular_nodes; ++i) {
        const double mu = std::max(0.0, std::cos(0.5 * pi * i / (specular_nodes - 1)));
        for (int w = 0; w < specular_wavelengths_; ++w) {
            // From x in the plane of incidence to x across it: Q changes its sign, and U does a second time.
            const optics::Mueller m = table.specular(wavelength_nm(w), mu);
            specular_[static_cast<std::size_t>(i) * specular_wavelengths_ + w] = {
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
        std::array<std::array<double, columns>, rows> weight{};
        double total = 0;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                for (int a = 0; a < sub; ++a)
                    for (int b = 0; b < sub; ++b) {
                        const float cos_i = std::sqrt((row + (a + 0.5f) / sub) / rows);
                        const float azimuth = pi_f * (column + (b + 0.5f) / sub) / columns;
                        const float sin_i = safe_sqrt(1 - cos_i * cos_i);
                        ScatteringMatrix f;
                        evaluate(w, outgoing, {sin_i * std::cos(azimuth), sin_i * std::sin(azimuth), cos_i}, true, f);
                        weight[row][column] += std::max(0.0f, mean(f.m[0])) / (sub * sub);
                    }
                total += weight[row][column];
            }
        // Every cell keeps a chance: what is small on average need not be at each wavelength.
        const double floor = total > 0 ? 0.02 * total / (rows * columns) : 1.0;
        DirectionCells& d = directions_[o];
        double all_rows = 0;
        std::array<double, rows> row_sum{};
        for (int row = 0; row < rows; ++row) {
            for (double& cell : weight[row]) row_sum[row] += (cell += floor);
            all_rows += row_sum[row];
        }
        d.of_row[0] = 0;
        for (int row = 0; row < rows; ++row) {
            d.of_row[row + 1] = row + 1 == rows ? 1.0f : d.of_row[row] + static_cast<float>(row_sum[row] / all_rows);
            d.of_column[row][0] = 0;
            for (int c = 0; c < columns; ++c)
                d.of_column[row][c + 1] =
                    c + 1 == columns ? 1.0f : d.of_column[row][c] + static_cast<float>(weight[row][c] / row_sum[row]);
        }
        // Albedo = pi times the mean of f over the cosine-weighted hemisphere; reciprocity makes it the share sent
        // here.
        const double body = pi * total / (rows * columns);
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

template <class Visit>
void PaintTable::for_corners(const Place& at, const WavelengthPlace& wavelength, const Visit& visit) const {
    const Interval o(at.theta_o, size_.angles), i(at.theta_i, size_.angles), p(at.phi, size_.azimuths);
    for (int corner = 0; corner < 8; ++corner) {
        const float weight = (corner & 1 ? o.weight : 1 - o.weight) * (corner & 2 ? i.weight : 1 - i.weight) *
                             (corner & 4 ? p.weight : 1 - p.weight);
        const float high = weight * wavelength.weight;
        visit(o.lower + (corner & 1), i.lower + ((corner >> 1) & 1), p.lower + (corner >> 2), weight - high, high);
    }
}

StokesPacket PaintTable::first_column(const Place& at, const WavelengthPlace& wavelength) const {
    const int next = nodes_ > 1 ? 16 : 0;
    StokesPacket sum{};
    for_corners(at, wavelength, [&](int o, int i, int p, float low, float high) {
        const std::uint16_t* place = &first_columns_[first_node(o, i, p)] + 16 * wavelength.lower;
        sum += low * load_column(place);
        sum += high * load_column(place + next);
    });
    return sum;
}

void PaintTable::whole_matrix(const Place& at, const WavelengthPlace& wavelength, StokesPacket* matrix) const {
    const int next = nodes_ > 1 ? 64 : 0;
    StokesPacket sums[4]{}, reversed[4]{};
    bool any_reversed = false;
    for_corners(at, wavelength, [&](int o, int i, int p, float low, float high) {
        const std::uint16_t* place = &body_[node(std::min(o, i), std::max(o, i), p)] + 64 * wavelength.lower;
        StokesPacket* target = o > i ? reversed : sums;
        any_reversed |= o > i;
        for (int column = 0; column < 4; ++column) {
            target[column] += low * load_column(place + 16 * column);
            target[column] += high * load_column(place + next + 16 * column);
        }
    });
    if (any_reversed) add_reversed(reversed, sums);
    for (int column = 0; column < 4; ++column) matrix[column] = sums[column];
}

void PaintTable::evaluate(const Wavelengths& w, const Vec3& outgoing, const Vec3& incident, bool first_column_only,
                          ScatteringMatrix& f) const {
    const Place at = place(outgoing, incident);
    const int count = first_column_only ? 1 : 4;
    StokesPacket matrix[4];
    f.form = ScatteringMatrix::Form::general;
    if (equally_spaced(w)) {
        const WavelengthPlace hero = wavelength_place(w.nm[0]);
        if (first_column_only)
            matrix[0] = first_column(at, hero);
        else
            whole_matrix(at, hero, matrix);
        for (int column = 0; column < count; ++column)
            for (int row = 0; row < 4; ++row)
                f.m[4 * column + row] = turned(stokes_row(matrix[column], row), hero.quarter);
    } else {
        for (int k = 0; k < wavelengths_per_path; ++k) {
            const WavelengthPlace single = wavelength_place(w.nm[k]);
            whole_matrix(at, single, matrix);
            for (int column = 0; column < count; ++column)
                for (int row = 0; row < 4; ++row)
                    f.m[4 * column + row][k] = stokes_row(matrix[column], row)[single.quarter];
        }
    }
    // Mirroring the azimuth changes the sign of what couples (I, Q) with (U, V).
    if (at.mirrored)
        for (int column = 0; column < count; ++column)
            for (int row = column < 2 ? 2 : 0; row < (column < 2 ? 4 : 2); ++row)
                f.m[4 * column + row] = -f.m[4 * column + row];

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
        const WavelengthPlace at = wavelength_place(w.nm[k]);
        const int next = nodes_ > 1 ? 1 : 0;
        const auto* row0 = &specular_[static_cast<std::size_t>(theta.lower) * specular_wavelengths_ +
                                      at.quarter * size_.intervals + at.lower];
        const auto* row1 = row0 + specular_wavelengths_;
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
    const auto pick = [](const auto& cumulative, float x) {
        int cell = 0;
        for (int step = static_cast<int>(cumulative.size() - 1) / 2; step > 0; step /= 2)
            if (cumulative[cell + step] <= x) cell += step;
        return std::pair(cell,
                         std::min((x - cumulative[cell]) / (cumulative[cell + 1] - cumulative[cell]), 0x1.fffffep-1f));
    };
    // One half of the number's range turns to one side, the other to the other.
    const float side = u.y() < 0.5f ? 1.0f : -1.0f, turn = u.y() < 0.5f ? 2 * u.y() : 2 * (1 - u.y());
    const auto [row, row_rest] = pick(d.of_row, u.x());
    const auto [column, column_rest] = pick(d.of_column[row], std::min(turn, 0x1.fffffep-1f));
    const float cos2 = (row + row_rest) / rows, azimuth = pi_f * (column + column_rest) / columns;
    const float sin_i = safe_sqrt(1 - cos2), c = std::cos(azimuth), s = side * std::sin(azimuth);
    const Vec2 axis = unit_azimuth(outgoing.x(), outgoing.y(), Vec2::UnitX());
    const Vec3 incident(sin_i * (c * axis.x() - s * axis.y()), sin_i * (c * axis.y() + s * axis.x()), std::sqrt(cos2));
    density = cell_density(at, row, column) * incident.z() * inv_pi_f;
    return incident;
}

float PaintTable::pdf(const Vec3& outgoing, const Vec3& incident) const {
    const Interval at(fast_acos(outgoing.z()) * (2 * inv_pi_f * (size_.angles - 1)), size_.angles);
    const Vec2 axis = unit_azimuth(outgoing.x(), outgoing.y(), Vec2::UnitX());
    const float sin2 = incident.x() * incident.x() + incident.y() * incident.y();
    const float along = incident.x() * axis.x() + incident.y() * axis.y();
    const float azimuth = sin2 > 0 ? fast_acos(along / std::sqrt(sin2)) * inv_pi_f : 0.0f;
    const int row = std::min(static_cast<int>(incident.z() * incident.z() * rows), rows - 1);
    const int column = std::min(static_cast<int>(azimuth * columns), columns - 1);
    return cell_density(at, row, column) * incident.z() * inv_pi_f;
}

float PaintTable::cell_density(const Interval& outgoing, int row, int column) const {
    return (1 - outgoing.weight) * directions_[outgoing.lower].density(row, column) +
           outgoing.weight * directions_[outgoing.lower + 1].density(row, column);
}

}  // namespace patina::render
