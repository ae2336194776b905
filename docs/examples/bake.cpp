// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// bake IN OUT.pmesh: the journey in code. Needs the baker, which is built in this tree and not installed.
#include <cstdio>
#include <utility>
#include <vsplit/bake/collapse.hpp>
#include <vsplit/bake/files.hpp>
#include <vsplit/bake/meshes.hpp>
#include <vsplit/write.hpp>

vsplit::Status bake(const char* in, const char* out) {
    auto bytes = vsplit::bake::read_file(in);
    if (!bytes) return bytes.error();
    auto file = vsplit::bake::parse_mesh(*bytes, ".ply");
    if (!file) return file.error();
    std::printf("%s: %llu vertices welded\n", file->report.format.c_str(),
                static_cast<unsigned long long>(file->report.vertices_welded));

    vsplit::bake::CollapseOptions options;
    options.cost = vsplit::bake::Cost::kPaper;
    auto result = vsplit::bake::collapse(file->mesh, options);
    if (!result) return result.error();

    auto written = vsplit::write_progressive_mesh(result->mesh);
    if (!written) return written.error();
    return vsplit::bake::write_file(out, *written, /*overwrite=*/true);
}

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const vsplit::Status done = bake(argv[1], argv[2]);
    if (!done) std::fprintf(stderr, "%s\n", done.error().describe().c_str());
    return done ? 0 : 1;
}
