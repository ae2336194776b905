// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cmath>

#include "vsplit/bake/weights.hpp"

namespace vsplit::bake {
namespace {

constexpr std::uint32_t kNotThere = 0xFFFFFFFFu;  // MeshFile::kDropped

}  // namespace

Marks no_marks(std::size_t vertices) {
    Marks marks;
    marks.region.assign(vertices, 0);
    marks.strength.assign(vertices, 1.0f);
    return marks;
}

std::vector<float> weights_of(const Marks& marks, double automatic) {
    std::vector<float> weights(marks.region.size(), 1.0f);
    for (std::size_t v = 0; v < weights.size(); ++v) {
        const std::size_t number = marks.region[v];
        if (number == 0 || marks.strength[v] <= 0) continue;
        assert(number <= marks.regions.size());
        const double weight = marks.regions[number - 1].weight.value_or(automatic);
        weights[v] =
            marks.strength[v] >= 1 ? float(weight) : float(std::pow(weight, double(marks.strength[v])));
    }
    return weights;
}

Marks marks_of_mesh(const Marks& file_marks, std::span<const std::uint32_t> vertex_of, std::size_t vertices) {
    Marks marks = no_marks(vertices);
    marks.regions = file_marks.regions;
    for (std::size_t v = 0; v < file_marks.region.size(); ++v) {
        const std::uint32_t kept = vertex_of.empty() ? std::uint32_t(v) : vertex_of[v];
        if (kept == kNotThere || kept >= vertices || file_marks.region[v] == 0) continue;
        if (marks.region[kept] != 0 && marks.strength[kept] >= file_marks.strength[v]) continue;
        marks.region[kept] = file_marks.region[v];
        marks.strength[kept] = file_marks.strength[v];
    }
    return marks;
}

Marks marks_of_file(const Marks& marks, std::span<const std::uint32_t> vertex_of, std::size_t file_vertices) {
    Marks all = no_marks(file_vertices);
    all.regions = marks.regions;
    for (std::size_t v = 0; v < file_vertices; ++v) {
        const std::uint32_t kept = vertex_of.empty() ? std::uint32_t(v) : vertex_of[v];
        if (kept == kNotThere || kept >= marks.region.size()) continue;
        all.region[v] = marks.region[kept];
        all.strength[v] = marks.strength[kept];
    }
    return all;
}

}  // namespace vsplit::bake
