// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "level_geometry.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "attribute_set.hpp"
#include "compress.hpp"
#include "normals.hpp"

namespace vsplit::bake {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

bool within(const std::vector<float>& values, float least, float most) {
    return std::all_of(values.begin(), values.end(), [&](float v) { return v >= least && v <= most; });
}

/// The types that glTF 2.0 itself allows (section 3.7.2.1 and .2).
bool in_core(const VertexValues& values) {
    const std::uint32_t type = values.stored.component_type;
    switch (values.semantic) {
        case Semantic::kNormal:
        case Semantic::kTangent:
        case Semantic::kMorphOffset:
        case Semantic::kMorphNormal:
        case Semantic::kMorphTangent:
            return type == kFloat;
        case Semantic::kTexcoord:
            return type == kFloat || (values.stored.normalised && type % 2 == 1);
        default:
            return values.name != "POSITION" || type == kFloat;
    }
}

}  // namespace

std::vector<PrimitiveCut> split_by_group(const Mesh& mesh, std::size_t groups) {
    std::vector<PrimitiveCut> out(groups);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        auto& corners = out[mesh.groups.empty() ? 0 : mesh.groups[t]].corners;
        corners.insert(corners.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
    }
    std::vector<std::uint32_t> number(mesh.positions.size(), kNone);
    for (PrimitiveCut& cut : out) {
        for (const std::uint32_t v : cut.corners)
            if (number[v] == kNone) number[v] = 0, cut.vertices.push_back(v);
        std::sort(cut.vertices.begin(), cut.vertices.end());
        for (std::uint32_t i = 0; i < cut.vertices.size(); ++i) number[cut.vertices[i]] = i;
        for (std::uint32_t& v : cut.corners) v = number[v];
        for (const std::uint32_t v : cut.vertices) number[v] = kNone;
    }
    return out;
}

void order_for_cache(PrimitiveCut& cut) {
    const std::size_t vertices = cut.vertices.size(), corners = cut.corners.size();
    std::vector<std::uint32_t> ordered(corners), place(vertices);
    meshopt_optimizeVertexCache(ordered.data(), cut.corners.data(), corners, vertices);
    meshopt_optimizeVertexFetchRemap(place.data(), ordered.data(), corners, vertices);
    for (std::size_t i = 0; i < corners; ++i) cut.corners[i] = place[ordered[i]];
    std::vector<std::uint32_t> moved(vertices);
    for (std::size_t v = 0; v < vertices; ++v) moved[place[v]] = cut.vertices[v];
    cut.vertices = std::move(moved);
}

PrimitiveWriter::PrimitiveWriter(const Scene& scene, const SceneFormat& format, GeometrySink& sink)
    : scene_(scene), format_(format), sink_(sink) {
    std::size_t meshes = 0;
    for (const ScenePart& part : scene.parts) meshes = std::max<std::size_t>(meshes, part.mesh + 1);
    boxes_.resize(meshes);
    grids_.resize(meshes);
    exponents_.assign(meshes, 0);
    for (const ScenePart& part : scene.parts) exponents_[part.mesh] = part.exponent;
}

void PrimitiveWriter::set_boxes(std::span<const GltfLevel> levels) {
    struct Range {
        double least = std::numeric_limits<double>::infinity(), most = -least;
        void add(double v) { least = std::min(least, v), most = std::max(most, v); }
    };
    std::vector<std::array<Range, 3>> ranges(boxes_.size());
    std::vector<double> offsets(boxes_.size(), 0);
    for (const GltfLevel& level : levels) {
        const Mesh& mesh = level.mesh;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const std::size_t m = scene_.primitives[mesh.groups.empty() ? 0 : mesh.groups[t]].mesh;
            const int back = -exponents_[m];
            for (const std::uint32_t v : mesh.triangles[t]) {
                const Float3& p = mesh.positions[v];
                ranges[m][0].add(double(std::ldexp(p.x, back)));
                ranges[m][1].add(double(std::ldexp(p.y, back)));
                ranges[m][2].add(double(std::ldexp(p.z, back)));
                if (!format_.quantised) continue;
                for (const Attribute& attribute : mesh.attributes)
                    if (attribute.semantic == Semantic::kMorphOffset)
                        for (std::size_t c = 0; c < 3; ++c)
                            offsets[m] = std::max(
                                offsets[m], double(std::fabs(std::ldexp(attribute.values[3 * v + c], back))));
            }
        }
    }
    for (std::size_t m = 0; m < boxes_.size(); ++m) {
        if (!(ranges[m][0].least <= ranges[m][0].most)) continue;
        Grid grid;
        grid.scale = offsets[m];
        for (std::size_t c = 0; c < 3; ++c) {
            grid.offset[c] = ranges[m][c].least;
            grid.scale = std::max(grid.scale, ranges[m][c].most - ranges[m][c].least);
        }
        if (!(grid.scale > 0)) grid.scale = 1;
        boxes_[m] = grid;
    }
}

std::vector<VertexValues> PrimitiveWriter::gather(const Mesh& level, std::size_t group,
                                                  const PrimitiveCut& cut) const {
    const ScenePrimitive& primitive = scene_.primitives[group];
    const int back = -exponents_[primitive.mesh];
    std::vector<VertexValues> out(1);
    out[0].name = "POSITION";
    out[0].stored = primitive.position;
    out[0].stored.type = "VEC3";
    out[0].components = 3;
    out[0].values.reserve(cut.vertices.size() * 3);
    for (const std::uint32_t v : cut.vertices) {
        const Float3& p = level.positions[v];
        for (const float value : {p.x, p.y, p.z}) out[0].values.push_back(std::ldexp(value, back));
    }
    for (const StoredAttribute& stored : primitive.attributes) {
        const Attribute& from = level.attributes[stored.attribute];
        VertexValues values{from.name, semantic_of(from.name), stored, components_of_name(stored.type), {}};
        const int shift = values.semantic == Semantic::kMorphOffset ? back : 0;
        values.values.reserve(cut.vertices.size() * values.components);
        for (const std::uint32_t v : cut.vertices)
            for (std::uint32_t c = 0; c < values.components; ++c) {
                const float value = from.values[std::size_t{v} * from.components + c];
                values.values.push_back(shift == 0 ? value : std::ldexp(value, shift));
            }
        out.push_back(std::move(values));
    }
    return out;
}

void PrimitiveWriter::choose_types(std::vector<VertexValues>& attributes,
                                   const std::optional<Grid>& grid) const {
    const auto to = [](VertexValues& values, std::uint32_t type) {
        values.stored.component_type = type;
        values.stored.normalised = true;
    };
    for (VertexValues& values : attributes) {
        const bool is_float = values.stored.component_type == kFloat;
        if (values.name == "POSITION" && grid) {
            for (std::size_t i = 0; i < values.values.size(); ++i)
                values.values[i] = float((double(values.values[i]) - grid->offset[i % 3]) / grid->scale);
            to(values, kUnsignedShort);
        } else if (values.semantic == Semantic::kMorphOffset && grid) {
            for (float& value : values.values) value = float(double(value) / grid->scale);
            to(values, kShort);
        } else if (values.semantic == Semantic::kJointWeights && is_float &&
                   (format_.quantised || format_.draco)) {
            to(values, kUnsignedShort);
        } else if (is_float && format_.quantised) {
            if (values.semantic == Semantic::kNormal || values.semantic == Semantic::kTangent)
                to(values, kByte);
            if (values.semantic == Semantic::kTexcoord && within(values.values, 0, 1))
                to(values, kUnsignedShort);
            if (values.semantic == Semantic::kColor) to(values, kUnsignedShort);
            if ((values.semantic == Semantic::kMorphNormal || values.semantic == Semantic::kMorphTangent) &&
                within(values.values, -1, 1))
                to(values, kShort);
        }
    }
}

void PrimitiveWriter::note_type(const VertexValues& values) {
    beyond_core_ = beyond_core_ || !in_core(values);
}

void PrimitiveWriter::name_accessor(OrderedJson& primitive, const VertexValues& values,
                                    std::size_t accessor) const {
    const auto slash = values.name.find('/');
    if (slash == values.name.npos)
        primitive["attributes"][values.name] = accessor;
    else
        primitive["targets"][std::stoul(values.name.substr(0, slash))][values.name.substr(slash + 1)] =
            accessor;
}

Status PrimitiveWriter::write(const Mesh& level, std::size_t group, const PrimitiveCut& cut,
                              OrderedJson& primitive) {
    const ScenePrimitive& source = scene_.primitives[group];
    std::vector<VertexValues> attributes = gather(level, group, cut);
    std::vector<Float3> fallback;
    const bool directed = std::any_of(attributes.begin(), attributes.end(), [](const VertexValues& v) {
        return v.semantic == Semantic::kNormal || v.semantic == Semantic::kTangent;
    });
    if (directed) {
        Mesh part;
        for (const std::uint32_t v : cut.vertices) part.positions.push_back(level.positions[v]);
        for (std::size_t c = 0; c < cut.corners.size(); c += 3)
            part.triangles.push_back({cut.corners[c], cut.corners[c + 1], cut.corners[c + 2]});
        fallback = smooth_normals(part);
    }
    make_lawful(attributes, fallback);
    choose_types(attributes, grids_[source.mesh]);
    round_joint_weights(attributes);
    primitive["attributes"] = OrderedJson::object();
    if (source.targets > 0)
        primitive["targets"] = OrderedJson::array_t(source.targets, OrderedJson::object());
    if (format_.draco) return write_draco(attributes, source.mesh, cut, primitive);
    for (const VertexValues& values : attributes) {
        note_type(values);
        const bool bounds = values.name == "POSITION" || values.semantic == Semantic::kMorphOffset;
        name_accessor(primitive, values, sink_.add_vertices(pack(values), bounds));
    }
    primitive["indices"] = sink_.add_indices(cut.corners, cut.vertices.size());
    return Ok{};
}

Status PrimitiveWriter::write_draco(std::vector<VertexValues>& attributes, std::size_t mesh,
                                    const PrimitiveCut& cut, OrderedJson& primitive) {
    // Morph targets and matrices stay outside of Draco, whose vertices must then keep their order.
    const auto outside = [](const VertexValues& values) {
        return values.name.find('/') != values.name.npos || values.stored.type.starts_with("MAT") ||
               values.stored.component_type == kUnsignedInt;
    };
    std::vector<PackedValues> packed;
    std::vector<const VertexValues*> inside;
    bool keep_order = false;
    for (const VertexValues& values : attributes) {
        note_type(values);
        if (outside(values)) {
            keep_order = true;
            continue;
        }
        packed.push_back(pack(values));
        inside.push_back(&values);
    }
    const Grid& box = *boxes_[mesh];
    auto stream = encode_draco(inside, packed, cut.corners, box, keep_order);
    if (!stream.ok()) return stream.error();
    OrderedJson ids = OrderedJson::object();
    for (std::size_t i = 0; i < inside.size(); ++i) {
        const bool bounds = inside[i]->name == "POSITION";
        const std::vector<double> none;
        name_accessor(primitive, *inside[i],
                      sink_.add_promise(packed[i].stored, stream->vertices, bounds ? stream->min : none,
                                        bounds ? stream->max : none));
        ids[inside[i]->name] = stream->ids[i];
    }
    for (const VertexValues& values : attributes)
        if (outside(values))
            name_accessor(primitive, values,
                          sink_.add_vertices(pack(values), values.semantic == Semantic::kMorphOffset));
    StoredAttribute indices;
    indices.type = "SCALAR";
    indices.component_type = stream->vertices <= 65535 ? kUnsignedShort : kUnsignedInt;
    primitive["indices"] = sink_.add_promise(indices, stream->corners, {}, {});
    primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", sink_.add_view(stream->bytes)},
                                                             {"attributes", std::move(ids)}};
    return Ok{};
}

}  // namespace vsplit::bake
