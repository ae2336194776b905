// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Mesh files made in memory, for the readers' tests.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "vsplit/bake/meshes.hpp"

namespace vsplit::test {

inline std::span<const std::byte> as_bytes(std::string_view text) {
    return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

inline Result<bake::MeshFile> parse(std::string_view bytes, std::string_view extension,
                                    const bake::ReadOptions& options = {}) {
    return bake::parse_mesh(as_bytes(bytes), extension, options);
}

/// Appends a value of a PLY type.
inline void put(std::string& bytes, std::string_view type, double value, bool big_endian) {
    const auto append = [&](auto typed) {
        char raw[sizeof(typed)];
        std::memcpy(raw, &typed, sizeof(typed));
        if (big_endian) std::reverse(raw, raw + sizeof(typed));
        bytes.append(raw, sizeof(typed));
    };
    if (type == "char")
        append(static_cast<std::int8_t>(value));
    else if (type == "uchar")
        append(static_cast<std::uint8_t>(value));
    else if (type == "short")
        append(static_cast<std::int16_t>(value));
    else if (type == "ushort")
        append(static_cast<std::uint16_t>(value));
    else if (type == "int")
        append(static_cast<std::int32_t>(value));
    else if (type == "uint")
        append(static_cast<std::uint32_t>(value));
    else if (type == "float")
        append(static_cast<float>(value));
    else
        append(value);
}

inline std::string ply_of(const Mesh& mesh, const char* format) {
    std::string bytes = std::string("ply\nformat ") + format + " 1.0\nelement vertex " +
                        std::to_string(mesh.positions.size()) +
                        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                        std::to_string(mesh.triangles.size()) +
                        "\nproperty list uchar int vertex_indices\nend_header\n";
    const bool text = std::string_view(format) == "ascii",
               big = std::string_view(format) == "binary_big_endian";
    char line[160];
    for (const Float3& p : mesh.positions) {
        if (!text)
            for (const float c : {p.x, p.y, p.z}) put(bytes, "float", c, big);
        else
            bytes.append(line, static_cast<std::size_t>(
                                   std::snprintf(line, sizeof line, "%.9g %.9g %.9g\n", p.x, p.y, p.z)));
    }
    for (const Triangle& t : mesh.triangles) {
        if (!text) {
            put(bytes, "uchar", 3, big);
            for (const std::uint32_t v : t) put(bytes, "int", v, big);
        } else
            bytes.append(line, static_cast<std::size_t>(
                                   std::snprintf(line, sizeof line, "3 %u %u %u\n", t[0], t[1], t[2])));
    }
    return bytes;
}

inline std::string off_of(const Mesh& mesh) {
    std::string text = "OFF\n" + std::to_string(mesh.positions.size()) + " " +
                       std::to_string(mesh.triangles.size()) + " 0\n";
    char line[160];
    for (const Float3& p : mesh.positions)
        text.append(line, static_cast<std::size_t>(
                              std::snprintf(line, sizeof line, "%.9g %.9g %.9g\n", p.x, p.y, p.z)));
    for (const Triangle& t : mesh.triangles)
        text.append(line, static_cast<std::size_t>(
                              std::snprintf(line, sizeof line, "3 %u %u %u\n", t[0], t[1], t[2])));
    return text;
}

inline std::string stl_of(const Mesh& mesh, std::string_view head) {
    std::string bytes(head);
    bytes.resize(80, ' ');
    put(bytes, "uint", double(mesh.triangles.size()), false);
    for (const Triangle& t : mesh.triangles) {
        bytes.append(12, '\0');
        for (const std::uint32_t v : t)
            for (const float c : {mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z})
                put(bytes, "float", c, false);
        bytes.append(2, '\0');
    }
    return bytes;
}

inline std::string stl_text_of(const Mesh& mesh) {
    std::string text = "solid s\n";
    char line[160];
    for (const Triangle& t : mesh.triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const std::uint32_t v : t) {
            const Float3 p = mesh.positions[v];
            text.append(line, static_cast<std::size_t>(std::snprintf(
                                  line, sizeof line, "vertex %.9g %.9g %.9g\n", p.x, p.y, p.z)));
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid s\n";
}

inline std::string obj_of(const Mesh& mesh) {
    const auto bytes = bake::encode_obj(mesh);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace vsplit::test
