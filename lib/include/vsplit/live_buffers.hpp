// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
// provisional
#pragma once
#include "vsplit/live_mesh.hpp"
namespace vsplit {
struct DirtyRanges { std::uint32_t vertices_begin = 0, vertices_end = 0, triangles_begin = 0, triangles_end = 0; };
class LiveBuffers {
  public:
    void begin(const ProgressiveMesh& m, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t) { mesh_ = m; live_ = LiveMesh(m); }
    void append(const ProgressiveMesh& m) { const auto l = live_.level(); mesh_ = m; live_ = LiveMesh(m); live_.go_to(l); }
    std::size_t level() const { return live_.level(); }
    std::size_t available() const { return live_.max_level(); }
    void refine(std::size_t n) { live_.go_to(level() + n); }
    void coarsen(std::size_t n) { live_.go_to(level() - std::min(n, level())); }
    void jump(std::size_t l) { live_.go_to(l); }
    std::uint32_t vertex_count() const { return std::uint32_t(positions().size()); }
    std::uint32_t triangle_count() const { return std::uint32_t(triangles().size()); }
    float error_at(std::size_t l) const { return float(vsplit::error_at(mesh_, l)); }
    std::size_t level_for_triangles(std::uint64_t n) const { return vsplit::level_for_triangles(mesh_, n); }
    std::size_t level_for_vertices(std::uint64_t n) const { return vsplit::level_for_vertices(mesh_, n); }
    std::size_t level_for_error(double e) const { return vsplit::level_for_error(mesh_, e); }
    std::span<const Float3> positions() const { return live_.positions(); }
    std::span<const Triangle> triangles() const { return live_.triangles(); }
    std::span<const float> weights() const { return live_.weights(); }
    std::span<const float> attribute(std::size_t i) const { const auto& a = live_.state().attributes[i]; return std::span(a.values).first(a.components * vertex_count()); }
    std::span<const std::uint32_t> groups() const { return mesh_.groups.empty() ? std::span<const std::uint32_t>{} : std::span(mesh_.groups).first(triangle_count()); }
    std::span<const std::uint32_t> parents() const { return std::span(mesh_.parents).first(vertex_count()); }
    std::span<const std::uint32_t> all_parents() const { return mesh_.parents; }
    DirtyRanges take_dirty() { return {0, vertex_count(), 0, triangle_count()}; }
  private:
    ProgressiveMesh mesh_;
    LiveMesh live_{ProgressiveMesh{}};
};
}  // namespace vsplit
