// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "command.hpp"
#include "input.hpp"
#include "model.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/live_mesh.hpp"

namespace vsplit::app {
namespace {

struct VerifyCommand {
    Common common;
    std::string path;
    InputOptions against;
    int run() const;
};

struct Check {
    std::string name;
    bool passed;
    std::string detail;
};

/// A triangle as the bits of its corners, the least first, orientation kept: equal for equal triangles
/// however meshes number them.
struct CornerBits {
    std::array<std::uint32_t, 4> bits;
    auto operator<=>(const CornerBits&) const = default;
};
using TriangleBits = std::array<CornerBits, 3>;

/// The place's bits; of a rounded file, those of the lattice point next to it.
Float3 rounded(const Float3& p, const FileInfo& info) {
    if (info.lossless || !(info.lattice_step > 0)) return p;
    const auto nearest = [&](float v, double origin) {
        const double n = (double(v) - origin) / info.lattice_step;
        return static_cast<float>(n < 0 ? -std::floor(0.5 - n) : std::floor(n + 0.5));
    };
    return {nearest(p.x, info.lattice_origin[0]), nearest(p.y, info.lattice_origin[1]),
            nearest(p.z, info.lattice_origin[2])};
}

std::vector<TriangleBits> triangle_bits(const Mesh& mesh, const FileInfo& info, bool with_weights) {
    std::vector<TriangleBits> all;
    all.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        TriangleBits corners;
        for (std::size_t k = 0; k < 3; ++k) {
            // 0 and -0 are one place; adding 0 makes them equal.
            Float3 p = rounded(mesh.positions[t[k]], info);
            p = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
            const float w = with_weights ? mesh.weights[t[k]] : 0;
            std::memcpy(&corners[k].bits, &p, sizeof(p));
            std::memcpy(&corners[k].bits[3], &w, sizeof(w));
        }
        TriangleBits least = corners;  // of the three rotations: rounded corners may be equal
        for (int turn = 0; turn < 2; ++turn) {
            std::rotate(corners.begin(), corners.begin() + 1, corners.end());
            least = std::min(least, corners);
        }
        corners = least;
        all.push_back(corners);
    }
    std::sort(all.begin(), all.end());
    return all;
}

Check compare(const Mesh& full, const Mesh& input, const FileInfo& info) {
    const std::string name =
        info.lossless ? "full refinement equals the input" : "full refinement equals the input as rounded";
    const bake::MeshSurvey a = bake::survey_mesh(full), b = bake::survey_mesh(input);
    const auto differ = [&](const char* what, std::uint64_t x, std::uint64_t y) {
        return Check{name, false, fmt::format("{} {} in the file, {} in the input", x, what, y)};
    };
    if (a.triangles != b.triangles) return differ("triangles", a.triangles, b.triangles);
    if (a.vertices != b.vertices) return differ("vertices", a.vertices, b.vertices);
    if (a.components != b.components) return differ("components", a.components, b.components);
    if (a.boundary_edges != b.boundary_edges)
        return differ("boundary edges", a.boundary_edges, b.boundary_edges);
    if (a.non_manifold_edges != b.non_manifold_edges)
        return differ("non-manifold edges", a.non_manifold_edges, b.non_manifold_edges);
    if (a.non_manifold_vertices != b.non_manifold_vertices)
        return differ("non-manifold vertices", a.non_manifold_vertices, b.non_manifold_vertices);
    const bool weights = !full.weights.empty() && !input.weights.empty();
    if (triangle_bits(full, info, weights) != triangle_bits(input, info, weights))
        return {name, false, "the corners of some triangle differ"};
    return {name, true,
            fmt::format("{} triangles, {} vertices, every {}{}", with_commas(a.triangles),
                        with_commas(a.vertices), info.lossless ? "float" : "place",
                        weights ? " and weight" : "")};
}

/// Bytes of all that a renderer reads at a level.
std::uint64_t hash_buffers(const LiveMesh& live) {
    std::uint64_t hash = 1469598103934665603u;  // FNV-1a over words
    const auto mix = [&](const void* data, std::size_t words) {
        for (std::size_t i = 0; i < words; ++i) {
            std::uint32_t word;
            std::memcpy(&word, static_cast<const char*>(data) + 4 * i, 4);
            hash = (hash ^ word) * 1099511628211u;
        }
    };
    mix(live.positions().data(), live.positions().size() * 3);
    mix(live.triangles().data(), live.triangles().size() * 3);
    mix(live.weights().data(), live.weights().size());
    return hash;
}

int VerifyCommand::run() const {
    std::vector<Check> checks;
    int exit = kDone;
    const auto file = read_stream_file(path, exit);
    if (!file) return exit;
    Limits limits;
    limits.max_bytes = std::uint64_t{1} << 36;
    auto info = read_info(file->stream(), limits);
    if (!info) return fail_input(path, info.error());
    auto mesh = read_progressive_mesh(file->stream(), limits);
    if (!mesh) return fail_input(path, mesh.error());
    checks.push_back({"checksums and structure", true,
                      fmt::format("header, table, base and {} blocks", info->blocks.size())});
    // Reading has replayed every split against the rules (progressive_mesh_fault); say how much that was.
    checks.push_back(
        {"every split keeps a sound mesh", true, fmt::format("{} splits", with_commas(mesh->splits.size()))});

    LiveMesh live(std::move(*mesh));
    ProgressBar bar(common);
    const bake::Progress progress = bar.callback();
    // Forward: every declared prefix. A manifold model has manifold levels; with attributes its points have,
    // but a wedge may come to serve two sides of its point, which says nothing.
    const bool by_points = !live.state().attributes.empty() || !live.state().groups.empty();
    std::vector<std::size_t> ends{0};
    for (const BlockInfo& block : info->blocks) ends.push_back(block.splits_end);
    live.go_to(live.max_level());
    const bake::MeshSurvey full = bake::survey_mesh(live.snapshot());
    live.go_to(0);
    std::vector<std::uint64_t> hashes;
    std::string bad;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        live.go_to(ends[i]);
        hashes.push_back(hash_buffers(live));
        const std::uint32_t vertices = i == 0 ? info->base_vertices : info->blocks[i - 1].vertices_end;
        const std::uint32_t triangles = i == 0 ? info->base_triangles : info->blocks[i - 1].triangles_end;
        if (live.positions().size() != vertices || live.triangles().size() != triangles)
            bad = fmt::format("prefix {} has other counts than the table says", i);
        if (full.manifold() && bad.empty() && !by_points) {
            const bake::MeshSurvey survey = bake::survey_mesh(live.snapshot());
            if (!survey.manifold())
                bad = fmt::format("prefix {} is not manifold, though the full mesh is", i);
            if (full.closed() && !survey.closed())
                bad = fmt::format("prefix {} is open, though the full mesh is closed", i);
        }
        if (progress) progress("verify", 0.5 * double(i + 1) / double(ends.size()));
    }
    checks.push_back({"every declared prefix is a mesh", bad.empty(),
                      bad.empty() ? fmt::format("{} prefixes", ends.size()) : bad});
    bad.clear();
    for (std::size_t i = ends.size(); i-- > 0;) {
        live.go_to(ends[i]);
        if (hash_buffers(live) != hashes[i]) bad = fmt::format("prefix {} comes back with other bytes", i);
        if (progress) progress("verify", 1 - 0.5 * double(i) / double(ends.size()));
    }
    checks.push_back({"forward then back restores every byte", bad.empty(),
                      bad.empty() ? fmt::format("{} prefixes", ends.size()) : bad});
    if (!against.path.empty()) {
        live.go_to(live.max_level());
        const auto ungrouped = [](Mesh whole) {
            whole.groups.clear();
            return whole;
        };
        if (file->carried) {
            auto original = bake::read_file(against.path);
            if (!original) return fail_input(against.path, original.error());
            auto scene = load_scene(against, *original, exit);
            if (!scene) return exit;
            checks.push_back(compare(live.snapshot(), ungrouped(std::move(scene->mesh)), *info));
        } else {
            std::vector<std::string> notes;
            bake::PoseSets poses;
            auto input = by_points ? load_placed(against, notes, poses, exit) : load_mesh(against, exit);
            if (!input) return exit;
            if (by_points) input->mesh = ungrouped(std::move(input->mesh));
            checks.push_back(compare(live.snapshot(), input->mesh, *info));
        }
    }

    const bool passed = std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.passed; });
    if (common.json && !common.quiet) {
        Json list = Json::array();
        for (const Check& c : checks)
            list.push_back({{"check", c.name}, {"passed", c.passed}, {"detail", c.detail}});
        print_json({{"input", path}, {"passed", passed}, {"checks", list}});
    }
    for (const Check& c : checks)
        say(common, fmt::format("{} {}: {}", c.passed ? "ok  " : "FAIL", c.name, c.detail));
    if (!passed && (common.quiet || common.json))
        fmt::print(stderr, "vsplit: {}: verification failed\n", path);
    return passed ? kDone : kFailed;
}

}  // namespace

void add_verify(CLI::App& app, int& exit) {
    auto command = std::make_shared<VerifyCommand>();
    CLI::App* sub = app.add_subcommand("verify",
                                       "Check a .pmesh, or the progressive GLB around one: checksums, every "
                                       "prefix, refinement and its undoing, and the input it was made of");
    sub->footer("Example:\n  vsplit verify bunny.pmesh --against bunny.obj");
    sub->add_option("input", command->path, "The .pmesh or progressive GLB")->required()->type_name("FILE");
    sub->add_option("--against", command->against.path, "The mesh or scene that it was baked from")
        ->type_name("IN");
    command->against.add_to(*sub);
    command->common.add_to(*sub);
    sub->callback([command, &exit] { exit = command->run(); });
}

}  // namespace vsplit::app
