#include "patina/render/integrators/radiosity_patches.h"

#include <fmt/format.h>

#include "patina/core/error.h"

namespace patina::render {

namespace {

const char* name_if_not_diffuse(const Scene& scene, int bsdf, std::string& storage) {
    const Bsdf& b = scene.bsdfs[bsdf];
    if (std::holds_alternative<Diffuse>(b.model)) return nullptr;
    if (const auto* both = std::get_if<TwoSided>(&b.model)) {
        const char* front = name_if_not_diffuse(scene, both->front, storage);
        return front ? front : name_if_not_diffuse(scene, both->back, storage);
    }
    storage = std::visit([](const auto& model) { return std::decay_t<decltype(model)>::describe().name; }, b.model);
    return storage.c_str();
}

// Equal areas in (row, column) coordinates of [0, 1]^2, and back.
Vec3 place_on(const AnalyticShape& s, const Vec2& at) {
    const float phi = 2 * pi_f * at.y();
    switch (s.kind) {
        case AnalyticShape::Kind::sphere: {
            const float z = 2 * at.x() - 1, r = safe_sqrt(1 - z * z);
            return s.o + s.radius * (r * std::cos(phi) * s.a + r * std::sin(phi) * s.b + z * s.n);
        }
        case AnalyticShape::Kind::disk: {
            const float r = std::sqrt(at.x());
            return s.o + r * std::cos(phi) * s.a + r * std::sin(phi) * s.b;
        }
        default:
            return s.o + (2 * at.x() - 1) * s.a + (2 * at.y() - 1) * s.b;
    }
}

Vec2 coordinates_on(const AnalyticShape& s, const Vec3& p) {
    const auto turn = [](float y, float x) {
        const float phi = std::atan2(y, x) * (0.5f * inv_pi_f);
        return phi < 0 ? phi + 1 : phi;
    };
    const Vec3 d = p - s.o;
    if (s.kind == AnalyticShape::Kind::sphere)
        return {0.5f * (s.n.dot(d) / s.radius + 1), turn(s.b.dot(d), s.a.dot(d))};
    const float u = s.dual_a.dot(d), v = s.dual_b.dot(d);
    if (s.kind == AnalyticShape::Kind::disk) return {u * u + v * v, turn(v, u)};
    return {0.5f * (u + 1), 0.5f * (v + 1)};
}

// Cells of about the size h.
std::pair<int, int> divisions(const AnalyticShape& s, float h) {
    const auto cut = [](float length, float step) { return std::max(1, static_cast<int>(std::lround(length / step))); };
    switch (s.kind) {
        case AnalyticShape::Kind::sphere:
            return {cut(2 * s.radius, h * 0.7f), cut(2 * pi_f * s.radius, h * 1.4f)};
        case AnalyticShape::Kind::disk:
            return {cut(s.a.norm(), h), cut(pi_f * s.a.norm(), h)};
        default:
            return {cut(2 * s.a.norm(), h), cut(2 * s.b.norm(), h)};
    }
}

}  // namespace

RadiosityPatches::RadiosityPatches(const Scene& scene, int wanted, int most) : scene_(scene) {
    // Expect diffuse surfaces and find the size of a patch.
    const Geometry& geometry = scene.geometry;
    float area = 0;
    std::size_t triangles = 0;
    std::string storage;
    for (const Shape& shape : geometry.shapes) {
        if (const char* name = name_if_not_diffuse(scene, shape.bsdf, storage))
            throw input_error({}, "radiosity is for diffuse surfaces", fmt::format("the scene has a \"{}\"", name),
                              "use path or bidirectional");
        if (shape.is_mesh)
            triangles += geometry.meshes[shape.first].mesh->triangles.size();
        else
            area += shape.area;
    }
    if (triangles > static_cast<std::size_t>(most))
        throw input_error({}, "too many triangles for radiosity",
                          fmt::format("{}, of which {} can be", triangles, most), "use path, or simpler meshes");
    const float h = std::sqrt(area / static_cast<float>(std::max(wanted - static_cast<int>(triangles), 16)));

    // Cut everything.
    analytic_.resize(geometry.analytic.size());
    triangles_.resize(geometry.meshes.size());
    for (int index = 0; index < static_cast<int>(geometry.shapes.size()); ++index) {
        const Shape& shape = geometry.shapes[index];
        Grid grid;
        grid.two_sided = std::holds_alternative<TwoSided>(scene.bsdfs[shape.bsdf].model);
        if (shape.is_mesh) {
            const TriangleMesh& mesh = *geometry.meshes[shape.first].mesh;
            for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
                const auto& [i0, i1, i2] = mesh.triangles[t];
                const Vec3 e1 = mesh.positions[i1] - mesh.positions[i0], e2 = mesh.positions[i2] - mesh.positions[i0];
                grid.first = count();
                triangles_[shape.first].push_back(grid);
                add_cells(grid, index, t, true, 0.5f * e1.cross(e2).norm());
            }
        } else {
            for (int a = shape.first; a < shape.first + shape.count; ++a) {
                std::tie(grid.rows, grid.columns) = divisions(geometry.analytic[a], h);
                grid.first = count();
                analytic_[a] = grid;
                add_cells(grid, index, a, false, geometry.analytic[a].area);
            }
        }
    }
    if (count() > most)
        throw input_error({}, "too many patches for radiosity", fmt::format("{}, of which {} can be", count(), most),
                          "ask for fewer patches");
}

void RadiosityPatches::add_cells(const Grid& grid, int shape, int primitive, bool triangle, float area) {
    const int cells = grid.rows * grid.columns;
    for (int side = 0; side < (grid.two_sided ? 2 : 1); ++side)
        for (int cell = 0; cell < cells; ++cell) {
            Patch patch;
            patch.back = side == 1;
            patch.area = area / static_cast<float>(cells);
            patch.primitive = primitive;
            patch.cell = cell;
            patch.triangle = triangle;
            patch.centre.shape = shape;
            patch.centre = point_of(patch, Vec2(0.5f, 0.5f));
            patches_.push_back(patch);
        }
}

SurfacePoint RadiosityPatches::point_of(const Patch& patch, const Vec2& u) const {
    // Let a ray across the surface make the point, as any other ray would.
    const Geometry& geometry = scene_.geometry;
    const int shape = patch.centre.shape;
    Hit hit;
    hit.shape = shape;
    hit.primitive = patch.primitive;
    hit.triangle = patch.triangle;
    hit.t = 0;
    Ray ray{Vec3::Zero(), Vec3::UnitZ(), INFINITY};
    if (patch.triangle) {
        const float root = std::sqrt(u.x());
        hit.u = root * (1 - u.y()), hit.v = root * u.y();
    } else {
        const AnalyticShape& s = geometry.analytic[patch.primitive];
        const Grid& grid = analytic_[patch.primitive];
        const int row = patch.cell / grid.columns, column = patch.cell % grid.columns;
        const Vec2 at((row + u.x()) / grid.rows, (column + u.y()) / grid.columns);
        ray.origin = place_on(s, at);
        hit.u = 2 * at.x() - 1, hit.v = 2 * at.y() - 1;
        if (s.kind == AnalyticShape::Kind::disk) {
            const Vec3 d = ray.origin - s.o;
            hit.u = s.dual_a.dot(d), hit.v = s.dual_b.dot(d);
        }
    }
    return geometry.surface(ray, hit);
}

SurfacePoint RadiosityPatches::sample(int patch, const Vec2& u) const {
    return point_of(patches_[patch], u);
}

int RadiosityPatches::find(const Hit& hit, const SurfacePoint& at, const Vec3& direction) const {
    const bool back = at.geometric_normal.dot(direction) > 0;
    const Grid& grid =
        hit.triangle ? triangles_[scene_.geometry.shapes[hit.shape].first][hit.primitive] : analytic_[hit.primitive];
    if (back && !grid.two_sided) return -1;
    int cell = 0;
    if (!hit.triangle) {
        const Vec2 c = coordinates_on(scene_.geometry.analytic[hit.primitive], at.position);
        const auto index = [](float x, int n) { return std::clamp(static_cast<int>(x * n), 0, n - 1); };
        cell = index(c.x(), grid.rows) * grid.columns + index(c.y(), grid.columns);
    }
    return grid.first + (back ? grid.rows * grid.columns : 0) + cell;
}

}  // namespace patina::render
