// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A glTF accessor's elements, checked once and then read without further thought.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "document.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

/// Reads a range-checked accessor, dense or sparse. Refers to the document's bytes.
class AccessorReader {
  public:
    /// `name` is the place that names the accessor, for errors: "meshes[3].primitives[0].indices".
    /// Every byte that read() and index() may touch is checked here; no memory is taken that grows with the
    /// count.
    static Result<AccessorReader> open(Document& document, int accessor, const std::string& name);

    std::uint64_t count() const { return count_; }
    int components() const { return components_; }
    int type() const { return shape_; }  ///< TINYGLTF_TYPE_VEC3, ...
    bool normalised() const { return normalised_; }
    int component_type() const { return type_; }

    /// Element i < count() as floats, normalised integers in [-1, 1], into `out` of components() floats.
    void read(std::uint64_t i, std::span<float> out) const;
    /// Element i < count() of a scalar unsigned accessor.
    std::uint32_t index(std::uint64_t i) const;
    /// Component c < components() of element i < count() of an unsigned accessor that is no matrix.
    std::uint32_t integer(std::uint64_t i, std::uint64_t c) const;

  private:
    const std::byte* element(std::uint64_t i) const;

    const std::byte* base_ = nullptr;  // nullptr: zeros
    std::uint64_t count_ = 0, stride_ = 0;
    int components_ = 0, type_ = 0, shape_ = 0;
    std::uint64_t column_ = 0;  // from one column of a matrix to the next; components are tight within
    int rows_ = 0;
    bool normalised_ = false;
    // Sparse: strictly increasing element numbers and their values.
    const std::byte* sparse_values_ = nullptr;
    const std::byte* sparse_indices_ = nullptr;
    std::uint64_t sparse_count_ = 0, size_ = 0;
    int sparse_type_ = 0;
};

}  // namespace vsplit::bake
