#pragma once
// Mesh files as triangle meshes: Wavefront OBJ, Stanford PLY and Mitsuba's packed one.
//
// Throws Error(input) with file and line (byte offset for binary files) for what is truncated, not a number, out of
// range or empty. What can be repaired is repaired and said in `warnings`: triangles without area are left out, normals
// without length are computed from the faces. Polygons are cut into fans, which is right for convex ones.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "patina/core/error.h"
#include "patina/core/mesh.h"

namespace patina::io {

struct MeshFile {
    TriangleMesh mesh;
    std::vector<std::string> warnings;
};

// v, vn, vt and f with all four index forms, negative indices included; three numbers behind a position are the
// attribute "vertex_color", in sRGB's encoding. Groups, materials, lines and points are skipped.
MeshFile read_obj(const std::filesystem::path& path);

// ascii, binary_little_endian and binary_big_endian; vertex x y z, nx ny nz and u v (or s t); other properties of
// vertices and faces become attributes (mesh_attributes.h), other elements are skipped.
MeshFile read_ply(const std::filesystem::path& path);

// Mesh `index` of a .serialized file, version 3 or 4: packed by zlib, several in a file.
MeshFile read_serialized(const std::filesystem::path& path, int index);

// `kind` is "obj", "ply", or "serialized" with the number of the mesh behind it: "serialized 2".
MeshFile read_mesh(const std::filesystem::path& path, std::string_view kind);

// The last step of every reader: checks indices and numbers, leaves out triangles without area, normalizes normals.
void finish_mesh(MeshFile& file, const SourceLocation& where);

}  // namespace patina::io
