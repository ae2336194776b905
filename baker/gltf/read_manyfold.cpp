// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <new>

#include "accessor.hpp"
#include "container.hpp"
#include "document.hpp"
#include "fan_mesh.hpp"
#include "primitive.hpp"
#include "scene_document.hpp"
#include "vsplit/bake/manyfold.hpp"

namespace vsplit::bake {
namespace {

constexpr const char* kName = "MANYFOLD_mesh_progressive";
/// What triangles around split vertices may add up to: a record that splits a hub costs as much as the hub
/// has.
constexpr std::uint64_t kMostWork = std::uint64_t{1} << 31;

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}
Error malformed(const std::string& what) {
    return fault(ErrorCode::kMalformed, std::string(kName) + ": " + what);
}

struct Found {
    std::size_t mesh, primitive;
    const OrderedJson* extension;
};

/// The one primitive that has it, or whose mesh does, being its only one.
Result<std::optional<Found>> find(const OrderedJson& root) {
    std::optional<Found> found;
    const OrderedJson* meshes = member(root, "meshes");
    for (std::size_t m = 0; meshes != nullptr && meshes->is_array() && m < meshes->size(); ++m) {
        const OrderedJson* primitives = member((*meshes)[m], "primitives");
        if (primitives == nullptr || !primitives->is_array()) continue;
        const OrderedJson* of_mesh = extension_of((*meshes)[m], kName);
        for (std::size_t p = 0; p < primitives->size(); ++p) {
            const OrderedJson* own = extension_of((*primitives)[p], kName);
            if (own == nullptr) own = of_mesh;
            if (own == nullptr) continue;
            if (found)
                return fault(ErrorCode::kUnsupported,
                             std::string(kName) + ": more than one primitive has it");
            found = Found{m, p, own};
        }
    }
    return found;
}

std::optional<int> accessor_number(const OrderedJson& object, const char* key, std::size_t count) {
    const OrderedJson* value = member(object, key);
    if (value == nullptr || !value->is_number_unsigned() || value->get<std::uint64_t>() >= count)
        return std::nullopt;
    return value->get<int>();
}

/// Grows a progressive mesh record by record.
class Builder {
  public:
    Builder(const PrimitiveMesh& base, std::vector<Triangle> triangles)
        : now_(triangles, base.positions.size()), places_(base.positions) {
        mesh.base_vertices = std::uint32_t(base.positions.size());
        mesh.base_triangles = std::uint32_t(triangles.size());
        mesh.positions = base.positions;
        mesh.parents.assign(mesh.base_vertices, kNoVertex);
        mesh.triangles = std::move(triangles);
    }

    ProgressiveMesh mesh;

    /// Applies a record, or says why it does not fit.
    const char* add(std::uint32_t vertex, std::uint32_t left, std::uint32_t right, const Float3& d) {
        const std::size_t count = now_.vertices();
        if (vertex >= count || left >= count || right >= count) return "names a vertex that is not there yet";
        if (left == vertex) left = kNoVertex;
        if (right == vertex) right = kNoVertex;
        if (!std::isfinite(d.x) || !std::isfinite(d.y) || !std::isfinite(d.z))
            return "has a displacement that is no number";
        if (count >= kNoVertex - 1) return "would make more vertices than 32 bits can name";
        work_ += now_.around(vertex) + 1;
        if (work_ > kMostWork) return "splits vertices of too many triangles";
        const FanMesh::Goers goers = now_.goers(vertex, left, right);
        if (goers.fault != nullptr) return goers.fault;
        const Float3 at = places_[vertex];
        const Float3 born{at.x + d.x, at.y + d.y, at.z + d.z}, kept{at.x - d.x, at.y - d.y, at.z - d.z};
        for (const Float3& p : {born, kept})
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                return "moves a vertex beyond all numbers";
        const std::uint32_t fresh = now_.add_vertex();
        mesh.positions.push_back(born);
        mesh.parents.push_back(vertex);
        places_.push_back(born);
        places_[vertex] = kept;
        mesh.moves.push_back({vertex, kept, 1});
        for (const std::uint32_t t : goers.triangles) {
            const Triangle& c = now_.triangle(t);
            const std::size_t k = c[0] == vertex ? 0 : c[1] == vertex ? 1 : 2;
            mesh.corner_changes.push_back({std::uint32_t(3 * t + k), fresh});
            now_.change(t, k, fresh);
        }
        const auto open = [&](const Triangle& t) {
            now_.add(t);
            mesh.triangles.push_back(t);
        };
        if (left != kNoVertex) open({vertex, fresh, left});
        if (right != kNoVertex) open({fresh, vertex, right});
        mesh.splits.push_back({std::uint32_t(mesh.positions.size()), std::uint32_t(mesh.triangles.size()),
                               std::uint32_t(mesh.corner_changes.size()), std::uint32_t(mesh.moves.size()),
                               float(std::sqrt(double(d.x) * d.x + double(d.y) * d.y + double(d.z) * d.z))});
        return nullptr;
    }

    /// From the lengths of displacements to bounds: how far the vertices that a vertex stands for can be.
    void bound_errors() {
        std::vector<double> reach(mesh.positions.size(), 0);
        double most = 0;
        for (std::size_t i = mesh.splits.size(); i-- > 0;) {
            const std::uint32_t born = mesh.splits[i].vertices_end - 1;
            double& parent = reach[mesh.parents[born]];
            parent = std::max(parent, reach[born]) + double(mesh.splits[i].error);
            most = std::max(most, parent);
            mesh.splits[i].error = float(std::min(most, double(std::numeric_limits<float>::max())));
        }
    }

  private:
    FanMesh now_;
    std::vector<Float3> places_;
    std::uint64_t work_ = 0;
};

Result<std::optional<ManyfoldFile>> read(std::span<const std::byte> bytes, const std::string& folder) {
    const auto container = open_container(bytes);
    if (!container.ok()) return container.error();
    if (container->json.find(kName) == container->json.npos) return std::optional<ManyfoldFile>();
    auto document = Document::parse(bytes, folder);
    if (!document.ok()) return document.error();
    const OrderedJson root = OrderedJson::parse(container->json);
    const auto found = find(root);
    if (!found.ok()) return found.error();
    if (!*found) return std::optional<ManyfoldFile>();
    const auto& [m, p, extension] = **found;
    const tinygltf::Primitive& primitive = document->model.meshes[m].primitives[p];
    const std::size_t accessors = document->model.accessors.size();
    const OrderedJson* attributes = member(*extension, "attributes");
    const auto position =
        attributes == nullptr ? std::nullopt : accessor_number(*attributes, "POSITION", accessors);
    const auto indices = accessor_number(*extension, "indices", accessors);
    if (!position || !indices) return malformed("it needs indices and attributes.POSITION");
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES) return malformed("the base mesh is no list of triangles");
    auto base = read_primitive(*document, m, p, {}, std::uint64_t{1} << 26);
    if (!base.ok()) return base.error();
    // Records number the vertices as the file lists them.
    if (base->used.size() != base->listed)
        return malformed("the base mesh has vertices that no triangle uses");
    std::vector<Triangle> triangles;
    for (std::size_t c = 0; c + 2 < base->corners.size(); c += 3) {
        const Triangle t{base->corners[c], base->corners[c + 1], base->corners[c + 2]};
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
            return malformed("a triangle of the base mesh names a vertex twice");
        triangles.push_back(t);
    }
    for (const Float3& place : base->positions)
        if (!std::isfinite(place.x) || !std::isfinite(place.y) || !std::isfinite(place.z))
            return malformed("a vertex of the base mesh has a place that is no number");
    auto splits = AccessorReader::open(*document, *indices, std::string(kName) + ".indices");
    if (!splits.ok()) return splits.error();
    auto displacements = AccessorReader::open(*document, *position, std::string(kName) + ".POSITION");
    if (!displacements.ok()) return displacements.error();
    const bool whole = splits->component_type() == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                       splits->component_type() == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                       splits->component_type() == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (splits->type() != TINYGLTF_TYPE_VEC3 || !whole || displacements->type() != TINYGLTF_TYPE_VEC3)
        return malformed("records are three unsigned integers and three numbers");
    if (splits->count() != displacements->count())
        return malformed("there are not as many displacements as splits");
    ManyfoldFile out;
    out.records = splits->count();
    Builder builder(*base, std::move(triangles));
    for (; out.read < out.records; ++out.read) {
        float d[3];
        displacements->read(out.read, d);
        const char* what = builder.add(splits->integer(out.read, 0), splits->integer(out.read, 1),
                                       splits->integer(out.read, 2), {d[0], d[1], d[2]});
        if (what == nullptr) continue;
        out.fault = what;
        break;
    }
    builder.bound_errors();
    out.mesh = std::move(builder.mesh);
    if (const char* what = progressive_mesh_fault(out.mesh)) return malformed(what);
    return std::optional(std::move(out));
}

}  // namespace

Result<std::optional<ManyfoldFile>> parse_manyfold(std::span<const std::byte> bytes,
                                                   const std::string& folder) {
    try {
        return read(bytes, folder);
    } catch (const std::bad_alloc&) {
        return fault(ErrorCode::kLimit, "not enough memory for this scene");
    } catch (const std::exception& error) {
        return fault(ErrorCode::kMalformed, std::string("glTF: ") + error.what());
    }
}

}  // namespace vsplit::bake
