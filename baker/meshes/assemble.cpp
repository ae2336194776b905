// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>

#include "edge_table.hpp"
#include "triangulate.hpp"
#include "vsplit/bake/meshes.hpp"

namespace vsplit::bake {
namespace {

constexpr std::uint32_t kNone = MeshFile::kDropped;

bool finite(const Float3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

bool degenerate(const Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// A null pointer, or what the caller of assemble_mesh did wrong.
const char* soup_fault(const PolygonSoup& soup) {
    if (soup.positions.size() >= kNone) return "more than 4,294,967,294 vertices";
    if (soup.face_starts.empty() || soup.face_starts.front() != 0 ||
        soup.face_starts.back() != soup.corners.size())
        return "the faces do not add up";
    for (std::size_t f = 0; f + 1 < soup.face_starts.size(); ++f)
        if (soup.face_starts[f] > soup.face_starts[f + 1]) return "the faces do not add up";
    for (const std::uint32_t v : soup.corners)
        if (v >= soup.positions.size()) return "a face names a vertex that does not exist";
    if (!soup.weights.empty() && soup.weights.size() != soup.positions.size())
        return "there are not as many weights as vertices";
    return nullptr;
}

void triangulate(const PolygonSoup& soup, std::vector<Triangle>& triangles, MeshReport& report) {
    std::vector<std::uint8_t> bad(soup.positions.size());
    for (std::size_t v = 0; v < bad.size(); ++v) bad[v] = !finite(soup.positions[v]);
    triangles.reserve(soup.corners.size() / 3);
    Triangulator triangulator;
    for (std::size_t f = 0; f + 1 < soup.face_starts.size(); ++f) {
        const std::uint64_t n = soup.face_starts[f + 1] - soup.face_starts[f];
        const std::span<const std::uint32_t> corners(soup.corners.data() + soup.face_starts[f], n);
        if (n > 3) ++report.polygons_triangulated;
        if (n < 3) {
            ++report.faces_dropped_degenerate;
            continue;
        }
        if (std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return bad[v] != 0; }))
            report.faces_dropped_non_finite += n - 2;
        else
            triangulator.add(corners, soup.positions, triangles);
    }
}

/// Drops the triangles that name a vertex twice.
void drop_degenerate(std::vector<Triangle>& triangles, MeshReport& report) {
    report.faces_dropped_degenerate += std::erase_if(triangles, degenerate);
}

/// For every vertex the first one at the same position, itself where it is the first or not to be welded.
/// `candidates` empty: all are.
std::vector<std::uint32_t> weld_map(std::span<const Float3> positions,
                                    std::span<const std::uint8_t> candidates) {
    struct Key {
        std::uint32_t x, y, z;
        bool operator==(const Key&) const = default;
    };
    // -0 equals 0: adding 0 turns the one into the other and leaves every other value as it is.
    const auto key_of = [&](std::uint32_t v) {
        const Float3 p = positions[v];
        return Key{std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
                   std::bit_cast<std::uint32_t>(p.z + 0.0f)};
    };
    const std::size_t slots = std::bit_ceil(positions.size() * 2 + 1);
    std::vector<std::uint32_t> table(slots, kNone), first(positions.size());
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        first[v] = v;
        if (!candidates.empty() && candidates[v] == 0) continue;
        const Key key = key_of(v);
        std::uint64_t h =
            key.x * 0x9E3779B97F4A7C15ull ^ (std::uint64_t{key.y} << 32 | key.z) * 0xC2B2AE3D27D4EB4Full;
        h ^= h >> 32;
        h *= 0xD6E8FEB86659FD93ull;
        std::size_t slot = (h ^ h >> 32) & (slots - 1);
        while (table[slot] != kNone && !(key_of(table[slot]) == key)) slot = (slot + 1) & (slots - 1);
        if (table[slot] == kNone)
            table[slot] = v;
        else
            first[v] = table[slot];
    }
    return first;
}

std::vector<std::uint8_t> boundary_vertices(std::size_t vertices, std::span<const Triangle> triangles) {
    std::vector<std::uint8_t> on_boundary(vertices, 0);
    for_each_edge(vertices, triangles, [&](std::uint32_t a, std::uint32_t b, std::span<const EdgeUse> uses) {
        if (uses.size() == 1) on_boundary[a] = on_boundary[b] = 1;
    });
    return on_boundary;
}

}  // namespace

Result<MeshFile> assemble_mesh(PolygonSoup&& soup, Weld weld, MeshReport report) {
    if (const char* fault = soup_fault(soup)) return Error{ErrorCode::kMalformed, fault, Error::kNowhere, 0};
    if (soup.corners.size() / 3 > kMaxTriangles || soup.corners.size() > 3 * kMaxTriangles)
        return Error{ErrorCode::kLimit, "more than 1,431,655,765 triangles", Error::kNowhere, 0};
    report.vertices_in += soup.positions.size();
    report.faces_in += soup.face_starts.size() - 1;

    for (float& w : soup.weights)
        if (!(w >= 0)) {
            w = 0;
            ++report.weights_clamped;
        }

    Mesh mesh;
    triangulate(soup, mesh.triangles, report);
    soup.corners = {};
    soup.face_starts = {0};
    drop_degenerate(mesh.triangles, report);

    const std::size_t vertices = soup.positions.size();
    std::uint64_t welded = 0;
    std::vector<std::uint32_t> first;
    if (weld == Weld::kAuto) weld = Weld::kBoundary;
    if (weld != Weld::kNone) {
        std::vector<std::uint8_t> used(vertices, 0);
        if (weld == Weld::kBoundary)
            used = boundary_vertices(vertices, mesh.triangles);
        else
            for (const Triangle& t : mesh.triangles)
                for (const std::uint32_t v : t) used[v] = 1;
        first = weld_map(soup.positions, used);
        for (std::uint32_t v = 0; v < vertices; ++v) {
            if (first[v] == v) continue;
            ++welded;
            // What is marked on either side of a seam stays marked.
            if (!soup.weights.empty())
                soup.weights[first[v]] = std::max(soup.weights[first[v]], soup.weights[v]);
        }
        for (Triangle& t : mesh.triangles)
            for (std::uint32_t& v : t) v = first[v];
        drop_degenerate(mesh.triangles, report);
        report.vertices_dropped_unused -=
            report.vertices_welded;  // They are not used any more, but counted above.
    }
    if (mesh.triangles.empty()) {
        std::string message = "no triangle in it";
        if (report.faces_dropped_degenerate + report.faces_dropped_non_finite > 0)
            message += ": " + std::to_string(report.faces_dropped_degenerate) + " name a vertex twice, " +
                       std::to_string(report.faces_dropped_non_finite) + " have a corner that is not finite";
        return Error{ErrorCode::kMalformed, message, Error::kNowhere, 0};
    }

    std::vector<std::uint32_t> renumbered(vertices, kNone);
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) renumbered[v] = 0;
    std::uint32_t kept = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
        if (renumbered[v] == kNone) continue;
        renumbered[v] = kept;
        soup.positions[kept] = soup.positions[v];
        if (!soup.weights.empty()) soup.weights[kept] = soup.weights[v];
        ++kept;
    }
    report.vertices_welded += welded;
    report.vertices_dropped_unused += vertices - kept - welded;
    soup.positions.resize(kept);
    if (!soup.weights.empty()) soup.weights.resize(kept);
    for (Triangle& t : mesh.triangles)
        for (std::uint32_t& v : t) v = renumbered[v];
    mesh.positions = std::move(soup.positions);
    mesh.weights = std::move(soup.weights);

    MeshFile file{std::move(mesh), std::move(report)};
    if (kept < vertices) {
        for (std::uint32_t v = 0; v < first.size(); ++v)
            if (first[v] != v) renumbered[v] = renumbered[first[v]];
        file.vertex_of = std::move(renumbered);
    }
    return file;
}

}  // namespace vsplit::bake
