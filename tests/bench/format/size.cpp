// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "draco_file.hpp"
#include "figures.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

namespace vsplit::bench {
namespace {

namespace fs = std::filesystem;

/// Emptied when it goes.
class Scratch {
  public:
    Scratch() : path_(fs::temp_directory_path() / fmt::format("vsplit-bench-format-{}", getpid())) {
        fs::create_directories(path_);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    ~Scratch() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    std::string file(const char* name) const { return (path_ / name).string(); }

  private:
    fs::path path_;
};

/// Bytes of the .glb that gltfpack -cc makes of an .obj; 0 if it fails.
std::uint64_t gltfpack_bytes(const std::string& gltfpack, const std::string& obj, const std::string& glb,
                             int bits) {
    const std::string precision = bits ? fmt::format("-vp {}", bits) : "-noq";
    const std::string command =
        fmt::format("'{}' -i '{}' -o '{}' -cc {} >/dev/null 2>&1", gltfpack, obj, glb, precision);
    if (std::system(command.c_str()) != 0) return 0;
    std::error_code failed;
    const auto size = fs::file_size(glb, failed);
    return failed ? 0 : size;
}

double diagonal_of(const Mesh& mesh) {
    Float3 least = mesh.positions.front(), most = least;
    for (const Float3& p : mesh.positions) {
        least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
        most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    }
    return std::hypot(double(most.x) - least.x, double(most.y) - least.y, double(most.z) - least.z);
}

std::vector<Point> curve_of(const FileInfo& info) {
    std::vector<Point> curve{{info.base_offset + info.base_bytes, info.base_error}};
    for (const BlockInfo& block : info.blocks) curve.push_back({block.offset + block.bytes, block.error});
    return curve;
}

/// The first point of the curve that is at most as far away; the table keeps floats.
std::uint64_t bytes_until(const std::vector<Point>& curve, double error) {
    const auto at = std::find_if(curve.begin(), curve.end(),
                                 [&](const Point& p) { return p.error <= error * (1 + 1e-6); });
    return (at == curve.end() ? curve.back() : *at).bytes;
}

/// Area-weighted normals at the vertices.
Attribute smooth_normals(const Mesh& mesh) {
    std::vector<std::array<double, 3>> sums(mesh.positions.size());
    for (const Triangle& t : mesh.triangles) {
        const Float3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
        const double ux = double(b.x) - a.x, uy = double(b.y) - a.y, uz = double(b.z) - a.z;
        const double vx = double(c.x) - a.x, vy = double(c.y) - a.y, vz = double(c.z) - a.z;
        for (const std::uint32_t v : t) {
            sums[v][0] += uy * vz - uz * vy;
            sums[v][1] += uz * vx - ux * vz;
            sums[v][2] += ux * vy - uy * vx;
        }
    }
    Attribute normals{"NORMAL", Semantic::kNormal, 3, {}};
    for (const auto& s : sums) {
        const double length = std::hypot(s[0], s[1], s[2]);
        for (std::size_t k = 0; k < 3; ++k)
            normals.values.push_back(length > 0 ? float(s[k] / length) : float(k == 2));
    }
    return normals;
}

/// What normals add to the file of the same record without them.
Result<std::array<std::uint64_t, 2>> measure_normals(Mesh mesh) {
    mesh.attributes = {smooth_normals(mesh)};
    bake::CollapseOptions options;
    options.placement = bake::Placement::kEndpoint;
    auto record = bake::collapse(mesh, options);
    if (!record) return record.error();
    std::array<std::uint64_t, 2> sizes{};
    for (std::size_t i = 0; i < 2; ++i) {
        WriteOptions write;
        write.normal_bits = i ? 10 : 8;
        const auto file = write_progressive_mesh(record->mesh, write);
        if (!file) return file.error();
        sizes[i] = file->size();
    }
    record->mesh.attributes.clear();
    record->mesh.moved_values.clear();
    const auto bare = write_progressive_mesh(record->mesh);
    if (!bare) return bare.error();
    for (std::uint64_t& size : sizes) size -= std::min<std::uint64_t>(size, bare->size());
    return sizes;
}

Result<Profile> measure_profile(const Mesh& mesh, bake::Placement placement, const std::string& gltfpack) {
    bake::CollapseOptions options;
    options.placement = placement;
    const auto result = bake::collapse(mesh, options);
    if (!result) return result.error();
    const ProgressiveMesh& record = result->mesh;

    Profile p;
    p.profile = profile_name(placement);
    std::vector<Mesh> chain;
    for (int half = 0; half < kChain; ++half) {
        const std::size_t level = level_for_triangles(record, record.triangles.size() >> half);
        chain.push_back(cut(record, level));
        p.lods.push_back({chain.back().triangles.size(), error_at(record, level)});
    }
    const Mesh& full = chain.front();
    p.vertices = full.positions.size();
    p.triangles = full.triangles.size();
    p.diagonal = diagonal_of(full);

    const Scratch scratch;
    if (!gltfpack.empty()) {
        const auto written =
            bake::write_file(scratch.file("full.obj"), bake::encode_obj(full), /*overwrite=*/true);
        if (!written.ok()) return written.error();
    }
    for (const int bits : kBits) {
        WriteOptions write;
        write.position_bits = std::uint32_t(bits);
        const auto file = write_progressive_mesh(record, write);
        if (!file) return file.error();
        Size size{bits, file->size(), encode_draco(full, bits, 7).size()};
        for (int i = 0; i < kChain; ++i) {
            const std::size_t own = encode_draco(chain[std::size_t(i)], bits, 10).size();
            if (i == 0) size.draco_ten = own;
            if (own == 0) return Error{ErrorCode::kUnsupported, "Draco failed", Error::kNowhere, 0};
            size.chain += own;
            if (bits == 14) p.lods[std::size_t(i)].draco = own;
        }
        if (!gltfpack.empty())
            size.gltfpack =
                gltfpack_bytes(gltfpack, scratch.file("full.obj"), scratch.file("full.glb"), bits);
        if (bits == 14) {
            const auto info = read_info(*file);
            if (!info) return info.error();
            p.step = info->position_step;
            p.curve = curve_of(*info);
            for (Lod& lod : p.lods) lod.reached = bytes_until(p.curve, lod.error);
        }
        p.sizes.push_back(size);
    }
    return p;
}

}  // namespace

Result<Mesh> load_model(const std::string& path) {
    const auto bytes = bake::read_file(path);
    if (!bytes) return bytes.error();
    auto file = bake::parse_mesh(*bytes, fs::path(path).extension().string());
    if (!file) return file.error();
    file->mesh.weights.clear();  // Positions only.
    file->mesh.attributes.clear();
    file->mesh.groups.clear();
    return std::move(file->mesh);
}

Result<ModelSizes> measure_sizes(const std::string& path, const std::string& gltfpack) {
    const auto mesh = load_model(path);
    if (!mesh) return mesh.error();
    ModelSizes sizes;
    sizes.model = fs::path(path).stem().string();
    for (const bake::Placement placement : kPlacements) {
        auto profile = measure_profile(*mesh, placement, gltfpack);
        if (!profile) return profile.error();
        sizes.profiles.push_back(std::move(*profile));
    }
    const auto normals = measure_normals(*mesh);
    if (!normals) return normals.error();
    sizes.profiles.front().normals_8 = (*normals)[0];
    sizes.profiles.front().normals_10 = (*normals)[1];
    return sizes;
}

std::string gltfpack_version(const std::string& gltfpack) {
    std::string version;
    if (std::FILE* pipe = popen(fmt::format("'{}' -v 2>/dev/null", gltfpack).c_str(), "r")) {
        char line[256];
        while (std::fgets(line, sizeof(line), pipe))
            if (std::string(line).rfind("gltfpack ", 0) == 0) version = std::string(line + 9);
        pclose(pipe);
    }
    while (!version.empty() && std::isspace(static_cast<unsigned char>(version.back()))) version.pop_back();
    return version;
}

}  // namespace vsplit::bench
