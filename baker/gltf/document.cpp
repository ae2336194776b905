// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "document.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "buffers.hpp"
#include "compressed.hpp"
#include "container.hpp"
#include "shape.hpp"

namespace vsplit::bake {

using nlohmann::json;

std::string object_name(const char* array, std::size_t index) {
    return std::string(array) + "[" + std::to_string(index) + "]";
}

namespace {

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}

Result<json> parse_json(const GltfContainer& container) {
    if (Status depth = check_json_depth(container.json, container.json_offset); !depth.ok())
        return depth.error();
    try {
        return json::parse(container.json);
    } catch (const json::parse_error& error) {
        // "[json.exception.parse_error.101] parse error at line 1, column 5: what was wrong"
        std::string_view what = error.what();
        if (const auto colon = what.find(": "); colon != what.npos) what.remove_prefix(colon + 2);
        const std::size_t at =
            std::min<std::size_t>(error.byte > 0 ? error.byte - 1 : 0, container.json.size());
        const bool at_end = at >= container.json.size() && !container.binary;
        Error out{at_end ? ErrorCode::kTruncated : ErrorCode::kMalformed, "JSON: " + std::string(what),
                  container.json_offset + at, 0};
        if (!container.binary)
            out.line = 1 + std::uint64_t(std::count(container.json.begin(),
                                                    container.json.begin() + std::ptrdiff_t(at), '\n'));
        return out;
    } catch (const json::exception& error) {  // A number too large for a double.
        return Error{ErrorCode::kMalformed, std::string("JSON: ") + error.what(), container.json_offset, 0};
    }
}

/// Required extensions that leave positions and triangles as they are. Whatever else a file requires may
/// change them.
Status check_extensions(const json& document) {
    constexpr std::array kRead = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                  "KHR_mesh_quantization", "MSFT_lod"};
    constexpr std::array kAppearance = {"KHR_materials_", "EXT_materials_", "ADOBE_materials_",
                                        "KHR_texture_",   "EXT_texture_",   "MSFT_texture_",
                                        "MSFT_packing_",  "KHR_lights_",    "EXT_lights_",
                                        "KHR_xmp",        "KHR_animation_", "KHR_techniques_webgl"};
    if (!document.contains("extensionsRequired")) return Ok{};
    for (const json& item : document["extensionsRequired"]) {
        const auto& name = item.get_ref<const std::string&>();
        const bool known =
            std::any_of(kRead.begin(), kRead.end(), [&](const char* s) { return name == s; }) ||
            std::any_of(kAppearance.begin(), kAppearance.end(),
                        [&](const char* s) { return name.starts_with(s); });
        if (!known)
            return fault(ErrorCode::kUnsupported,
                         "the scene requires the extension " + name.substr(0, 100) + ", which is not read");
    }
    return Ok{};
}

json* extension(json& object, const char* name) {
    const auto found = object.find("extensions");
    if (found == object.end()) return nullptr;
    const auto inner = found->find(name);
    return inner == found->end() ? nullptr : &*inner;
}

}  // namespace

struct DocumentBuilder {
    Document out;

    Status load_buffers(json& shaped, const GltfContainer& container, const std::string& folder) {
        json& buffers = shaped["buffers"];
        for (std::size_t i = 0; i < buffers.size(); ++i) {
            json& buffer = buffers[i];
            const auto length = buffer["byteLength"].get<std::uint64_t>();
            Document::BufferBytes bytes;
            if (buffer.contains("uri")) {
                auto loaded = load_uri(buffer["uri"].get_ref<const std::string&>(), folder);
                if (!loaded.ok())
                    return fault(loaded.error().code,
                                 object_name("buffers", i) + ": " + loaded.error().message);
                out.owned_.push_back(std::move(loaded).value());
                bytes.bytes = out.owned_.back();
            } else if (i == 0 && container.bin) {
                bytes.bytes = *container.bin;
            } else if (extension(buffer, "EXT_meshopt_compression") != nullptr) {
                bytes.there = false;
            } else {
                return fault(ErrorCode::kMalformed,
                             object_name("buffers", i) + " has no uri and the file no BIN chunk for it");
            }
            if (bytes.there && bytes.bytes.size() < length)
                return fault(ErrorCode::kTruncated,
                             object_name("buffers", i) + " has " + std::to_string(bytes.bytes.size()) +
                                 " bytes of the " + std::to_string(length) + " announced");
            if (bytes.there) bytes.bytes = bytes.bytes.first(length);
            out.total_bytes_ += bytes.bytes.size();
            out.buffers_.push_back(bytes);
        }
        return Ok{};
    }

    void take_extensions(json& shaped) {
        json& views = shaped["bufferViews"];
        for (std::size_t i = 0; i < views.size(); ++i)
            if (const json* found = extension(views[i], "EXT_meshopt_compression")) {
                const auto number = [&](const char* key) { return found->value(key, std::uint64_t{0}); };
                out.meshopt[i] = {number("buffer"),          number("byteOffset"), number("byteLength"),
                                  number("byteStride"),      number("count"),      found->value("mode", ""),
                                  found->value("filter", "")};
            }
        json& meshes = shaped["meshes"];
        for (std::size_t m = 0; m < meshes.size(); ++m)
            for (std::size_t p = 0; p < meshes[m]["primitives"].size(); ++p) {
                json& primitive = meshes[m]["primitives"][p];
                const json* found = extension(primitive, "KHR_draco_mesh_compression");
                if (found == nullptr) continue;
                DracoPrimitive& draco = out.draco[{m, p}];
                draco.view = found->at("bufferView").get<std::size_t>();
                for (const auto& [name, id] : found->at("attributes").items())
                    draco.attributes[name] = id.get<std::uint32_t>();
                // The indices come out of Draco; tinygltf would refuse the accessor, which has no buffer view
                // then.
                primitive.erase("indices");
            }
        json& nodes = shaped["nodes"];
        out.is_lod.assign(nodes.size(), 0);
        for (json& node : nodes)
            if (const json* found = extension(node, "MSFT_lod"))
                for (const json& id : found->at("ids")) out.is_lod[id.get<std::size_t>()] = 1;
        for (json* objects : {&views, &nodes})
            for (json& object : *objects) object.erase("extensions");
        for (json& mesh : meshes)
            for (json& primitive : mesh["primitives"]) primitive.erase("extensions");
    }

    Status build(Bytes file, const std::string& folder) {
        auto container = open_container(file);
        if (!container.ok()) return container.error();
        auto document = parse_json(*container);
        if (!document.ok()) return document.error();
        auto result = shape_document(std::move(*document));
        if (!result.ok()) return result.error();
        json& shaped = *result;
        const auto& version = shaped["asset"]["version"].get_ref<const std::string&>();
        if (!version.starts_with("2."))
            return fault(ErrorCode::kUnsupported,
                         "glTF version '" + version.substr(0, 20) + "', only 2 is read");
        if (Status status = check_extensions(shaped); !status.ok()) return status;
        for (const char* array : {"buffers", "bufferViews", "meshes", "nodes", "skins"})
            if (!shaped.contains(array)) shaped[array] = json::array();
        out.binary = container->binary;
        out.total_bytes_ = file.size();
        if (Status status = load_buffers(shaped, *container, folder); !status.ok()) return status;
        take_extensions(shaped);
        shaped.erase("buffers");  // They stay with us: tinygltf would copy them, and open files.

        const std::string text = shaped.dump();
        if (text.size() > UINT32_MAX) return fault(ErrorCode::kLimit, "the JSON is longer than 4 GiB");
        tinygltf::TinyGLTF loader;
        std::string error, warning;
        if (!loader.LoadASCIIFromString(&out.model, &error, &warning, text.data(),
                                        static_cast<unsigned>(text.size()), "")) {
            if (const auto end = error.find('\n'); end != error.npos) error.resize(end);
            return fault(ErrorCode::kMalformed, "glTF: " + error);
        }
        // What tinygltf cannot read it leaves out; then our numbers would not be its own.
        bool whole = out.model.nodes.size() == shaped["nodes"].size() &&
                     out.model.meshes.size() == shaped["meshes"].size() &&
                     out.model.bufferViews.size() == shaped["bufferViews"].size() &&
                     out.model.skins.size() == shaped["skins"].size();
        for (std::size_t m = 0; whole && m < out.model.meshes.size(); ++m) {
            const json& primitives = shaped["meshes"][m]["primitives"];
            whole = out.model.meshes[m].primitives.size() == primitives.size();
            for (std::size_t p = 0; whole && p < primitives.size(); ++p)
                whole = out.model.meshes[m].primitives[p].targets.size() ==
                        (primitives[p].contains("targets") ? primitives[p]["targets"].size() : 0);
        }
        if (!whole) return fault(ErrorCode::kMalformed, "glTF: part of the document cannot be read");
        return Ok{};
    }
};

Result<Document> Document::parse(Bytes file, const std::string& folder) {
    DocumentBuilder builder;
    if (Status status = builder.build(file, folder); !status.ok()) return status.error();
    return std::move(builder.out);
}

Result<Bytes> Document::stored(std::size_t buffer, std::uint64_t offset, std::uint64_t length) const {
    if (!buffers_[buffer].there)
        return fault(ErrorCode::kMalformed, "lies in a fallback buffer that is not stored");
    const Bytes bytes = buffers_[buffer].bytes;
    if (offset > bytes.size() || length > bytes.size() - offset)
        return fault(ErrorCode::kMalformed, "reaches beyond the " + std::to_string(bytes.size()) +
                                                " bytes of " + object_name("buffers", buffer));
    return bytes.subspan(offset, length);
}

Result<Bytes> Document::view(std::size_t index) {
    const auto name = [&] { return object_name("bufferViews", index); };
    const auto cut = [&](std::size_t buffer, std::uint64_t offset, std::uint64_t length) -> Result<Bytes> {
        auto bytes = stored(buffer, offset, length);
        if (!bytes.ok()) return fault(bytes.error().code, name() + " " + bytes.error().message);
        return bytes;
    };
    const auto compressed = meshopt.find(index);
    if (compressed == meshopt.end()) {
        const tinygltf::BufferView& view = model.bufferViews[index];
        return cut(static_cast<std::size_t>(view.buffer), view.byteOffset, view.byteLength);
    }
    if (const auto found = decoded_.find(index); found != decoded_.end()) return Bytes(found->second);
    const auto source = cut(compressed->second.buffer, compressed->second.offset, compressed->second.length);
    if (!source.ok()) return source.error();
    auto decoded = decode_meshopt(compressed->second, *source,
                                  kMeshoptExpansion * (total_bytes_ + 4096) - decoded_bytes_);
    if (!decoded.ok()) return fault(decoded.error().code, name() + ": " + decoded.error().message);
    decoded_bytes_ += decoded->size();
    return Bytes(decoded_[index] = std::move(decoded).value());
}

}  // namespace vsplit::bake
