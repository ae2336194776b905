// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// vsplit_ruler REFERENCE MESH...: distances in units of 1e-4 of the reference's diagonal, and defects.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ruler.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/meshes.hpp"

namespace {

using vsplit::Mesh;
using vsplit::Result;
using namespace vsplit::ruler;

Result<Mesh> load(const std::string& path) {
    auto bytes = vsplit::bake::read_file(path);
    if (!bytes) return bytes.error();
    auto file = vsplit::bake::parse_mesh(*bytes, std::filesystem::path(path).extension().string());
    if (!file) return file.error();
    return std::move(file->mesh);
}

int fail(const std::string& path, const vsplit::Error& error) {
    fmt::print(stderr, "vsplit_ruler: {}: {}\n", path, error.describe());
    return 3;
}

nlohmann::ordered_json to_json(const OneWay& way) {
    return {{"mean", way.mean}, {"rms", way.rms}, {"max", way.max}, {"normal_degrees", way.normal_degrees}};
}

nlohmann::ordered_json to_json(const std::string& path, const Measurement& m, double diagonal) {
    const Shape& s = m.shape;
    return {{"file", path},
            {"diagonal", diagonal},
            {"mean", m.mean},
            {"rms", m.rms},
            {"max", m.max},
            {"normal_degrees", m.normal_degrees},
            {"from_reference", to_json(m.from_reference)},
            {"to_reference", to_json(m.to_reference)},
            {"vertices", s.vertices},
            {"triangles", s.triangles},
            {"components", s.components},
            {"boundary_edges", s.boundary_edges},
            {"non_manifold_edges", s.non_manifold_edges},
            {"degenerate", s.degenerate},
            {"flipped", s.flipped},
            {"folded", s.folded},
            {"new_degenerate", s.new_degenerate},
            {"new_flipped", s.new_flipped},
            {"new_folded", s.new_folded},
            {"quality_min", s.quality_min},
            {"quality_mean", s.quality_mean}};
}

void print(const std::string& path, const Measurement& m, double diagonal) {
    const double u = 1e4 / diagonal;
    const Shape& s = m.shape;
    fmt::print("{}\n  triangles {} vertices {} components {} boundary {} non-manifold {}\n", path,
               s.triangles, s.vertices, s.components, s.boundary_edges, s.non_manifold_edges);
    fmt::print(
        "  degenerate {} flipped {} folded {} (not the reference's: {} {} {}), quality min {:.4g} mean "
        "{:.4f}\n",
        s.degenerate, s.flipped, s.folded, s.new_degenerate, s.new_flipped, s.new_folded, s.quality_min,
        s.quality_mean);
    fmt::print("  [1e-4 diagonal] mean {:.5g} rms {:.5g} max {:.5g}, normals {:.3f} degrees\n", m.mean * u,
               m.rms * u, m.max * u, m.normal_degrees);
    for (const auto& [name, way] :
         {std::pair("from the reference", m.from_reference), std::pair("to the reference", m.to_reference)})
        fmt::print("    {:<18} mean {:.5g} rms {:.5g} max {:.5g}, normals {:.3f} degrees\n", name,
                   way.mean * u, way.rms * u, way.max * u, way.normal_degrees);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(
        "Measures meshes against a reference: two-sided distances, normals, triangle quality, defects.",
        "vsplit_ruler");
    std::string reference;
    std::vector<std::string> others;
    RulerOptions options;
    bool json = false;
    app.add_option("reference", reference, "The mesh to measure against (PLY, OBJ, OFF, STL)")->required();
    app.add_option("mesh", others, "Meshes to measure")->required();
    app.add_option("-n,--samples", options.samples, "Samples on each mesh")
        ->check(CLI::Range(1, 100'000'000))
        ->capture_default_str();
    app.add_option("-s,--seed", options.seed, "Of the samples")->capture_default_str();
    app.add_flag("--json", json, "One JSON object a line, lengths in the object's units");
    CLI11_PARSE(app, argc, argv);

    auto mesh = load(reference);
    if (!mesh) return fail(reference, mesh.error());
    auto ruler = Ruler::over(*mesh, options);
    if (!ruler) return fail(reference, ruler.error());
    for (const std::string& path : others) {
        auto other = load(path);
        if (!other) return fail(path, other.error());
        auto measurement = ruler->measure(*other);
        if (!measurement) return fail(path, measurement.error());
        if (json)
            fmt::print("{}\n", to_json(path, *measurement, ruler->diagonal()).dump());
        else
            print(path, *measurement, ruler->diagonal());
    }
    return 0;
}
