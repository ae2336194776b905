// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <array>
#include <bit>
#include <charconv>
#include <cstring>

#include "vsplit/bake/meshes.hpp"

static_assert(std::endian::native == std::endian::little, "values are copied as they are");

namespace vsplit::bake {
namespace {

std::byte* copy(std::byte* at, const void* from, std::size_t n) {
    std::memcpy(at, from, n);
    return at + n;
}

/// In the source's coordinates.
std::array<double, 3> placed(const Mesh& mesh, const Float3& p) {
    return {mesh.origin[0] + double(p.x), mesh.origin[1] + double(p.y), mesh.origin[2] + double(p.z)};
}

}  // namespace

std::vector<std::byte> encode_ply(const Mesh& mesh) {
    const bool weighted = !mesh.weights.empty(), wide = mesh.origin != std::array<double, 3>{};
    const std::string type = wide ? "double" : "float";
    std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                         std::to_string(mesh.positions.size()) + "\nproperty " + type + " x\nproperty " +
                         type + " y\nproperty " + type + " z\n";
    if (weighted) header += "property float quality\n";
    header += "element face " + std::to_string(mesh.triangles.size()) +
              "\nproperty list uchar uint vertex_indices\nend_header\n";

    std::vector<std::byte> bytes(header.size() +
                                 mesh.positions.size() * ((wide ? 24 : 12) + (weighted ? 4 : 0)) +
                                 mesh.triangles.size() * 13);
    std::byte* at = copy(bytes.data(), header.data(), header.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (wide) {
            const std::array<double, 3> place = placed(mesh, mesh.positions[v]);
            at = copy(at, place.data(), 24);
        } else {
            at = copy(at, &mesh.positions[v], 12);
        }
        if (weighted) at = copy(at, &mesh.weights[v], 4);
    }
    for (const Triangle& t : mesh.triangles) {
        *at++ = std::byte{3};
        at = copy(at, t.data(), 12);
    }
    return bytes;
}

std::vector<std::byte> encode_obj(const Mesh& mesh) {
    std::vector<std::byte> bytes;
    bytes.reserve(mesh.positions.size() * 36 + mesh.triangles.size() * 24);
    std::array<char, 128> line{};
    const auto write_line = [&](char kind, auto x, auto y, auto z) {
        char* at = line.data();
        *at++ = kind;
        for (const auto value : {x, y, z}) {
            *at++ = ' ';
            at = std::to_chars(at, line.data() + line.size(), value).ptr;
        }
        *at++ = '\n';
        const auto* first = reinterpret_cast<const std::byte*>(line.data());
        bytes.insert(bytes.end(), first, first + (at - line.data()));
    };
    const bool wide = mesh.origin != std::array<double, 3>{};
    for (const Float3& p : mesh.positions) {
        if (!wide) {
            write_line('v', p.x, p.y, p.z);
            continue;
        }
        const std::array<double, 3> place = placed(mesh, p);
        write_line('v', place[0], place[1], place[2]);
    }
    for (const Triangle& t : mesh.triangles)
        write_line('f', std::uint64_t{t[0]} + 1, std::uint64_t{t[1]} + 1, std::uint64_t{t[2]} + 1);
    return bytes;
}

}  // namespace vsplit::bake
