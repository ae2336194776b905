// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// levels FILE.pmesh: brings a progressive mesh to life and walks up its levels of detail.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <span>
#include <utility>
#include <vector>
#include <vsplit/live_mesh.hpp>
#include <vsplit/read.hpp>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::ifstream file(argv[1], std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};

    auto mesh = vsplit::read_progressive_mesh(std::as_bytes(std::span(bytes)));
    if (!mesh) {
        std::fprintf(stderr, "%s: %s\n", argv[1], mesh.error().describe().c_str());
        return 1;
    }
    const double all = double(mesh->triangles.size());
    vsplit::LiveMesh live(std::move(*mesh));
    for (const double ratio : {0.01, 0.1, 0.4, 1.0}) {
        live.go_to(vsplit::level_for_triangles(live.state(), std::uint64_t(ratio * all)));
        // live.positions() and live.triangles() are what a renderer uploads.
        std::printf("%zu triangles, %zu vertices, error %g\n", live.triangles().size(),
                    live.positions().size(), live.error());
    }
}
