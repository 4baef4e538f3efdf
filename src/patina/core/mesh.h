#pragma once
// A triangle mesh as plain data: what readers of mesh files return and the renderer is given.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace patina {

struct TriangleMesh {
    std::string name;                                     // for messages: the file, or the shape's id
    std::vector<Eigen::Vector3f> positions;               // V
    std::vector<Eigen::Vector3f> normals;                 // V unit vectors, or empty: flat shading
    std::vector<Eigen::Vector2f> uvs;                     // V, or empty
    std::vector<std::array<std::uint32_t, 3>> triangles;  // T corner indices < V, counter-clockwise seen from outside
};

}  // namespace patina
