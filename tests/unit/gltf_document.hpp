// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// glTF documents made by hand, for the tests: JSON, its binary buffer, and both as a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace vsplit::test {

using nlohmann::json;

/// A document with one buffer that grows.
struct GltfDocument {
    json root = {{"asset", {{"version", "2.0"}}}};
    std::vector<std::byte> bin;

    std::size_t add(const char* array, json object) {
        root[array].push_back(std::move(object));
        return root[array].size() - 1;
    }

    template <class T>
    std::size_t view(const std::vector<T>& values) {
        bin.resize((bin.size() + 3) / 4 * 4);
        const auto* from = reinterpret_cast<const std::byte*>(values.data());
        const std::size_t size = values.size() * sizeof(T);
        const std::size_t at = bin.size();
        bin.insert(bin.end(), from, from + size);
        return add("bufferViews", {{"buffer", 0}, {"byteOffset", at}, {"byteLength", size}});
    }

    template <class T>
    std::size_t accessor(const std::vector<T>& values, int component, const char* type, std::size_t count,
                         json more = json::object()) {
        json object = {
            {"bufferView", view(values)}, {"componentType", component}, {"type", type}, {"count", count}};
        object.update(more);
        return add("accessors", object);
    }

    std::size_t floats(const std::vector<float>& values, const char* type = "VEC3",
                       std::size_t components = 3) {
        return accessor(values, 5126, type, values.size() / components);
    }
    std::size_t shorts(const std::vector<std::uint16_t>& values) {
        return accessor(values, 5123, "SCALAR", values.size());
    }

    /// A mesh of one primitive.
    std::size_t mesh(json primitive) {
        return add("meshes", {{"primitives", json::array({std::move(primitive)})}});
    }
    std::size_t node(json node) { return add("nodes", std::move(node)); }
    void scene(std::vector<std::size_t> nodes) {
        add("scenes", {{"nodes", nodes}});
        root["scene"] = 0;
    }
    /// One mesh, one node, one scene.
    void scene_of(json primitive) { scene({node({{"mesh", mesh(std::move(primitive))}})}); }

    json with_buffer(const json& extra = json::object()) const {
        json out = root;
        json buffer = {{"byteLength", bin.size()}};
        buffer.update(extra);
        if (!out.contains("buffers")) out["buffers"] = json::array();
        out["buffers"].insert(out["buffers"].begin(), buffer);
        return out;
    }

    std::vector<std::byte> glb() const { return glb(with_buffer().dump(), bin); }

    static std::vector<std::byte> glb(std::string text, std::vector<std::byte> data) {
        text.resize((text.size() + 3) / 4 * 4, ' ');
        data.resize((data.size() + 3) / 4 * 4);
        std::vector<std::byte> out;
        const auto u32 = [&](std::size_t v) {
            for (int s = 0; s < 32; s += 8) out.push_back(std::byte(v >> s & 0xff));
        };
        u32(0x46546C67), u32(2), u32(12 + 8 + text.size() + 8 + data.size());
        u32(text.size()), u32(0x4E4F534A);
        for (const char c : text) out.push_back(std::byte(c));
        u32(data.size()), u32(0x004E4942);
        out.insert(out.end(), data.begin(), data.end());
        return out;
    }

    /// JSON with the buffer in a data: URI.
    std::vector<std::byte> gltf() const {
        return bytes(with_buffer({{"uri", "data:application/octet-stream;base64," + base64(bin)}}).dump(1));
    }

    static std::string base64(std::span<const std::byte> data) {
        static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string out;
        for (std::size_t i = 0; i < data.size(); i += 3) {
            std::uint32_t bits = 0;
            for (std::size_t k = 0; k < 3; ++k)
                bits = bits << 8 | (i + k < data.size() ? std::to_integer<std::uint32_t>(data[i + k]) : 0);
            for (std::size_t k = 0; k < 4; ++k)
                out += i + k > data.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
        }
        return out;
    }

    static std::vector<std::byte> bytes(const std::string& text) {
        std::vector<std::byte> out(text.size());
        if (!text.empty()) std::memcpy(out.data(), text.data(), text.size());
        return out;
    }
};

}  // namespace vsplit::test
