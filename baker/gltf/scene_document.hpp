// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What remains of a glTF document when its triangles are taken out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "document.hpp"
#include "scene_nodes.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

using OrderedJson = nlohmann::ordered_json;

/// A buffer view that stays, and its bytes, compressed by EXT_meshopt_compression as they were.
struct KeptView {
    std::vector<std::byte> bytes;
    std::uint64_t decoded_bytes = 0;  ///< If they are compressed: of what stands in for them uncompressed.
    bool image = false;
};

/// No number of an object that stays changes, since extensions may name it in ways that nobody knows:
/// accessors and buffer views that are gone leave a null, for the next one to take. `root` has no buffers,
/// and its triangle primitives have lost indices, attributes and targets.
struct SceneDocument {
    OrderedJson root;
    std::map<std::size_t, KeptView> views;
    /// Per skin its matrices, column by column, 16 floats a joint; identity where the document has none.
    std::vector<std::vector<float>> inverse_bind;
};

/// The triangle primitives that are taken out, as mesh and primitive.
using TakenPrimitives = std::set<std::pair<std::size_t, std::size_t>>;

/// `document` is that of `file`, and `notes` gets a line for each image that stays outside. Levels of detail
/// that the document has (MSFT_lod) are taken out of it. May throw what nlohmann::json throws.
Result<SceneDocument> remaining_document(Bytes file, Document& document, const std::string& folder,
                                         const SceneUse& use, const TakenPrimitives& taken,
                                         std::vector<std::string>& notes);

/// Removes `name` from extensionsUsed and extensionsRequired, and these if they are empty then.
void forget_extension(OrderedJson& root, const char* name);
/// Adds it, once.
void use_extension(OrderedJson& root, const char* name, bool required);
/// `root[key]`, or null.
const OrderedJson* member(const OrderedJson& object, const char* key);
OrderedJson* member(OrderedJson& object, const char* key);
/// The object's extension of this name, or nullptr.
const OrderedJson* extension_of(const OrderedJson& object, const char* name);
/// Erases it, and `extensions` if it is empty then.
void erase_extension(OrderedJson& object, const char* name);

}  // namespace vsplit::bake
