// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The binary chunk of a GLB as it grows, with its buffer views and accessors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "pack.hpp"
#include "scene_document.hpp"

namespace vsplit::bake {

/// Takes the places that are free (null) in the document's arrays first. Equal accessors become one.
class GeometrySink {
  public:
    /// `meshopt`: vertices and indices are compressed.
    GeometrySink(OrderedJson& root, bool meshopt);

    /// Return the accessor's number. `bounds`: with min and max.
    std::size_t add_vertices(const PackedValues& values, bool bounds);
    std::size_t add_indices(std::span<const std::uint32_t> corners, std::size_t vertices);
    /// An accessor without a view, for Draco to fill.
    std::size_t add_promise(const StoredAttribute& stored, std::size_t count, const std::vector<double>& min,
                            const std::vector<double>& max);
    /// 4x4 float matrices, 16 each.
    std::size_t add_matrices(std::span<const float> values);
    /// A view without a target; returns its number.
    std::size_t add_view(std::span<const std::byte> bytes, std::size_t alignment = 4);

    /// Gives a view that stays its place.
    void keep_view(std::size_t number, const KeptView& view);

    /// Names the buffers and leaves no null.
    void finish();

    std::vector<std::byte> bin;

  private:
    std::size_t place(const char* array, std::size_t& next, OrderedJson object);
    std::size_t add_accessor(OrderedJson accessor, std::span<const std::byte> bytes, std::uint32_t stride,
                             std::size_t count, int target);
    std::size_t add_stream(std::span<const std::byte> bytes, std::uint32_t stride, std::size_t count,
                           int target);
    std::size_t put(std::span<const std::byte> bytes, std::size_t alignment);

    OrderedJson& root_;
    bool meshopt_;
    std::size_t next_accessor_ = 0, next_view_ = 0;
    std::uint64_t fallback_bytes_ = 0;
    struct Known {
        std::size_t accessor, offset, bytes;
        std::string description;
        std::vector<std::byte> plain;  // if the binary chunk has them compressed only
    };
    std::multimap<std::uint64_t, Known> known_;
    std::size_t last_offset_ = 0, last_bytes_ = 0;
};

}  // namespace vsplit::bake
