#include "patina/render/shape_builder.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

Eigen::Matrix4d placement(const Properties& node) {
    const Eigen::Matrix4d m = node.transform("to_world");
    const Eigen::Matrix3d linear = m.block<3, 3>(0, 0);
    // Flat to single precision counts as flat.
    const bool flat = !(std::abs(linear.determinant()) > 1e-20 * std::pow(linear.norm(), 3));
    if (!m.allFinite() || flat || m.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
        throw input_error(node.location_of("to_world"),
                          fmt::format("the transform of the {} is degenerate", node.type));
    return m;
}

AnalyticShape sphere(const Properties& node) {
    const Eigen::Matrix4d m = placement(node);
    const Eigen::Matrix3d linear = m.block<3, 3>(0, 0);
    const double scale = std::cbrt(std::abs(linear.determinant()));
    if ((linear.transpose() * linear - scale * scale * Eigen::Matrix3d::Identity()).norm() > 1e-4 * scale * scale)
        throw input_error(node.location_of("to_world"), "a sphere cannot be stretched or sheared",
                          "the transform scales directions differently", "use a mesh for an ellipsoid");
    const Eigen::Vector3d centre = node.vector("center", Eigen::Vector3d::Zero());
    const double radius = scale * node.number("radius", 1.0);
    if (!(radius > 0) || !std::isfinite(radius) || !centre.allFinite())
        throw input_error(node.location_of("radius"), "radius of a sphere must be positive",
                          fmt::format("it is {}", radius));
    const Eigen::Vector3d world = (m * centre.homogeneous()).head<3>();
    return AnalyticShape::sphere(world.cast<float>(), static_cast<float>(radius), (linear / scale).cast<float>());
}

// A face of the unit square at `centre` of the shape's own space, with its outside along half_u x half_v.
AnalyticShape face(const Eigen::Matrix4d& m, AnalyticShape::Kind kind, const Eigen::Vector3d& centre,
                   const Eigen::Vector3d& half_u, const Eigen::Vector3d& half_v, const SourceLocation& where) {
    const Eigen::Matrix3d linear = m.block<3, 3>(0, 0);
    const Eigen::Vector3d world = (m * centre.homogeneous()).head<3>();
    const Eigen::Vector3d a = linear * half_u, b = linear * half_v;
    if (!(a.cross(b).norm() > 1e-18)) throw input_error(where, "a face of the shape has no area");
    AnalyticShape s = AnalyticShape::plane(kind, world.cast<float>(), a.cast<float>(), b.cast<float>());
    // A mirroring transform turns the cross product over, not the outside.
    s.flipped = linear.determinant() < 0;
    return s;
}

std::vector<AnalyticShape> analytic_shapes(const Properties& node) {
    using Kind = AnalyticShape::Kind;
    using Eigen::Vector3d;
    if (node.type == "sphere") return {sphere(node)};
    const Eigen::Matrix4d m = placement(node);
    if (node.type == "rectangle")
        return {face(m, Kind::parallelogram, Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY(), node.where)};
    if (node.type == "disk")
        return {face(m, Kind::disk, Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY(), node.where)};
    std::vector<AnalyticShape> faces;
    for (int axis = 0; axis < 3; ++axis)
        for (double side : {-1.0, 1.0}) {
            // Mitsuba's u and v, which with the outside make a left-handed system.
            const Vector3d outside = side * Vector3d::Unit(axis);
            const Vector3d u = axis == 0   ? Vector3d(Vector3d::UnitY())
                               : axis == 2 ? Vector3d(side * Vector3d::UnitY())
                               : side < 0  ? Vector3d(Vector3d::UnitZ())
                                           : Vector3d(-Vector3d::UnitX());
            faces.push_back(face(m, Kind::parallelogram, outside, u, u.cross(outside), node.where));
            faces.back().flipped ^= true;
        }
    return faces;
}

// Normals weighted by the angle of each corner (Thuermer & Wuethrich 1998).
std::vector<Eigen::Vector3f> smooth_normals(const TriangleMesh& mesh) {
    std::vector<Eigen::Vector3f> normals(mesh.positions.size(), Vec3::Zero());
    for (const auto& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner) {
            const Vec3 a = mesh.positions[t[(corner + 1) % 3]] - mesh.positions[t[corner]];
            const Vec3 b = mesh.positions[t[(corner + 2) % 3]] - mesh.positions[t[corner]];
            const Vec3 cross = a.cross(b);
            const float length = cross.norm();
            if (length > 0) normals[t[corner]] += cross / length * std::atan2(length, a.dot(b));
        }
    for (Vec3& n : normals) n = n.squaredNorm() > 0 ? Vec3(n.normalized()) : Vec3::UnitZ();
    return normals;
}

void check_mesh(const TriangleMesh& mesh, const SourceLocation& where) {
    const std::string what = fmt::format("mesh \"{}\"", mesh.name);
    if (mesh.triangles.empty()) throw input_error(where, what + " has no triangles");
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (!mesh.positions[i].allFinite())
            throw input_error(where, fmt::format("{}: vertex {} is not finite", what, i));
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (std::uint32_t corner : mesh.triangles[i])
            if (corner >= mesh.positions.size())
                throw input_error(where, fmt::format("{}: triangle {} names vertex {}", what, i, corner),
                                  fmt::format("there are {}", mesh.positions.size()));
    if ((!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size()) ||
        (!mesh.uvs.empty() && mesh.uvs.size() != mesh.positions.size()))
        throw input_error(where, what + " has another number of normals or texture coordinates than of vertices");
    for (const MeshAttribute& a : mesh.attributes)
        if (a.values.size() != (a.of_triangles ? mesh.triangles.size() : mesh.positions.size()) * a.channels)
            throw input_error(where, fmt::format("{}: attribute \"{}\" has {} values", what, a.name, a.values.size()));
}

// The side of a `cylinder` from p0 to p1, normals outward, without lids. Facets whose area is that of the cylinder;
// their normals are its own.
TriangleMesh cylinder(const Properties& node) {
    using Eigen::Vector3d;
    const Vector3d p0 = node.vector("p0", Vector3d::Zero()), p1 = node.vector("p1", Vector3d::UnitZ());
    const double radius = node.number("radius", 1.0);
    if (!(radius > 0) || !((p1 - p0).norm() > 0) || !p0.allFinite() || !p1.allFinite())
        throw input_error(node.location_of(radius > 0 ? "p1" : "radius"), "the cylinder has no area",
                          fmt::format("its radius is {}, its length {}", radius, (p1 - p0).norm()));
    // The azimuth counts from where Mitsuba's frame about the axis has its x.
    const Frame about(Vec3((p1 - p0).normalized().cast<float>()));
    constexpr int facets = 512;
    const double reach = radius * (pi / facets) / std::sin(pi / facets);
    TriangleMesh mesh;
    mesh.name = "cylinder";
    for (int i = 0; i <= facets; ++i) {
        const double phi = 2 * pi * i / facets;
        const Vector3d outward = std::cos(phi) * about.s.cast<double>() + std::sin(phi) * about.t.cast<double>();
        for (const Vector3d& end : {p0, p1}) {
            mesh.uvs.emplace_back(static_cast<float>(i) / facets, mesh.positions.size() % 2 ? 1.0f : 0.0f);
            mesh.positions.push_back((end + reach * outward).cast<float>());
            mesh.normals.push_back(outward.cast<float>());
        }
    }
    for (std::uint32_t i = 0; i < 2 * facets; i += 2) {
        mesh.triangles.push_back({i, i + 2, i + 3});
        mesh.triangles.push_back({i, i + 3, i + 1});
    }
    return mesh;
}

// Which of the meshes in a file.
std::int64_t expect_index(const Properties& node) {
    const std::int64_t index = node.integer("shape_index", 0);
    if (index >= 0 && index < 1'000'000) return index;
    throw input_error(node.location_of("shape_index"), "shape_index out of range", fmt::format("it is {}", index),
                      "numbers count from 0");
}

// The mesh a file holds, with normals.
TriangleMesh mesh_of_file(const Properties& node, const SceneResources& resources) {
    const std::string file = node.string("filename");
    const SourceLocation where = node.location_of("filename");
    if (!resources.load_mesh) throw Error(ErrorKind::not_built, where.to_string() + ": mesh files are not available");
    std::string kind = node.type;
    if (kind == "serialized") kind += fmt::format(" {}", expect_index(node));
    TriangleMesh mesh = *resources.load_mesh(file, kind);
    check_mesh(mesh, where);
    if (node.boolean("flip_tex_coords", node.type == "obj"))
        for (Vec2& uv : mesh.uvs) uv.y() = 1 - uv.y();
    if (node.boolean("face_normals", false))
        mesh.normals.clear();
    else if (mesh.normals.empty())
        mesh.normals = smooth_normals(mesh);
    return mesh;
}

void place_mesh(TriangleMesh& mesh, const Eigen::Matrix4d& m) {
    if (m.isIdentity(0)) return;
    const Eigen::Matrix3d linear = m.block<3, 3>(0, 0), for_normals = linear.inverse().transpose();
    for (Vec3& p : mesh.positions) p = (linear * p.cast<double>() + m.block<3, 1>(0, 3)).cast<float>();
    for (Vec3& n : mesh.normals) n = (for_normals * n.cast<double>()).normalized().cast<float>();
    if (linear.determinant() < 0)
        for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

MeshShape mesh_shape(const Properties& node, const SceneResources& resources, float& area) {
    const SourceLocation where = node.location_of("filename");
    auto mesh =
        std::make_shared<TriangleMesh>(node.type == "cylinder" ? cylinder(node) : mesh_of_file(node, resources));
    place_mesh(*mesh, placement(node));

    // Drop triangles without area: nothing can hit them, and they have no normal.
    std::vector<double> areas;
    mesh->keep_triangles([&](const auto& t) {
        const Vec3 cross =
            (mesh->positions[t[1]] - mesh->positions[t[0]]).cross(mesh->positions[t[2]] - mesh->positions[t[0]]);
        if (!(cross.squaredNorm() > 1e-37f)) return false;
        areas.push_back(0.5 * cross.norm());
        return true;
    });
    if (areas.empty()) throw input_error(where, fmt::format("mesh \"{}\" has no area", mesh->name));
    MeshShape shape;
    shape.by_area = DiscreteDistribution(areas);
    area = static_cast<float>(shape.by_area.total());
    shape.mesh = std::move(mesh);
    return shape;
}

// Single precision squares and divides these.
constexpr float largest_coordinate = 1e12f, smallest_area = 1e-24f;

void expect_sane_size(const Properties& node, const Shape& shape, const Geometry& geometry) {
    float reach = 0;
    const std::vector<AnalyticShape>& list = shape.group < 0 ? geometry.analytic : geometry.group_analytic;
    if (shape.is_mesh)
        for (const Vec3& p : geometry.meshes[shape.first].mesh->positions)
            reach = std::max(reach, p.cwiseAbs().maxCoeff());
    else
        for (int i = shape.first; i < shape.first + shape.count; ++i)
            reach = std::max({reach, list[i].o.cwiseAbs().maxCoeff(), list[i].radius});
    if (!(reach < largest_coordinate) || !(shape.area < sqr(largest_coordinate)))
        throw input_error(node.where, fmt::format("the {} is too large or too far away", node.type), "",
                          "keep coordinates below 1e9");  // areas are squared too
    if (!(shape.area > smallest_area))
        throw input_error(node.where, fmt::format("the {} is too small", node.type),
                          fmt::format("its area is {}", shape.area));
}

}  // namespace

int append_shape(const Properties& node, const SceneResources& resources, Geometry& geometry, int group) {
    expect_plugin(node);
    const int index = static_cast<int>(geometry.shapes.size());
    const bool flip = node.boolean("flip_normals", false);
    Shape shape;
    shape.group = group;
    if (node.type != "sphere" && node.type != "rectangle" && node.type != "disk" && node.type != "cube") {
        MeshShape mesh = mesh_shape(node, resources, shape.area);
        mesh.shape = index;
        mesh.group = group;
        mesh.flipped = flip;
        shape.is_mesh = true;
        shape.first = static_cast<int>(geometry.meshes.size());
        shape.count = 1;
        geometry.meshes.push_back(std::move(mesh));
    } else {
        std::vector<AnalyticShape>& list = group < 0 ? geometry.analytic : geometry.group_analytic;
        shape.first = static_cast<int>(list.size());
        for (AnalyticShape& s : analytic_shapes(node)) {
            s.shape = index;
            s.flipped ^= flip;
            shape.area += s.area;
            list.push_back(s);
        }
        shape.count = static_cast<int>(list.size()) - shape.first;
    }
    expect_sane_size(node, shape, geometry);
    geometry.shapes.push_back(shape);
    return index;
}

}  // namespace patina::render
