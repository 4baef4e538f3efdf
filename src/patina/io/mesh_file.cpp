#include "patina/io/mesh_file.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "patina/io/located_text.h"

namespace patina::io {

namespace {

using Eigen::Vector3d;

// Twice the area below this share of the squared longest edge is a line as far as float positions can tell.
constexpr double smallest_relative_area = 1e-10;

void expect_finite(const TriangleMesh& mesh, const SourceLocation& where) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (!mesh.positions[i].allFinite())
            throw input_error(where, fmt::format("vertex {} has a position that is not finite", i + 1));
    for (std::size_t i = 0; i < mesh.normals.size(); ++i)
        if (!mesh.normals[i].allFinite())
            throw input_error(where, fmt::format("vertex {} has a normal that is not finite", i + 1));
    for (std::size_t i = 0; i < mesh.uvs.size(); ++i)
        if (!mesh.uvs[i].allFinite())
            throw input_error(where, fmt::format("vertex {} has a texture coordinate that is not finite", i + 1));
    for (const MeshAttribute& attribute : mesh.attributes)
        for (std::size_t i = 0; i < attribute.values.size(); ++i)
            if (!std::isfinite(attribute.values[i]))
                throw input_error(
                    where, fmt::format("{} {} of \"{}\" is not finite", attribute.of_triangles ? "triangle" : "vertex",
                                       i / attribute.channels + 1, attribute.name));
}

// Twice the triangle's area times its normal.
Vector3d area_vector(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    const Vector3d a = mesh.positions[triangle[0]].cast<double>();
    const Vector3d b = mesh.positions[triangle[1]].cast<double>();
    const Vector3d c = mesh.positions[triangle[2]].cast<double>();
    return (b - a).cross(c - a);
}

bool has_area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    double longest = 0;
    for (int side = 0; side < 3; ++side) {
        const Vector3d from = mesh.positions[triangle[side]].cast<double>();
        const Vector3d to = mesh.positions[triangle[(side + 1) % 3]].cast<double>();
        longest = std::max(longest, (to - from).squaredNorm());
    }
    return area_vector(mesh, triangle).norm() > smallest_relative_area * longest;
}

void drop_flat_triangles(MeshFile& file) {
    auto& triangles = file.mesh.triangles;
    const std::size_t before = triangles.size();
    file.mesh.keep_triangles([&](const auto& triangle) { return has_area(file.mesh, triangle); });
    if (triangles.size() != before)
        file.warnings.push_back(fmt::format("{}: {} of {} triangles have no area and are left out", file.mesh.name,
                                            before - triangles.size(), before));
}

void normalize_normals(MeshFile& file) {
    TriangleMesh& mesh = file.mesh;
    std::size_t repaired = 0;
    std::vector<Vector3d> geometric;
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        const float length = mesh.normals[i].stableNorm();
        if (length > 0) {
            mesh.normals[i] = mesh.normals[i].stableNormalized();
            continue;
        }
        if (geometric.empty()) {
            geometric.assign(mesh.positions.size(), Vector3d::Zero());
            for (const auto& triangle : mesh.triangles)
                for (const std::uint32_t corner : triangle) geometric[corner] += area_vector(mesh, triangle);
        }
        const Vector3d& normal = geometric[i];
        mesh.normals[i] =
            normal.norm() > 0 ? Eigen::Vector3f(normal.normalized().cast<float>()) : Eigen::Vector3f::UnitZ();
        ++repaired;
    }
    if (repaired > 0)
        file.warnings.push_back(
            fmt::format("{}: {} normals have no length; computed from the faces", mesh.name, repaired));
}

}  // namespace

void finish_mesh(MeshFile& file, const SourceLocation& where) {
    TriangleMesh& mesh = file.mesh;
    if (mesh.triangles.empty()) throw input_error(where, "the mesh has no face");
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle)
            if (corner >= mesh.positions.size())
                throw input_error(where, fmt::format("a face names vertex {} (counting from 0)", corner),
                                  fmt::format("the mesh has {}", mesh.positions.size()));
    expect_finite(mesh, where);
    drop_flat_triangles(file);
    if (mesh.triangles.empty()) throw input_error(where, "no triangle of the mesh has an area");
    normalize_normals(file);
}

MeshFile read_mesh(const std::filesystem::path& path, std::string_view kind) {
    if (kind == "obj") return read_obj(path);
    if (kind == "ply") return read_ply(path);
    constexpr std::string_view packed = "serialized ";
    if (kind.starts_with(packed))
        return read_serialized(path,
                               static_cast<int>(parse_integer(kind.substr(packed.size()), {path.string()}, "mesh")));
    throw input_error({path.string()}, fmt::format("unknown mesh format \"{}\"", kind), "",
                      did_you_mean(kind, {"obj", "ply", "serialized"}));
}

}  // namespace patina::io
