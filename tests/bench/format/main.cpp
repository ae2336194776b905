// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Bits a vertex of .pmesh against Draco's single level (cl 7 and 10) and a chain of eight halving levels in
// Draco, and the speed of writing and reading, as a Markdown table. Times are of the processor, one thread.
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>

#include "vsplit/bake/collapse.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;

namespace {

double cpu_seconds() {
    return double(std::clock()) / CLOCKS_PER_SEC;
}

/// Bytes of a mesh in Draco; bits of 0: floats as they are.
std::size_t draco_bytes(const Mesh& mesh, int bits, int level) {
    draco::Mesh out;
    out.set_num_points(std::uint32_t(mesh.positions.size()));
    out.SetNumFaces(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        draco::Mesh::Face face;
        for (std::size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(mesh.triangles[t][k]);
        out.SetFace(draco::FaceIndex(t), face);
    }
    draco::GeometryAttribute attribute;
    attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, sizeof(Float3),
                   0);
    const int id = out.AddAttribute(attribute, true, out.num_points());
    for (std::uint32_t i = 0; i < out.num_points(); ++i)
        out.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &mesh.positions[i]);
    draco::Encoder encoder;
    if (bits > 0) encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
    encoder.SetSpeedOptions(10 - level, 10 - level);
    draco::EncoderBuffer buffer;
    return encoder.EncodeMeshToBuffer(out, &buffer).ok() ? buffer.size() : 0;
}

bool measure(const std::string& folder, const std::string& name, bake::Placement placement,
             double& log_ratio) {
    const auto bytes = bake::read_file(folder + "/" + name);
    if (!bytes) {
        std::fprintf(stderr, "%s: %s\n", name.c_str(), bytes.error().describe().c_str());
        return false;
    }
    const auto input = bake::parse_mesh(*bytes, name.substr(name.rfind('.')));
    if (!input) return false;
    bake::CollapseOptions options;
    options.placement = placement;
    const auto record = bake::collapse(input->mesh, options);
    if (!record) return false;
    const double vertices = double(record->mesh.positions.size());
    const Mesh full = cut(record->mesh, record->mesh.splits.size());
    for (const std::uint32_t bits : {11u, 12u, 14u, 16u, 0u}) {
        WriteOptions write;
        write.position_bits = bits;
        const double start = cpu_seconds();
        const auto file = write_progressive_mesh(record->mesh, write);
        const double written = cpu_seconds();
        if (!file) return false;
        const auto back = read_progressive_mesh(*file);
        const double read = cpu_seconds();
        if (!back) return false;
        std::size_t chain = 0;
        for (int half = 0; half < 8; ++half)
            chain += draco_bytes(
                cut(record->mesh, level_for_triangles(record->mesh, full.triangles.size() >> half)),
                int(bits), 10);
        const std::size_t seven = draco_bytes(full, int(bits), 7), ten = draco_bytes(full, int(bits), 10);
        const auto per_vertex = [&](std::size_t size) { return 8 * double(size) / vertices; };
        std::printf(
            "| %s | %s | %u | %.2f | %.2f | %.2f | %.2f | %.3f | %.2f | %.2f |\n", name.c_str(),
            placement == bake::Placement::kOptimal ? "optimal" : "endpoint", bits, per_vertex(file->size()),
            per_vertex(seven), per_vertex(ten), per_vertex(chain), double(file->size()) / double(ten),
            1e6 * (written - start) / double(full.triangles.size()), vertices / (read - written) / 1e6);
        std::fflush(stdout);
        if (bits == 14) log_ratio += std::log(double(file->size()) / double(ten));
    }
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "vsplit_bench_format FOLDER [MESH...]\n");
        return 2;
    }
    std::vector<std::string> names(argv + 2, argv + argc);
    if (names.empty())
        names = {"stanford-bunny.obj", "armadillo.obj", "nefertiti.obj", "fandisk.obj", "igea.ply"};
    std::printf(
        "| mesh | placement | bits (0: lossless) | bits a vertex | Draco cl 7 | Draco cl 10 | 8 levels in "
        "Draco | over cl 10 | s a million "
        "triangles written | M vertices/s read |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | "
        "--- |\n");
    for (const bake::Placement placement : {bake::Placement::kEndpoint, bake::Placement::kOptimal}) {
        double log_ratio = 0;
        int count = 0;
        for (const std::string& name : names) count += measure(argv[1], name, placement, log_ratio);
        if (count == 0) return 1;
        std::printf("\nGeometric mean over Draco cl 10 at 14 bits, %s placement: %.3f\n\n",
                    placement == bake::Placement::kOptimal ? "optimal" : "endpoint",
                    std::exp(log_ratio / count));
    }
    return 0;
}
