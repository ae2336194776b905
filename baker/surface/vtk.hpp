// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// VTK XML files with appended raw data, as ParaView opens them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "points/vec3.hpp"

namespace vsplit::bake {

/// Gathers arrays, then writes the file. `Cells` are given as corners and ends, as VTK wants them.
class VtkFile {
  public:
    void points(std::span<const Vec3> points);
    void point_data(const char* name, std::span<const double> values);
    void point_data(const char* name, std::span<const std::int32_t> values);
    void cell_data(const char* name, std::span<const std::int32_t> values);
    /// Cells of `corners` corners each: 1 vertices, 2 lines, 3 triangles, 4 tetrahedra.
    void cells(int corners, std::span<const std::int64_t> connectivity);

    std::vector<std::byte> poly_data() const;          ///< .vtp
    std::vector<std::byte> unstructured_grid() const;  ///< .vtu

  private:
    struct Array {
        std::string attributes;
        std::vector<std::byte> bytes;
    };
    struct Cells {
        int corners;
        std::vector<std::int64_t> connectivity;
    };
    template <class T>
    static Array array(std::string attributes, std::span<const T> values);
    std::vector<std::byte> assemble(bool grid) const;

    std::size_t point_count_ = 0;
    Array points_;
    std::vector<Array> point_data_, cell_data_;
    std::vector<Cells> cells_;
};

}  // namespace vsplit::bake
