#pragma once
// A triangle mesh as plain data: what readers of mesh files return and the renderer is given.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace patina {

// Values that a file gives of each vertex or triangle: "vertex_color", "face_temperature".
struct MeshAttribute {
    std::string name;
    bool of_triangles = false;
    int channels = 1;           // 1 or 3
    std::vector<float> values;  // [vertex or triangle][channel]
};

struct TriangleMesh {
    std::string name;                                     // for messages: the file, or the shape's id
    std::vector<Eigen::Vector3f> positions;               // V
    std::vector<Eigen::Vector3f> normals;                 // V unit vectors, or empty: flat shading
    std::vector<Eigen::Vector2f> uvs;                     // V, or empty
    std::vector<std::array<std::uint32_t, 3>> triangles;  // T corner indices < V, counter-clockwise seen from outside
    std::vector<MeshAttribute> attributes;

    // Keeps the triangles for which keep(triangle) holds, and what belongs to them.
    template <class Keep>
    void keep_triangles(const Keep& keep) {
        std::size_t kept = 0;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            if (!keep(triangles[t])) continue;
            triangles[kept] = triangles[t];
            for (MeshAttribute& a : attributes)
                if (a.of_triangles && kept != t)
                    std::copy_n(a.values.begin() + t * a.channels, a.channels, a.values.begin() + kept * a.channels);
            ++kept;
        }
        triangles.resize(kept);
        for (MeshAttribute& a : attributes)
            if (a.of_triangles) a.values.resize(kept * a.channels);
    }

    // Texture coordinates at the weights u and v of a triangle's second and third corner; without any, the weights.
    Eigen::Vector2f uv_at(int triangle, float u, float v) const {
        if (uvs.empty()) return {u, v};
        const auto& [a, b, c] = triangles[triangle];
        return (1 - u - v) * uvs[a] + u * uvs[b] + v * uvs[c];
    }
};

}  // namespace patina
