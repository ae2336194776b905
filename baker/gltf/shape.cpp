// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "shape.hpp"

#include <cmath>
#include <cstdint>
#include <span>
#include <string>

namespace vsplit::bake {
namespace {

using nlohmann::json;

enum class Kind {
    kUnsigned,     // 0 .. 2^53, so that a product with a stride cannot overflow 64 bits
    kIndex,        // into the top-level array `target`
    kIndices,      // array of the same
    kIndexMap,     // object of the same
    kIndexMaps,    // array of such objects
    kUnsignedMap,  // object of small numbers
    kBool,
    kString,
    kStrings,
    kNumbers,  // exactly `count` finite ones
    kObject,   // with `fields`
    kObjects,  // array of objects with `fields`
};

struct Field {
    const char* name;
    Kind kind;
    bool required = false;
    const char* target = nullptr;
    std::size_t count = 0;
    std::span<const Field> fields = {};
};

constexpr Field kSparseIndices[] = {{"bufferView", Kind::kIndex, true, "bufferViews"},
                                    {"byteOffset", Kind::kUnsigned},
                                    {"componentType", Kind::kUnsigned, true}};
constexpr Field kSparseValues[] = {{"bufferView", Kind::kIndex, true, "bufferViews"},
                                   {"byteOffset", Kind::kUnsigned}};
constexpr Field kSparse[] = {{"count", Kind::kUnsigned, true},
                             {"indices", Kind::kObject, true, nullptr, 0, kSparseIndices},
                             {"values", Kind::kObject, true, nullptr, 0, kSparseValues}};
constexpr Field kAccessor[] = {{"bufferView", Kind::kIndex, false, "bufferViews"},
                               {"byteOffset", Kind::kUnsigned},
                               {"componentType", Kind::kUnsigned, true},
                               {"normalized", Kind::kBool},
                               {"count", Kind::kUnsigned, true},
                               {"type", Kind::kString, true},
                               {"sparse", Kind::kObject, false, nullptr, 0, kSparse}};
constexpr Field kMeshopt[] = {{"buffer", Kind::kIndex, true, "buffers"},
                              {"byteOffset", Kind::kUnsigned},
                              {"byteLength", Kind::kUnsigned, true},
                              {"byteStride", Kind::kUnsigned, true},
                              {"count", Kind::kUnsigned, true},
                              {"mode", Kind::kString, true},
                              {"filter", Kind::kString}};
constexpr Field kViewExtensions[] = {{"EXT_meshopt_compression", Kind::kObject, false, nullptr, 0, kMeshopt}};
constexpr Field kBufferView[] = {{"buffer", Kind::kIndex, true, "buffers"},
                                 {"byteOffset", Kind::kUnsigned},
                                 {"byteLength", Kind::kUnsigned, true},
                                 {"byteStride", Kind::kUnsigned},
                                 {"extensions", Kind::kObject, false, nullptr, 0, kViewExtensions}};
constexpr Field kFallback[] = {{"fallback", Kind::kBool}};
constexpr Field kBufferExtensions[] = {
    {"EXT_meshopt_compression", Kind::kObject, false, nullptr, 0, kFallback}};
constexpr Field kBuffer[] = {{"uri", Kind::kString},
                             {"byteLength", Kind::kUnsigned, true},
                             {"extensions", Kind::kObject, false, nullptr, 0, kBufferExtensions}};
constexpr Field kDraco[] = {{"bufferView", Kind::kIndex, true, "bufferViews"},
                            {"attributes", Kind::kUnsignedMap, true}};
constexpr Field kPrimitiveExtensions[] = {
    {"KHR_draco_mesh_compression", Kind::kObject, false, nullptr, 0, kDraco}};
constexpr Field kPrimitive[] = {{"attributes", Kind::kIndexMap, true, "accessors"},
                                {"indices", Kind::kIndex, false, "accessors"},
                                {"mode", Kind::kUnsigned},
                                {"targets", Kind::kIndexMaps, false, "accessors"},
                                {"extensions", Kind::kObject, false, nullptr, 0, kPrimitiveExtensions}};
constexpr Field kMesh[] = {{"primitives", Kind::kObjects, true, nullptr, 0, kPrimitive}};
constexpr Field kLod[] = {{"ids", Kind::kIndices, true, "nodes"}};
constexpr Field kNodeExtensions[] = {{"MSFT_lod", Kind::kObject, false, nullptr, 0, kLod}};
constexpr Field kNode[] = {{"children", Kind::kIndices, false, "nodes"},
                           {"mesh", Kind::kIndex, false, "meshes"},
                           {"skin", Kind::kIndex, false, "skins"},
                           {"matrix", Kind::kNumbers, false, nullptr, 16},
                           {"translation", Kind::kNumbers, false, nullptr, 3},
                           {"rotation", Kind::kNumbers, false, nullptr, 4},
                           {"scale", Kind::kNumbers, false, nullptr, 3},
                           {"extensions", Kind::kObject, false, nullptr, 0, kNodeExtensions}};
constexpr Field kSkin[] = {{"joints", Kind::kIndices, true, "nodes"},
                           {"inverseBindMatrices", Kind::kIndex, false, "accessors"}};
constexpr Field kScene[] = {{"nodes", Kind::kIndices, false, "nodes"}};
constexpr Field kAsset[] = {{"version", Kind::kString, true}, {"minVersion", Kind::kString}};
constexpr Field kRoot[] = {{"asset", Kind::kObject, true, nullptr, 0, kAsset},
                           {"extensionsUsed", Kind::kStrings},
                           {"extensionsRequired", Kind::kStrings},
                           {"scene", Kind::kIndex, false, "scenes"},
                           {"scenes", Kind::kObjects, false, nullptr, 0, kScene},
                           {"nodes", Kind::kObjects, false, nullptr, 0, kNode},
                           {"meshes", Kind::kObjects, false, nullptr, 0, kMesh},
                           {"skins", Kind::kObjects, false, nullptr, 0, kSkin},
                           {"accessors", Kind::kObjects, false, nullptr, 0, kAccessor},
                           {"bufferViews", Kind::kObjects, false, nullptr, 0, kBufferView},
                           {"buffers", Kind::kObjects, false, nullptr, 0, kBuffer}};

/// Walks document and table together. The path is kept in one string and only grown and cut, since it is
/// rarely read.
class Shaper {
  public:
    explicit Shaper(const json& root) {
        for (const Field& field : kRoot)
            if (field.kind == Kind::kObjects && root.contains(field.name) && root[field.name].is_array())
                sizes_[field.name] = root[field.name].size();
    }

    Status object(json& in, std::span<const Field> fields, json& out) {
        if (!in.is_object()) return wrong("must be an object");
        out = json::object();
        for (const Field& field : fields) {
            const std::size_t length = path_.size();
            if (!path_.empty()) path_ += '.';
            path_ += field.name;
            const auto found = in.find(field.name);
            if (found == in.end()) {
                if (field.required) return wrong("is missing");
            } else {
                Status status = value(*found, field, out[field.name]);
                if (!status.ok()) return status;
            }
            path_.resize(length);
        }
        return Ok{};
    }

  private:
    Error wrong(const char* what) const {
        return {ErrorCode::kMalformed, (path_.empty() ? std::string("the document") : path_) + " " + what,
                Error::kNowhere, 0};
    }

    /// Whole numbers written as 3.0 are whole numbers in JSON.
    static bool whole(json& in, std::uint64_t max) {
        if (in.is_number_unsigned()) return in.get<std::uint64_t>() <= max;
        if (!in.is_number_float()) return false;
        const double number = in.get<double>();
        if (!(number >= 0) || number > double(max) || number != std::floor(number)) return false;
        in = static_cast<std::uint64_t>(number);
        return true;
    }

    Status index(json& in, const char* target, json& out) {
        const auto size = sizes_.find(target);
        if (!whole(in, INT32_MAX)) return wrong("must be an index");
        if (size == sizes_.end() || in.get<std::uint64_t>() >= size->second) {
            const std::string text =
                "names " + std::string(target) + "[" + in.dump() + "], which does not exist";
            return wrong(text.c_str());
        }
        out = std::move(in);
        return Ok{};
    }

    template <class Each>
    Status array(json& in, json& out, Each each) {
        if (!in.is_array()) return wrong("must be an array");
        out = json::array();
        out.get_ref<json::array_t&>().resize(in.size());
        const std::size_t length = path_.size();
        for (std::size_t i = 0; i < in.size(); ++i) {
            path_ += '[';
            path_ += std::to_string(i);
            path_ += ']';
            Status status = each(in[i], out[i]);
            if (!status.ok()) return status;
            path_.resize(length);
        }
        return Ok{};
    }

    template <class Each>
    Status map(json& in, json& out, Each each) {
        if (!in.is_object()) return wrong("must be an object");
        out = json::object();
        const std::size_t length = path_.size();
        for (auto it = in.begin(); it != in.end(); ++it) {
            path_ += '.';
            path_ += it.key();
            Status status = each(it.value(), out[it.key()]);
            if (!status.ok()) return status;
            path_.resize(length);
        }
        return Ok{};
    }

    Status value(json& in, const Field& field, json& out) {
        const auto leaf = [&](bool good, const char* must) -> Status {
            if (!good) return wrong(must);
            out = std::move(in);
            return Ok{};
        };
        switch (field.kind) {
            case Kind::kUnsigned:
                return leaf(whole(in, std::uint64_t{1} << 53), "must be a whole number, not negative");
            case Kind::kBool:
                return leaf(in.is_boolean(), "must be true or false");
            case Kind::kString:
                return leaf(in.is_string(), "must be a string");
            case Kind::kIndex:
                return index(in, field.target, out);
            case Kind::kIndices:
                return array(in, out, [&](json& from, json& to) { return index(from, field.target, to); });
            case Kind::kIndexMap:
                return map(in, out, [&](json& from, json& to) { return index(from, field.target, to); });
            case Kind::kIndexMaps:
                return array(in, out, [&](json& from, json& to) {
                    return map(from, to,
                               [&](json& number, json& taken) { return index(number, field.target, taken); });
                });
            case Kind::kUnsignedMap:
                return map(in, out, [&](json& from, json& to) -> Status {
                    if (!whole(from, INT32_MAX)) return wrong("must be a whole number, not negative");
                    to = std::move(from);
                    return Ok{};
                });
            case Kind::kStrings:
                return array(in, out, [&](json& from, json& to) -> Status {
                    if (!from.is_string()) return wrong("must be a string");
                    to = std::move(from);
                    return Ok{};
                });
            case Kind::kNumbers:
                if (!in.is_array() || in.size() != field.count) {
                    const std::string text =
                        "must be an array of " + std::to_string(field.count) + " numbers";
                    return wrong(text.c_str());
                }
                return array(in, out, [&](json& from, json& to) -> Status {
                    if (!from.is_number()) return wrong("must be a number");
                    to = from.get<double>();
                    return Ok{};
                });
            case Kind::kObject:
                return object(in, field.fields, out);
            case Kind::kObjects:
                return array(in, out, [&](json& from, json& to) { return object(from, field.fields, to); });
        }
        return wrong("cannot be read");
    }

    std::string path_;
    std::map<std::string, std::size_t, std::less<>> sizes_;
};

}  // namespace

Result<json> shape_document(json&& document) {
    json shaped;
    Status status = Shaper(document).object(document, kRoot, shaped);
    if (!status.ok()) return status.error();
    return shaped;
}

}  // namespace vsplit::bake
