#include "patina/render/lamp_table.h"

#include <algorithm>
#include <numeric>

#include "patina/render/concentric_disk.h"
#include "patina/render/shape_area.h"

namespace patina::render {

namespace {

constexpr double uniform_share = 0.1;
constexpr int cells_a_side = 256;
constexpr int samples_a_side = 2;  // of a cell

}  // namespace

std::shared_ptr<const LampTable> LampTable::of(const Geometry& geometry, int index, const Texture& radiance) {
    const Shape& shape = geometry.shapes[index];
    if (!radiance.varies()) return nullptr;
    const auto table = std::make_shared<LampTable>();
    table->columns_ = table->rows_ = cells_a_side;
    if (shape.is_mesh) {
        table->kind_ = Kind::mesh;
        double sum = 0;
        const DiscreteDistribution& by_area = geometry.meshes[shape.first].by_area;
        for (int t = 0; t < by_area.size(); ++t)
            table->triangle_end_.push_back(static_cast<float>(sum += by_area.probability(t)));
        // Some columns for each triangle, as far as they go.
        while (table->columns_ < 4 * by_area.size() && table->rows_ > 16) table->columns_ *= 2, table->rows_ /= 2;
    } else {
        const AnalyticShape::Kind kind = geometry.analytic[shape.first].kind;
        if (shape.count > 1 || kind == AnalyticShape::Kind::sphere) return nullptr;
        table->kind_ = kind == AnalyticShape::Kind::disk ? Kind::disk : Kind::parallelogram;
    }

    // The mean radiance of every cell, all wavelengths alike.
    const Wavelengths w = Wavelengths::sample(0.1f);
    std::vector<double> cells(static_cast<std::size_t>(table->columns_) * table->rows_);
    for (int x = 0; x < table->columns_; ++x)
        for (int y = 0; y < table->rows_; ++y)
            for (int k = 0; k < samples_a_side * samples_a_side; ++k) {
                const float dx = (k % samples_a_side + 0.5f) / samples_a_side,
                            dy = (k / samples_a_side + 0.5f) / samples_a_side;
                Vec3 position, normal;
                SurfaceUv uv;
                point_of_shape(geometry, shape, {(x + dx) / table->columns_, (y + dy) / table->rows_}, position, normal,
                               uv);
                cells[static_cast<std::size_t>(x) * table->rows_ + y] += mean(radiance.at(w, uv));
            }
    const double total = std::accumulate(cells.begin(), cells.end(), 0.0);
    if (!(total > 0)) return nullptr;
    const double floor = uniform_share / (1 - uniform_share) * total / static_cast<double>(cells.size());
    std::vector<double> column_sums;
    for (int x = 0; x < table->columns_; ++x) {
        const std::span<double> column(cells.data() + static_cast<std::size_t>(x) * table->rows_,
                                       static_cast<std::size_t>(table->rows_));
        for (double& cell : column) cell += floor;
        table->by_row_.emplace_back(column);
        column_sums.push_back(table->by_row_.back().total());
    }
    table->by_column_ = DiscreteDistribution(column_sums);
    return table;
}

Vec2 LampTable::sample(const Vec2& u, float& density) const {
    const auto column = by_column_.sample(u.x());
    const auto row = by_row_[column.index].sample(u.y());
    density = column.probability * row.probability * static_cast<float>(columns_ * rows_);
    constexpr float below_one = 0x1.fffffep-1f;
    return {std::min((column.index + column.remainder) / columns_, below_one),
            std::min((row.index + row.remainder) / rows_, below_one)};
}

float LampTable::density(const SurfaceUv& uv) const {
    const Vec2 u = square_of(uv);
    const int x = std::clamp(static_cast<int>(u.x() * columns_), 0, columns_ - 1),
              y = std::clamp(static_cast<int>(u.y() * rows_), 0, rows_ - 1);
    return by_column_.probability(x) * by_row_[x].probability(y) * static_cast<float>(columns_ * rows_);
}

Vec2 LampTable::square_of(const SurfaceUv& uv) const {
    if (kind_ == Kind::parallelogram) return uv;
    if (kind_ == Kind::disk) {
        const float phi = 2 * pi_f * uv.y();
        return square_of_disk({uv.x() * std::cos(phi), uv.x() * std::sin(phi)});
    }
    // As Geometry::sample_shape draws it: the triangle by area, in it sqrt(u) and v.
    const float begin = uv.triangle > 0 ? triangle_end_[uv.triangle - 1] : 0.0f, root = uv.second + uv.third;
    const float share = triangle_end_[uv.triangle] - begin;
    return {begin + share * sqr(root), root > 0 ? uv.third / root : 0.0f};
}

}  // namespace patina::render
