// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "models.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "vec.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/bake/samples.hpp"

namespace vsplit::bench {
namespace {

Model from_file(const std::string& path) {
    return {std::filesystem::path(path).stem().string(), [path] { return load_mesh(path); }};
}

Model from_sample(const char* name, bake::Sample sample, std::size_t triangles) {
    return {name, [=]() -> Result<Mesh> { return bake::make_sample_mesh(sample, triangles); }};
}

/// -1 to 1, from an edge's ends.
double noise(std::uint64_t edge) {
    edge = (edge ^ (edge >> 30)) * 0xBF58476D1CE4E5B9ull;
    edge = (edge ^ (edge >> 27)) * 0x94D049BB133111EBull;
    return double((edge ^ (edge >> 31)) >> 11) * 0x1p-52 - 1;
}

}  // namespace

Result<Mesh> load_mesh(const std::string& path) {
    auto bytes = bake::read_file(path);
    if (!bytes) return bytes.error();
    auto file = bake::parse_mesh(*bytes, std::filesystem::path(path).extension().string());
    if (!file) return file.error();
    file->mesh.weights.clear();  // No peer knows weights.
    return std::move(file->mesh);
}

ModelSet choose_models(const std::vector<std::string>& files, const std::string& folder, bool quick) {
    ModelSet set;
    if (!files.empty()) {
        for (const std::string& file : files) set.quality.push_back(from_file(file));
        set.speed = set.quality.back();
        set.said = "the files given";
        return set;
    }
    const auto whole = [&](const char* name) { return folder + "/meshes/" + name; };
    std::vector<const char*> names{"stanford-bunny.obj", "armadillo.obj", "nefertiti.obj",
                                   "igea.ply",           "fandisk.obj",   "rocker-arm.obj"};
    if (quick) names = {"stanford-bunny.obj", "fandisk.obj", "rocker-arm.obj"};
    const char* speed = quick ? "igea.ply" : "igea-1m.ply";
    std::error_code ignored;
    const auto there = [&](const char* name) { return std::filesystem::exists(whole(name), ignored); };
    if (!folder.empty() && std::all_of(names.begin(), names.end(), there) && there(speed)) {
        for (const char* name : names) set.quality.push_back(from_file(whole(name)));
        set.speed = from_file(whole(speed));
        set.said = "the shared corpus";
        return set;
    }
    set.quality = {from_sample("whale", bake::Sample::kWhale, quick ? 20'000 : 100'000),
                   from_sample("ocean", bake::Sample::kOcean, quick ? 20'000 : 100'000)};
    set.speed = from_sample("whale", bake::Sample::kWhale, quick ? 250'000 : 1'000'000);
    set.said =
        "the built-in samples, because the shared corpus is not there: these figures do not answer for real "
        "models";
    return set;
}

Mesh subdivide(const Mesh& mesh, float amplitude) {
    using ruler::to_vec;
    struct Side {
        std::uint64_t edge;
        std::uint32_t corner;  // 3 * triangle + k, from corner k to k + 1.
    };
    std::vector<ruler::Vec3> normals(mesh.positions.size());
    std::vector<Side> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const ruler::Vec3 normal = ruler::area_vector(mesh, t);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            normals[a] = normals[a] + normal;
            sides.push_back({std::uint64_t(std::min(a, b)) << 32 | std::max(a, b), std::uint32_t(3 * i + k)});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::pair(a.edge, a.corner) < std::pair(b.edge, b.corner);
    });

    Mesh fine;
    fine.positions = mesh.positions;
    std::vector<std::uint32_t> middle(3 * mesh.triangles.size());
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (i == 0 || sides[i].edge != sides[i - 1].edge) {
            const auto a = std::uint32_t(sides[i].edge >> 32), b = std::uint32_t(sides[i].edge);
            const ruler::Vec3 pa = to_vec(mesh.positions[a]), pb = to_vec(mesh.positions[b]),
                              normal = normals[a] + normals[b];
            const double size = length(normal);
            const double shift = size > 0 ? amplitude * noise(sides[i].edge) * length(pb - pa) / size : 0;
            const ruler::Vec3 p = (pa + pb) * 0.5 + normal * shift;
            fine.positions.push_back({float(p.x), float(p.y), float(p.z)});
        }
        middle[sides[i].corner] = std::uint32_t(fine.positions.size() - 1);
    }
    fine.triangles.reserve(4 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const std::uint32_t* m = &middle[3 * i];
        fine.triangles.insert(
            fine.triangles.end(),
            {{t[0], m[0], m[2]}, {t[1], m[1], m[0]}, {t[2], m[2], m[1]}, {m[0], m[1], m[2]}});
    }
    return fine;
}

}  // namespace vsplit::bench
