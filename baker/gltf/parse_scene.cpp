// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <new>

#include "attribute_set.hpp"
#include "document.hpp"
#include "primitive.hpp"
#include "scene_document.hpp"
#include "scene_nodes.hpp"
#include "scene_poses.hpp"
#include "vsplit/bake/scene.hpp"
#include "weight_channel.hpp"

namespace vsplit::bake {
namespace {

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}

/// Rows of 32-bit words that agree in every bit become one, the first.
class RowMerger {
  public:
    explicit RowMerger(std::size_t rows) {
        std::size_t size = 16;
        while (size < rows * 2) size *= 2;
        table_.assign(size, kNone);
    }

    /// The number of the row's first copy: `next` if there is none.
    template <class Same>
    std::uint32_t find(std::uint64_t hash, std::uint32_t next, Same same) {
        for (std::size_t at = hash & (table_.size() - 1);; at = (at + 1) & (table_.size() - 1)) {
            if (table_[at] == kNone) return table_[at] = next;
            if (same(table_[at])) return table_[at];
        }
    }

  private:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> table_;
};

/// One primitive's vertices as rows: position, attributes, weight.
class Rows {
  public:
    explicit Rows(const PrimitiveMesh& primitive) : primitive_(primitive) {}

    std::uint64_t hash(std::uint32_t v) const {
        std::uint64_t hash = 0x9E3779B97F4A7C15u;
        each(v, [&](float value) {
            hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x2545F4914F6CDD1Du;
            hash ^= hash >> 29;
        });
        return hash;
    }
    bool same(std::uint32_t a, std::uint32_t b) const {
        if (std::memcmp(&primitive_.positions[a], &primitive_.positions[b], sizeof(Float3)) != 0)
            return false;
        if (primitive_.has_weights &&
            std::memcmp(&primitive_.weights[a], &primitive_.weights[b], sizeof(float)) != 0)
            return false;
        for (const PrimitiveAttribute& attribute : primitive_.attributes) {
            const auto n = std::size_t(components_of(attribute.type));
            if (std::memcmp(attribute.values.data() + n * a, attribute.values.data() + n * b,
                            n * sizeof(float)) != 0)
                return false;
        }
        return true;
    }

  private:
    template <class Each>
    void each(std::uint32_t v, Each use) const {
        const Float3& p = primitive_.positions[v];
        use(p.x), use(p.y), use(p.z);
        if (primitive_.has_weights) use(primitive_.weights[v]);
        for (const PrimitiveAttribute& attribute : primitive_.attributes) {
            const auto n = std::size_t(components_of(attribute.type));
            for (std::size_t c = 0; c < n; ++c) use(attribute.values[n * v + c]);
        }
    }
    const PrimitiveMesh& primitive_;
};

bool finite(const Float3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// The exponent of the scale, if every coordinate can be scaled by it and back without a change.
int exponent_for(double scale, const std::vector<PrimitiveMesh>& primitives) {
    if (!(scale > 0) || !std::isfinite(scale)) return 0;
    const int exponent = std::clamp(std::ilogb(scale), -100, 100);
    const auto exact = [&](float value) {
        return !std::isfinite(value) || std::ldexp(std::ldexp(value, exponent), -exponent) == value;
    };
    for (const PrimitiveMesh& primitive : primitives) {
        for (const Float3& p : primitive.positions)
            if (!exact(p.x) || !exact(p.y) || !exact(p.z)) return 0;
        for (const PrimitiveAttribute& attribute : primitive.attributes)
            if (semantic_of(attribute.name) == Semantic::kMorphOffset)
                for (const float value : attribute.values)
                    if (!exact(value)) return 0;
    }
    return exponent;
}

class SceneReader {
  public:
    SceneReader(Document& document, const GltfOptions& options)
        : document_(document),
          options_(options),
          left_(options.max_triangles),
          values_left_(options.max_attribute_values) {}

    Scene scene;
    TakenPrimitives taken;

    Status read(const SceneUse& use, const WeightChannel& channel) {
        const auto& meshes = document_.model.meshes;
        for (std::size_t m = 0; m < meshes.size(); ++m) {
            if (use.mesh_used[m] == 0) continue;
            Part part{std::uint32_t(m), use.mesh_scale[m], {}};
            for (std::size_t p = 0; p < meshes[m].primitives.size(); ++p)
                if (Status status = read_one(m, p, channel, part); !status.ok()) return status;
            if (!part.primitives.empty()) parts_.push_back(std::move(part));
        }
        if (Status status = name_attributes(); !status.ok()) return status;
        for (Part& part : parts_) append(part);
        if (scene.mesh.triangles.empty()) return fault(ErrorCode::kMalformed, "the scene has no triangle");
        if (!any_weights_) scene.mesh.weights.clear();
        if (dropped_values_ > 0)
            scene.notes.push_back(std::to_string(dropped_values_) +
                                  " attribute values that are no finite numbers, read as 0");
        return Ok{};
    }
    bool any_weights() const { return any_weights_; }

    void measure(const SceneUse& use) {
        struct Box {
            double least[3], most[3];
            Box() {
                std::fill(least, least + 3, std::numeric_limits<double>::infinity());
                std::fill(most, most + 3, -std::numeric_limits<double>::infinity());
            }
            void add(std::size_t c, double value) {
                least[c] = std::min(least[c], value);
                most[c] = std::max(most[c], value);
            }
        };
        std::vector<Box> boxes(use.mesh_used.size());
        for (const ScenePart& part : scene.parts)
            for (std::uint32_t v = part.first_vertex; v < part.end_vertex; ++v) {
                const Float3& p = scene.mesh.positions[v];
                const double xyz[3] = {double(p.x), double(p.y), double(p.z)};
                for (std::size_t c = 0; c < 3; ++c)
                    boxes[part.mesh].add(c, std::ldexp(xyz[c], -part.exponent));
            }
        Box world;
        for (const SceneUse::Place& place : use.places) {
            const Box& box = boxes[place.mesh];
            for (std::size_t corner = 0; corner < 8; ++corner)
                for (std::size_t c = 0; c < 3; ++c) {
                    const auto side = [&](std::size_t axis) {
                        return (corner >> axis & 1) != 0 ? box.most[axis] : box.least[axis];
                    };
                    const Matrix& m = place.matrix;
                    const double value = m[c] * side(0) + m[4 + c] * side(1) + m[8 + c] * side(2) + m[12 + c];
                    if (std::isfinite(value)) world.add(c, value);
                }
        }
        double square = 0;
        for (std::size_t c = 0; c < 3; ++c)
            if (world.most[c] > world.least[c])
                square += (world.most[c] - world.least[c]) * (world.most[c] - world.least[c]);
        scene.radius = 0.5 * std::sqrt(square);
    }

  private:
    struct Part {
        std::uint32_t mesh;
        double scale;
        std::vector<PrimitiveMesh> primitives;
    };

    Status read_one(std::size_t m, std::size_t p, const WeightChannel& channel, Part& part) {
        const tinygltf::Primitive& source = document_.model.meshes[m].primitives[p];
        const std::string name = object_name("meshes", m) + "." + object_name("primitives", p);
        if (!is_triangles(source)) {
            if (source.mode < 0 || source.mode > TINYGLTF_MODE_TRIANGLE_FAN)
                return fault(ErrorCode::kMalformed,
                             name + ".mode " + std::to_string(source.mode) + " is not one of glTF's");
            ++points_and_lines_;
            return Ok{};
        }
        // An attribute of as many values as are left is a hair too long: 0 would mean that none are wanted.
        auto read = read_primitive(document_, m, p, channel, left_, values_left_ + 1);
        if (!read.ok()) return read.error();
        if (read->corners.empty() && read->listed == 0) return Ok{};  // positions from an unknown extension
        left_ -= read->corners.size() / 3;
        vertices_ += read->positions.size();
        if (vertices_ >= std::numeric_limits<std::uint32_t>::max())
            return fault(ErrorCode::kLimit, "the scene has more vertices than a 32-bit index can name");
        std::uint64_t values = 0;
        for (const PrimitiveAttribute& attribute : read->attributes) {
            values += attribute.values.size();
            if (Status status = set_.add(attribute.name, attribute.type, name); !status.ok()) return status;
        }
        if (values > values_left_) return fault(ErrorCode::kLimit, name + ": too many attribute values");
        values_left_ -= values;
        scene.report.vertices_in += read->listed;
        scene.report.vertices_dropped_unused += read->listed - read->used.size();
        scene.report.faces_in += read->corners.size() / 3;
        any_weights_ = any_weights_ || read->has_weights;
        taken.insert({m, p});
        ScenePrimitive made;
        made.mesh = std::uint32_t(m);
        made.primitive = std::uint32_t(p);
        made.targets = std::uint32_t(source.targets.size());
        made.position.component_type = std::uint32_t(read->position_type);
        made.position.normalised = read->position_normalised;
        scene.primitives.push_back(std::move(made));
        read->used = {};
        part.primitives.push_back(std::move(*read));
        return Ok{};
    }

    Status name_attributes() {
        scene.mesh.attributes = set_.order();
        const std::uint64_t components = set_.components();
        if (components > 0 && vertices_ > options_.max_attribute_values / components)
            return fault(ErrorCode::kLimit, "the scene's " + std::to_string(scene.mesh.attributes.size()) +
                                                " attributes of " + std::to_string(vertices_) +
                                                " vertices are more values than the limit");
        return Ok{};
    }

    void append(Part& part) {
        const int exponent = exponent_for(part.scale, part.primitives);
        const auto number = static_cast<std::uint32_t>(scene.parts.size());
        if (const double unit = std::ldexp(part.scale, -exponent); std::isfinite(unit))
            scene.unit = std::max(scene.unit, unit);
        ScenePart made{part.mesh, exponent, std::uint32_t(scene.mesh.positions.size()), 0};
        for (PrimitiveMesh& primitive : part.primitives) {
            append(primitive, next_primitive_++, exponent);
            primitive = {};
        }
        made.end_vertex = std::uint32_t(scene.mesh.positions.size());
        scene.part_of.resize(made.end_vertex, number);
        scene.parts.push_back(made);
    }

    void append(const PrimitiveMesh& primitive, std::size_t group, int exponent) {
        // Triangles first: only what they name is kept.
        std::vector<std::uint32_t> corners;
        const Rows rows(primitive);
        const std::size_t count = primitive.positions.size();
        RowMerger merger(count);
        std::vector<std::uint32_t> first(count);
        for (std::uint32_t v = 0; v < count; ++v) {
            first[v] = merger.find(rows.hash(v), v, [&](std::uint32_t other) { return rows.same(v, other); });
            scene.report.vertices_welded += first[v] != v;
        }
        std::vector<std::uint8_t> named(count, 0);
        for (std::size_t c = 0; c < primitive.corners.size(); c += 3) {
            std::uint32_t t[3];
            for (std::size_t i = 0; i < 3; ++i) t[i] = first[primitive.corners[c + i]];
            if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
                ++scene.report.faces_dropped_degenerate;
                continue;
            }
            if (!finite(primitive.positions[t[0]]) || !finite(primitive.positions[t[1]]) ||
                !finite(primitive.positions[t[2]])) {
                ++scene.report.faces_dropped_non_finite;
                continue;
            }
            for (const std::uint32_t v : t) named[v] = 1, corners.push_back(v);
        }
        const std::vector<std::uint32_t> kept = append_vertices(primitive, named, group, exponent);
        for (std::size_t c = 0; c < corners.size(); c += 3)
            scene.mesh.triangles.push_back({kept[corners[c]], kept[corners[c + 1]], kept[corners[c + 2]]});
        scene.mesh.groups.resize(scene.mesh.triangles.size(), std::uint32_t(group));
    }

    /// The numbers in the scene's mesh.
    std::vector<std::uint32_t> append_vertices(const PrimitiveMesh& primitive,
                                               const std::vector<std::uint8_t>& named, std::size_t group,
                                               int exponent) {
        Mesh& mesh = scene.mesh;
        const std::size_t count = named.size();
        std::vector<std::uint32_t> number(count, 0), kept;
        for (std::uint32_t v = 0; v < count; ++v) {
            if (named[v] == 0) continue;
            number[v] = std::uint32_t(mesh.positions.size());
            kept.push_back(v);
            const Float3& p = primitive.positions[v];
            mesh.positions.push_back(
                {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)});
            float weight = primitive.has_weights ? primitive.weights[v] : 1.0f;
            if (!(weight >= 0)) weight = 0, ++scene.report.weights_clamped;
            mesh.weights.push_back(weight);
        }
        for (Attribute& attribute : mesh.attributes)
            attribute.values.resize(mesh.positions.size() * attribute.components, 0.0f);
        const std::size_t base = mesh.positions.size() - kept.size();
        for (const PrimitiveAttribute& from : primitive.attributes) {
            const std::uint32_t n = set_.number_of(from.name);
            Attribute& to = mesh.attributes[n];
            const auto components = std::size_t(components_of(from.type));
            const int shift = to.semantic == Semantic::kMorphOffset ? exponent : 0;
            for (std::size_t i = 0; i < kept.size(); ++i) {
                float* out = to.values.data() + (base + i) * to.components;
                for (std::size_t c = 0; c < components; ++c) {
                    float value = from.values[kept[i] * components + c];
                    if (!std::isfinite(value)) value = 0, ++dropped_values_;
                    out[c] = shift == 0 ? value : std::ldexp(value, shift);
                }
                if (to.semantic == Semantic::kColor && components == 3 && to.components == 4) out[3] = 1;
            }
            scene.primitives[group].attributes.push_back(
                {n, type_name(from.type), std::uint32_t(from.component_type), from.normalised});
        }
        auto& stored = scene.primitives[group].attributes;
        std::sort(stored.begin(), stored.end(), [](const StoredAttribute& a, const StoredAttribute& b) {
            return a.attribute < b.attribute;
        });
        return number;
    }

    Document& document_;
    const GltfOptions& options_;
    std::uint64_t left_, values_left_, vertices_ = 0, points_and_lines_ = 0, dropped_values_ = 0;
    std::size_t next_primitive_ = 0;
    bool any_weights_ = false;
    AttributeSet set_;
    std::vector<Part> parts_;
};

Result<Scene> read_whole(std::span<const std::byte> bytes, const std::string& folder,
                         const GltfOptions& options) {
    auto channel = weight_channel(options.weight_channel);
    if (!channel.ok()) return channel.error();
    auto document = Document::parse(bytes, folder);
    if (!document.ok()) return document.error();
    const auto use = survey_nodes(*document);
    if (!use.ok()) return use.error();
    SceneReader reader(*document, options);
    if (Status status = reader.read(*use, *channel); !status.ok()) return status.error();
    if (!options.weight_channel.empty() && !reader.any_weights())
        return fault(ErrorCode::kArgument, "no primitive of the scene has the weight channel " +
                                               options.weight_channel + "; its attributes are " +
                                               attributes_there(document->model));
    reader.measure(*use);
    const auto instances = place_meshes(*document);
    if (!instances.ok()) return instances.error();
    for (const Instance& instance : *instances)
        for (std::uint32_t part = 0; part < reader.scene.parts.size(); ++part)
            if (reader.scene.parts[part].mesh == instance.mesh)
                reader.scene.places.push_back({part, instance.matrix});
    Scene scene = std::move(reader.scene);
    auto remains = remaining_document(bytes, *document, folder, *use, reader.taken, scene.notes);
    if (!remains.ok()) return remains.error();
    if (options.poses > 0)
        sample_poses(*document, remains->root, *instances, *use, std::min<std::size_t>(options.poses, 1024),
                     scene);
    scene.report.format = document->binary ? "glTF (binary)" : "glTF (JSON)";
    scene.document = std::make_shared<SceneDocument>(std::move(*remains));
    return scene;
}

}  // namespace

Result<Scene> parse_scene(std::span<const std::byte> bytes, const std::string& folder,
                          const GltfOptions& options) {
    try {
        return read_whole(bytes, folder, options);
    } catch (const std::bad_alloc&) {
        return fault(ErrorCode::kLimit, "not enough memory for this scene");
    } catch (const std::exception& error) {
        return fault(ErrorCode::kMalformed, std::string("glTF: ") + error.what());
    }
}

}  // namespace vsplit::bake
