// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A glTF document that was checked: tinygltf's model of it, and the bytes that it speaks of.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vsplit/result.hpp"

namespace vsplit::bake {

using Bytes = std::span<const std::byte>;

/// A buffer view's bytes under EXT_meshopt_compression.
struct MeshoptView {
    std::size_t buffer = 0;
    std::uint64_t offset = 0, length = 0, stride = 0, count = 0;
    std::string mode, filter;
};

/// A primitive under KHR_draco_mesh_compression: its buffer view, and Draco's ids of the attributes.
struct DracoPrimitive {
    std::size_t view = 0;
    std::map<std::string, std::uint32_t> attributes;
};

/// Every index in `model` is in range, but for the ranges within buffers, which view() and AccessorReader
/// check. The model holds the geometric part only: no buffers' data, images, materials or extensions. Refers
/// to the bytes that it was parsed from.
class Document {
  public:
    tinygltf::Model model;
    std::map<std::pair<std::size_t, std::size_t>, DracoPrimitive> draco;  ///< By mesh and primitive.
    std::map<std::size_t, MeshoptView> meshopt;                           ///< By buffer view.
    std::vector<std::uint8_t> is_lod;  ///< Per node: a coarser level of another one (MSFT_lod).
    bool binary = false;

    /// A buffer view's bytes, decompressed if need be. They live as long as the document.
    Result<Bytes> view(std::size_t index);

    /// Bytes of a buffer as they are stored.
    Result<Bytes> stored(std::size_t buffer, std::uint64_t offset, std::uint64_t length) const;

    /// Bytes of file and buffers together: what counts in the document are measured against.
    std::uint64_t total_bytes() const { return total_bytes_; }

    /// `folder`: where external buffers are looked for, "" refuses them.
    static Result<Document> parse(Bytes file, const std::string& folder);

  private:
    struct BufferBytes {
        Bytes bytes;
        bool there = true;  // false: a fallback for readers without meshopt, not stored
    };
    std::vector<BufferBytes> buffers_;
    std::vector<std::vector<std::byte>> owned_;
    std::map<std::size_t, std::vector<std::byte>> decoded_;
    std::uint64_t total_bytes_ = 0, decoded_bytes_ = 0;

    friend struct DocumentBuilder;
};

/// "bufferViews[7]"
std::string object_name(const char* array, std::size_t index);

}  // namespace vsplit::bake
