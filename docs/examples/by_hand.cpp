// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// by_hand OUT.pmesh: a square whose middle vertex comes with the only split, written and read back.
#include <cstdio>
#include <fstream>
#include <span>
#include <vector>
#include <vsplit/live_mesh.hpp>
#include <vsplit/read.hpp>
#include <vsplit/write.hpp>

/// 3---2      3---2
/// |  /|      |\ /|
/// | / |  ->  | 4 |     Vertex 4 splits off vertex 0: both triangles hand their corner over,
/// |/  |      |/ \|     and two open between them.
/// 0---1      0---1
vsplit::ProgressiveMesh square() {
    vsplit::ProgressiveMesh mesh;
    mesh.base_vertices = 4;
    mesh.base_triangles = 2;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0.5f}};
    mesh.parents = {vsplit::kNoVertex, vsplit::kNoVertex, vsplit::kNoVertex, vsplit::kNoVertex, 0};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 1, 4}, {0, 4, 3}};
    // Corner 0 of triangle 0 and corner 0 of triangle 1 go from vertex 0 to vertex 4.
    mesh.corner_changes = {{0, 4}, {3, 4}};
    vsplit::Split split;
    split.vertices_end = 5;
    split.triangles_end = 4;
    split.corners_end = 2;
    split.error = 0.5f;  // how far the mesh without vertex 4 is from the one with it
    mesh.splits = {split};
    return mesh;
}

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const vsplit::ProgressiveMesh mesh = square();
    if (const char* fault = vsplit::progressive_mesh_fault(mesh)) {
        std::fprintf(stderr, "%s\n", fault);
        return 1;
    }
    vsplit::WriteOptions options;
    options.position_bits = 0;  // lossless: every float comes back
    const auto bytes = vsplit::write_progressive_mesh(mesh, options);
    if (!bytes) {
        std::fprintf(stderr, "%s\n", bytes.error().describe().c_str());
        return 1;
    }
    std::ofstream(argv[1], std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes->data()), std::streamsize(bytes->size()));

    const auto again = vsplit::read_progressive_mesh(*bytes);
    if (!again || vsplit::cut(*again, 1).positions != vsplit::cut(mesh, 1).positions ||
        vsplit::cut(*again, 1).triangles.size() != vsplit::cut(mesh, 1).triangles.size())
        return 1;  // a file may number triangles anew and begin them at another corner
    // A weight that is set on the coarse mesh goes to both children: vertex 4 takes that of vertex 0.
    const std::vector<float> weights = vsplit::inherit_weights(mesh, 0, {9, 1, 1, 1});
    std::printf("%zu bytes; vertex 4 inherits %g\n", bytes->size(), double(weights[4]));
    return weights[4] == 9 ? 0 : 1;
}
