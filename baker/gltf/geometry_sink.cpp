// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "geometry_sink.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>

namespace vsplit::bake {
namespace {

constexpr int kVertices = 34962, kIndices = 34963;
constexpr const char* kMeshopt = "EXT_meshopt_compression";

std::uint64_t hash_of(std::span<const std::byte> bytes) {
    std::uint64_t hash = 0xCBF29CE484222325u;
    for (const std::byte b : bytes) hash = (hash ^ std::to_integer<std::uint64_t>(b)) * 0x100000001B3u;
    return hash;
}

OrderedJson numbers(const std::vector<double>& values, std::uint32_t component_type) {
    OrderedJson out = OrderedJson::array();
    for (const double value : values)
        if (component_type == kFloat)
            out.push_back(value);
        else
            out.push_back(std::int64_t(value));
    return out;
}

OrderedJson describe(const StoredAttribute& stored, std::size_t count) {
    OrderedJson out = {{"componentType", stored.component_type}, {"count", count}, {"type", stored.type}};
    if (stored.normalised) out["normalized"] = true;
    return out;
}

}  // namespace

GeometrySink::GeometrySink(OrderedJson& root, bool meshopt) : root_(root), meshopt_(meshopt) {
    for (const char* array : {"accessors", "bufferViews"})
        if (!root_.contains(array)) root_[array] = OrderedJson::array();
}

std::size_t GeometrySink::place(const char* array, std::size_t& next, OrderedJson object) {
    OrderedJson& objects = root_[array];
    while (next < objects.size() && !objects[next].is_null()) ++next;
    if (next == objects.size())
        objects.push_back(std::move(object));
    else
        objects[next] = std::move(object);
    return next++;
}

std::size_t GeometrySink::put(std::span<const std::byte> bytes, std::size_t alignment) {
    bin.resize((bin.size() + alignment - 1) / alignment * alignment);
    const std::size_t at = bin.size();
    bin.insert(bin.end(), bytes.begin(), bytes.end());
    last_offset_ = at;
    last_bytes_ = bytes.size();
    return at;
}

std::size_t GeometrySink::add_view(std::span<const std::byte> bytes, std::size_t alignment) {
    const std::size_t at = put(bytes, alignment);
    return place("bufferViews", next_view_,
                 {{"buffer", 0}, {"byteOffset", at}, {"byteLength", bytes.size()}});
}

std::size_t GeometrySink::add_stream(std::span<const std::byte> bytes, std::uint32_t stride,
                                     std::size_t count, int target) {
    OrderedJson view;
    if (!meshopt_) {
        const std::size_t at = put(bytes, 4);
        view = {{"buffer", 0}, {"byteOffset", at}, {"byteLength", bytes.size()}};
    } else {
        std::vector<unsigned char> packed;
        if (target == kIndices) {
            std::vector<std::uint32_t> wide(count);
            for (std::size_t i = 0; i < count; ++i) std::memcpy(&wide[i], bytes.data() + i * stride, stride);
            const std::size_t vertices = std::size_t(*std::max_element(wide.begin(), wide.end())) + 1;
            packed.resize(meshopt_encodeIndexBufferBound(count, vertices));
            packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), wide.data(), count));
        } else {
            packed.resize(meshopt_encodeVertexBufferBound(count, stride));
            packed.resize(
                meshopt_encodeVertexBuffer(packed.data(), packed.size(), bytes.data(), count, stride));
        }
        const std::size_t at = put(std::as_bytes(std::span(packed)), 4);
        fallback_bytes_ = (fallback_bytes_ + 3) / 4 * 4;
        view = {{"buffer", 1}, {"byteOffset", fallback_bytes_}, {"byteLength", bytes.size()}};
        fallback_bytes_ += bytes.size();
        view["extensions"][kMeshopt] = {{"buffer", 0},
                                        {"byteOffset", at},
                                        {"byteLength", packed.size()},
                                        {"byteStride", stride},
                                        {"count", count},
                                        {"mode", target == kIndices ? "TRIANGLES" : "ATTRIBUTES"}};
    }
    if (target == kVertices) view["byteStride"] = stride;
    view["target"] = target;
    return place("bufferViews", next_view_, std::move(view));
}

std::size_t GeometrySink::add_accessor(OrderedJson accessor, std::span<const std::byte> bytes,
                                       std::uint32_t stride, std::size_t count, int target) {
    const std::string description = accessor.dump() + (target == kIndices ? "i" : "v");
    const std::uint64_t hash = hash_of(bytes);
    const auto [begin, end] = known_.equal_range(hash);
    for (auto it = begin; it != end; ++it) {
        const Known& known = it->second;
        const auto stored = meshopt_ ? std::span<const std::byte>(known.plain)
                                     : std::span<const std::byte>(bin).subspan(known.offset, known.bytes);
        if (known.description == description &&
            std::equal(bytes.begin(), bytes.end(), stored.begin(), stored.end()))
            return known.accessor;
    }
    accessor["bufferView"] = add_stream(bytes, stride, count, target);
    Known known{0, last_offset_, last_bytes_, description, {}};
    if (meshopt_) known.plain.assign(bytes.begin(), bytes.end());
    known.accessor = place("accessors", next_accessor_, std::move(accessor));
    const std::size_t number = known.accessor;
    known_.emplace(hash, std::move(known));
    return number;
}

std::size_t GeometrySink::add_vertices(const PackedValues& values, bool bounds) {
    OrderedJson accessor = describe(values.stored, values.count);
    if (bounds) {
        accessor["min"] = numbers(values.min, values.stored.component_type);
        accessor["max"] = numbers(values.max, values.stored.component_type);
    }
    return add_accessor(std::move(accessor), values.bytes, values.stride, values.count, kVertices);
}

std::size_t GeometrySink::add_indices(std::span<const std::uint32_t> corners, std::size_t vertices) {
    StoredAttribute stored;
    stored.type = "SCALAR";
    // 65535 itself restarts a primitive, and so is no index.
    stored.component_type = vertices <= 65535 ? kUnsignedShort : kUnsignedInt;
    OrderedJson accessor = describe(stored, corners.size());
    if (vertices > 65535)
        return add_accessor(std::move(accessor), std::as_bytes(corners), 4, corners.size(), kIndices);
    std::vector<std::uint16_t> narrow(corners.begin(), corners.end());
    return add_accessor(std::move(accessor), std::as_bytes(std::span(narrow)), 2, corners.size(), kIndices);
}

std::size_t GeometrySink::add_promise(const StoredAttribute& stored, std::size_t count,
                                      const std::vector<double>& min, const std::vector<double>& max) {
    OrderedJson accessor = describe(stored, count);
    if (!min.empty()) {
        accessor["min"] = numbers(min, stored.component_type);
        accessor["max"] = numbers(max, stored.component_type);
    }
    return place("accessors", next_accessor_, std::move(accessor));
}

std::size_t GeometrySink::add_matrices(std::span<const float> values) {
    const std::size_t view = add_view(std::as_bytes(values));
    return place(
        "accessors", next_accessor_,
        {{"bufferView", view}, {"componentType", kFloat}, {"count", values.size() / 16}, {"type", "MAT4"}});
}

void GeometrySink::keep_view(std::size_t number, const KeptView& kept) {
    OrderedJson& view = root_["bufferViews"][number];
    const std::size_t at = put(kept.bytes, 8);
    OrderedJson head = {{"buffer", 0}, {"byteOffset", at}};
    OrderedJson* compressed = nullptr;
    if (OrderedJson* extensions = member(view, "extensions")) compressed = member(*extensions, kMeshopt);
    if (compressed != nullptr) {
        (*compressed)["buffer"] = 0;
        (*compressed)["byteOffset"] = at;
        (*compressed)["byteLength"] = kept.bytes.size();
        fallback_bytes_ = (fallback_bytes_ + 7) / 8 * 8;
        head = {{"buffer", 1}, {"byteOffset", fallback_bytes_}};
        fallback_bytes_ += kept.decoded_bytes;
    }
    for (auto& [key, value] : view.items()) head[key] = value;
    view = std::move(head);
}

void GeometrySink::finish() {
    const auto fill = [&](const char* array, const OrderedJson& stub) {
        OrderedJson& objects = root_[array];
        while (!objects.empty() && objects.back().is_null()) objects.erase(objects.size() - 1);
        for (OrderedJson& object : objects)
            if (object.is_null()) object = stub;
        if (objects.empty()) root_.erase(array);
    };
    fill("accessors", {{"componentType", kUnsignedByte}, {"count", 1}, {"type", "SCALAR"}});
    fill("bufferViews", {{"buffer", 0}, {"byteLength", 1}});
    if (bin.empty() && fallback_bytes_ == 0) return;
    root_["buffers"] = OrderedJson::array({{{"byteLength", bin.size()}}});
    if (fallback_bytes_ == 0) return;
    root_["buffers"].push_back(
        {{"byteLength", fallback_bytes_}, {"extensions", {{kMeshopt, {{"fallback", true}}}}}});
    use_extension(root_, kMeshopt, true);
}

}  // namespace vsplit::bake
