// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "ruler.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace vsplit::ruler {
namespace {

std::optional<Error> refusal(const Mesh& mesh) {
    const auto refuse = [](const char* why) { return Error{ErrorCode::kArgument, why, Error::kNowhere, 0}; };
    if (mesh.triangles.empty()) return refuse("no triangle to measure");
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) {
            if (v >= mesh.positions.size()) return refuse("a triangle names a vertex that is not there");
            const Float3& p = mesh.positions[v];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                return refuse("a corner is not finite");
        }
    return std::nullopt;
}

auto key(const Float3& p) {
    return std::tuple(p.x, p.y, p.z);
}

Triangle least_first(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

double box_diagonal(const Mesh& mesh) {
    Vec3 low = to_vec(mesh.positions[mesh.triangles[0][0]]), high = low;
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) {
            const Vec3 p = to_vec(mesh.positions[v]);
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    return length(high - low);
}

}  // namespace

Result<Ruler> Ruler::over(const Mesh& reference, const RulerOptions& options) {
    if (options.samples == 0)
        return Error{ErrorCode::kArgument, "no samples to measure with", Error::kNowhere, 0};
    if (auto error = refusal(reference)) return std::move(*error);
    return Ruler(reference, options);
}

Ruler::Ruler(const Mesh& reference, const RulerOptions& options)
    : reference_(reference), options_(options), tree_(reference_), diagonal_(box_diagonal(reference_)) {
    for (const Triangle& t : reference_.triangles)
        by_position_.insert(by_position_.end(), t.begin(), t.end());
    std::sort(by_position_.begin(), by_position_.end());
    by_position_.erase(std::unique(by_position_.begin(), by_position_.end()), by_position_.end());
    std::stable_sort(by_position_.begin(), by_position_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return key(reference_.positions[a]) < key(reference_.positions[b]);
    });
    sorted_triangles_.reserve(reference_.triangles.size());
    for (const Triangle& t : reference_.triangles) {
        Triangle corners;
        for (std::size_t k = 0; k < 3; ++k) corners[k] = reference_vertex(reference_.positions[t[k]]);
        sorted_triangles_.push_back(least_first(corners));
    }
    std::sort(sorted_triangles_.begin(), sorted_triangles_.end());
}

std::uint32_t Ruler::reference_vertex(Float3 position) const {
    const auto found = std::lower_bound(
        by_position_.begin(), by_position_.end(), position,
        [&](std::uint32_t v, const Float3& p) { return key(reference_.positions[v]) < key(p); });
    return found != by_position_.end() && reference_.positions[*found] == position ? *found : 0xFFFFFFFFu;
}

bool Ruler::in_reference(const Mesh& mesh, const Triangle& triangle) const {
    Triangle corners;
    for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = reference_vertex(mesh.positions[triangle[k]]);
        if (corners[k] == 0xFFFFFFFFu) return false;
    }
    return std::binary_search(sorted_triangles_.begin(), sorted_triangles_.end(), least_first(corners));
}

Result<Measurement> Ruler::measure(const Mesh& mesh) const {
    if (auto error = refusal(mesh)) return std::move(*error);
    Measurement m;
    const TriangleTree tree(mesh);
    m.from_reference = one_way(reference_, mesh, tree, options_.seed);
    m.to_reference = one_way(mesh, reference_, tree_, options_.seed + 7);
    m.mean = 0.5 * (m.from_reference.mean + m.to_reference.mean);
    m.rms = std::sqrt(
        0.5 * (m.from_reference.rms * m.from_reference.rms + m.to_reference.rms * m.to_reference.rms));
    m.max = std::max(m.from_reference.max, m.to_reference.max);
    m.normal_degrees = 0.5 * (m.from_reference.normal_degrees + m.to_reference.normal_degrees);
    m.shape = shape_of(mesh);
    return m;
}

Result<double> Ruler::max_distance(const Mesh& mesh) const {
    if (auto error = refusal(mesh)) return std::move(*error);
    const double there = one_way(reference_, mesh, TriangleTree(mesh), options_.seed).max;
    return std::max(there, one_way(mesh, reference_, tree_, options_.seed + 7).max);
}

}  // namespace vsplit::ruler
