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

    // Texture coordinates at the weights u and v of a triangle's second and third corner; without any, the weights.
    Eigen::Vector2f uv_at(int triangle, float u, float v) const {
        if (uvs.empty()) return {u, v};
        const auto& [a, b, c] = triangles[triangle];
        return (1 - u - v) * uvs[a] + u * uvs[b] + v * uvs[c];
    }
};

}  // namespace patina
