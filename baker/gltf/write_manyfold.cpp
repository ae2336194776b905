// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "container.hpp"
#include "fan_mesh.hpp"
#include "vsplit/bake/manyfold.hpp"

namespace vsplit::bake {
namespace {

using json = nlohmann::ordered_json;
using Place = std::array<double, 3>;

constexpr int kFloat = 5126, kUnsignedInt = 5125, kVertices = 34962, kIndices = 34963;

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}

Place place_of(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}
Float3 rounded(const Place& p) {
    return {float(p[0]), float(p[1]), float(p[2])};
}

struct Record {
    std::uint32_t vertex, left, right;
};

Split begin_of(const ProgressiveMesh& mesh, std::size_t split) {
    if (split > 0) return mesh.splits[split - 1];
    return {mesh.base_vertices, mesh.base_triangles, 0, 0, 0};
}

/// What the extension says of a split, if it can; the mesh is as before it.
std::optional<Record> record_of(const ProgressiveMesh& mesh, std::size_t split, const FanMesh& now) {
    const Split begin = begin_of(mesh, split), &end = mesh.splits[split];
    if (end.vertices_end != begin.vertices_end + 1) return std::nullopt;
    const std::uint32_t born = begin.vertices_end, vertex = mesh.parents[born];
    const std::uint32_t opened = end.triangles_end - begin.triangles_end;
    if (vertex == kNoVertex || opened < 1 || opened > 2) return std::nullopt;
    for (std::uint32_t m = begin.moves_end; m < end.moves_end; ++m)
        if (mesh.moves[m].vertex != vertex) return std::nullopt;
    Record record{vertex, kNoVertex, kNoVertex};
    for (std::uint32_t t = begin.triangles_end; t < end.triangles_end; ++t) {
        const Triangle& c = mesh.triangles[t];
        bool found = false;
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t* side = nullptr;
            if (c[k] == vertex && c[(k + 1) % 3] == born) side = &record.left;
            if (c[k] == born && c[(k + 1) % 3] == vertex) side = &record.right;
            if (side == nullptr) continue;
            if (*side != kNoVertex) return std::nullopt;
            *side = c[(k + 2) % 3];
            found = true;
        }
        if (!found) return std::nullopt;
    }
    const FanMesh::Goers goers = now.goers(vertex, record.left, record.right);
    std::vector<std::uint32_t> changed;
    for (std::uint32_t c = begin.corners_end; c < end.corners_end; ++c) {
        if (mesh.corner_changes[c].vertex != born) return std::nullopt;
        changed.push_back(mesh.corner_changes[c].corner / 3);
    }
    std::sort(changed.begin(), changed.end());
    if (goers.fault != nullptr || goers.triangles != changed) return std::nullopt;
    return record;
}

void apply(const ProgressiveMesh& mesh, std::size_t split, FanMesh& now) {
    const Split begin = begin_of(mesh, split), &end = mesh.splits[split];
    for (std::uint32_t v = begin.vertices_end; v < end.vertices_end; ++v) now.add_vertex();
    for (std::uint32_t c = begin.corners_end; c < end.corners_end; ++c)
        now.change(mesh.corner_changes[c].corner / 3, mesh.corner_changes[c].corner % 3,
                   mesh.corner_changes[c].vertex);
    for (std::uint32_t t = begin.triangles_end; t < end.triangles_end; ++t) now.add(mesh.triangles[t]);
}

/// The contents of the BIN chunk.
struct Contents {
    std::vector<std::byte> bytes;
    void put(const void* data, std::size_t size) {
        const auto* from = static_cast<const std::byte*>(data);
        bytes.insert(bytes.end(), from, from + size);
    }
};

Result<ManyfoldGlb> write(const ProgressiveMesh& mesh) {
    const std::size_t splits = mesh.splits.size();
    std::vector<Record> records(splits);
    std::size_t first = 0;
    {
        FanMesh now(std::span(mesh.triangles).first(mesh.base_triangles), mesh.base_vertices);
        for (std::size_t i = 0; i < splits; ++i) {
            if (const auto record = record_of(mesh, i, now))
                records[i] = *record;
            else
                first = i + 1;
            apply(mesh, i, now);
        }
    }
    if (first == splits)
        return fault(
            ErrorCode::kArgument,
            "no split at the fine end bears one vertex in a fan of triangles, as the extension wants");
    ManyfoldGlb out;
    out.left_out = first;
    out.records = splits - first;
    const Split base = begin_of(mesh, first);
    out.base_vertices = base.vertices_end;
    out.base_triangles = base.triangles_end;
    if (base.triangles_end == 0) return fault(ErrorCode::kArgument, "the base mesh would have no triangle");
    // Where everything ends, and from there back: halfway between the two.
    std::vector<Place> places(mesh.positions.size());
    for (std::size_t v = 0; v < places.size(); ++v) places[v] = place_of(mesh.positions[v]);
    for (const VertexMove& move : mesh.moves) places[move.vertex] = place_of(move.position);
    std::vector<Place> half(splits);
    for (std::size_t i = splits; i-- > first;) {
        Place& kept = places[records[i].vertex];
        const Place& born = places[begin_of(mesh, i).vertices_end];
        for (std::size_t c = 0; c < 3; ++c) {
            half[i][c] = 0.5 * (born[c] - kept[c]);
            kept[c] = 0.5 * (born[c] + kept[c]);
        }
    }
    std::vector<Triangle> triangles;
    {
        FanMesh now(std::span(mesh.triangles).first(mesh.base_triangles), mesh.base_vertices);
        for (std::size_t i = 0; i < first; ++i) apply(mesh, i, now);
        for (std::uint32_t t = 0; t < base.triangles_end; ++t) triangles.push_back(now.triangle(t));
    }
    Contents contents;
    contents.put(triangles.data(), triangles.size() * sizeof(Triangle));
    const std::size_t positions_at = contents.bytes.size();
    constexpr double kMost = std::numeric_limits<double>::infinity();
    Place low{kMost, kMost, kMost}, high{-kMost, -kMost, -kMost};
    for (std::uint32_t v = 0; v < base.vertices_end; ++v) {
        const Float3 p = rounded(places[v]);
        contents.put(&p, sizeof(p));
        const Place exact = place_of(p);
        for (std::size_t c = 0; c < 3; ++c) {
            low[c] = std::min(low[c], exact[c]);
            high[c] = std::max(high[c], exact[c]);
        }
    }
    const std::size_t records_at = contents.bytes.size();
    for (std::size_t i = first; i < splits; ++i) {
        Record record = records[i];
        // A side without a neighbour is said by the vertex itself.
        if (record.left == kNoVertex) record.left = record.vertex;
        if (record.right == kNoVertex) record.right = record.vertex;
        contents.put(&record, sizeof(record));
        const Float3 d = rounded(half[i]);
        contents.put(&d, sizeof(d));
    }
    constexpr std::size_t kStride = sizeof(Record) + sizeof(Float3);
    json document = {{"asset", {{"version", "2.0"}, {"generator", "vsplit"}}}};
    if (mesh.origin != std::array<double, 3>{}) document["asset"]["extras"] = {{"origin", mesh.origin}};
    document["extensionsUsed"] = {"MANYFOLD_mesh_progressive"};
    document["scene"] = 0;
    document["scenes"] = {{{"nodes", {0}}}};
    document["nodes"] = {{{"mesh", 0}}};
    const json extension = {{"attributes", {{"POSITION", 3}}}, {"indices", 2}};
    document["meshes"] = {{{"primitives",
                            {{{"attributes", {{"POSITION", 1}}},
                              {"indices", 0},
                              {"material", 0},
                              {"mode", 4},
                              {"extensions", {{"MANYFOLD_mesh_progressive", extension}}}}}}}};
    document["materials"] =
        json::array({{{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}},
                      {"doubleSided", true}}});
    document["accessors"] = {
        {{"bufferView", 0},
         {"componentType", kUnsignedInt},
         {"count", 3 * triangles.size()},
         {"type", "SCALAR"}},
        {{"bufferView", 1},
         {"componentType", kFloat},
         {"count", base.vertices_end},
         {"type", "VEC3"},
         {"min", low},
         {"max", high}},
        {{"bufferView", 2}, {"componentType", kUnsignedInt}, {"count", out.records}, {"type", "VEC3"}},
        {{"bufferView", 3}, {"componentType", kFloat}, {"count", out.records}, {"type", "VEC3"}}};
    document["bufferViews"] = {
        {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", positions_at}, {"target", kIndices}},
        {{"buffer", 0},
         {"byteOffset", positions_at},
         {"byteLength", records_at - positions_at},
         {"target", kVertices}},
        {{"buffer", 0},
         {"byteOffset", records_at},
         {"byteLength", out.records * kStride},
         {"byteStride", kStride},
         {"target", kVertices}},
        {{"buffer", 0},
         {"byteOffset", records_at + sizeof(Record)},
         {"byteLength", out.records * kStride - sizeof(Record)},
         {"byteStride", kStride},
         {"target", kVertices}}};
    document["buffers"] = json::array({{{"byteLength", contents.bytes.size()}}});
    auto sealed = seal_container(document.dump(), contents.bytes);
    if (!sealed.ok()) return sealed.error();
    out.bytes = std::move(*sealed);
    return out;
}

}  // namespace

Result<ManyfoldGlb> encode_manyfold(const ProgressiveMesh& mesh) {
    try {
        return write(mesh);
    } catch (const std::bad_alloc&) {
        return fault(ErrorCode::kLimit, "not enough memory for this GLB");
    }
}

}  // namespace vsplit::bake
