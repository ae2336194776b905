// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// view FILE.pmesh: refines a mesh only where a camera that comes closer looks.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <span>
#include <utility>
#include <vector>
#include <vsplit/read.hpp>
#include <vsplit/view_mesh.hpp>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::ifstream file(argv[1], std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    auto read = vsplit::read_progressive_mesh(std::as_bytes(std::span(bytes)));
    if (!read) {
        std::fprintf(stderr, "%s: %s\n", argv[1], read.error().describe().c_str());
        return 1;
    }

    auto mesh = vsplit::ViewMesh::make(*std::move(read));
    if (!mesh) return 1;
    for (const float distance : {10.0f, 3.0f, 1.0f}) {
        vsplit::View view;
        view.eye = {0, 0, distance};  // in the object's space
        view.pixels_at_distance_1 = 1000;
        view.pixels = 1;
        // As much as fits into a frame; the next one goes on.
        const auto done = mesh->update(view, {.max_splits = 2000, .max_visits = 50000});
        const auto dirty = mesh->take_dirty();
        // mesh->triangles() within dirty.triangles, mesh->positions() within dirty.vertices go to the GPU.
        std::printf("distance %g: %zu splits applied, %zu undone, %zu triangles, %zu ranges\n",
                    double(distance), done.refined, done.coarsened, mesh->triangles().size(),
                    dirty.triangles.size() + dirty.vertices.size());
    }
}
