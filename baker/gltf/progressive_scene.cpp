// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The extension VSPLIT_progressive_mesh, written and read (formats/gltf/VSPLIT_progressive_mesh/README.md).
#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>
#include <set>

#include "attribute_set.hpp"
#include "container.hpp"
#include "scene_assembly.hpp"
#include "vsplit/bake/scene.hpp"

namespace vsplit::bake {
namespace {

constexpr const char* kName = "VSPLIT_progressive_mesh";

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}
Error malformed(const std::string& what) {
    return fault(ErrorCode::kMalformed, std::string(kName) + ": " + what);
}

OrderedJson describe(const StoredAttribute& stored) {
    OrderedJson out = {{"type", stored.type}, {"componentType", stored.component_type}};
    if (stored.normalised) out["normalized"] = true;
    return out;
}

/// The mesh's primitives as the document had them, without their triangles.
const OrderedJson& template_of(const Scene& scene, const ScenePrimitive& primitive) {
    return scene.document->root.at("meshes").at(primitive.mesh).at("primitives").at(primitive.primitive);
}

double area(const Mesh& mesh, const Triangle& t) {
    const Float3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const double u[3] = {double(b.x) - a.x, double(b.y) - a.y, double(b.z) - a.z};
    const double v[3] = {double(c.x) - a.x, double(c.y) - a.y, double(c.z) - a.z};
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    return n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
}

/// A mesh without a primitive would have to go, and its nodes' skins and animated weights with it. A part
/// that has vanished from the level shown is therefore there with its largest triangle.
Status keep_every_part(const Scene& scene, Mesh& shown) {
    const Mesh& full = scene.mesh;
    const std::size_t meshes = scene.document->root.at("meshes").size();
    std::vector<std::uint8_t> there(meshes, 0);
    for (const std::uint32_t group : shown.groups) there[scene.primitives[group].mesh] = 1;
    std::vector<std::size_t> largest(meshes, full.triangles.size());
    for (std::size_t t = 0; t < full.triangles.size(); ++t) {
        std::size_t& best = largest[scene.primitives[full.groups[t]].mesh];
        if (best == full.triangles.size() || area(full, full.triangles[t]) > area(full, full.triangles[best]))
            best = t;
    }
    for (const ScenePart& part : scene.parts) {
        if (there[part.mesh] != 0) continue;
        const std::size_t t = largest[part.mesh];
        if (t == full.triangles.size())
            return fault(ErrorCode::kArgument, "the level shown lacks a mesh, and so does the scene");
        Triangle made;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t v = full.triangles[t][c];
            made[c] = std::uint32_t(shown.positions.size());
            shown.positions.push_back(full.positions[v]);
            if (!shown.weights.empty()) shown.weights.push_back(1);
            for (std::size_t a = 0; a < full.attributes.size(); ++a) {
                const Attribute& from = full.attributes[a];
                const auto begin = from.values.begin() + std::ptrdiff_t(std::size_t{v} * from.components);
                shown.attributes[a].values.insert(shown.attributes[a].values.end(), begin,
                                                  begin + std::ptrdiff_t(from.components));
            }
        }
        shown.triangles.push_back(made);
        shown.groups.push_back(full.groups[t]);
    }
    return Ok{};
}

OrderedJson describe(const Scene& scene, const std::vector<int>& shown_at, const GltfLevel& shown) {
    OrderedJson attributes = OrderedJson::array();
    for (const Attribute& attribute : scene.mesh.attributes)
        attributes.push_back({{"name", attribute.name}, {"components", attribute.components}});
    OrderedJson meshes = OrderedJson::array();
    for (const ScenePart& part : scene.parts) {
        OrderedJson primitives = OrderedJson::array();
        for (std::size_t g = 0; g < scene.primitives.size(); ++g) {
            const ScenePrimitive& source = scene.primitives[g];
            if (source.mesh != part.mesh) continue;
            OrderedJson one = {{"group", g}, {"index", source.primitive}};
            if (shown_at[g] >= 0) one["shown"] = shown_at[g];
            if (source.targets > 0) one["targets"] = source.targets;
            one["position"] = describe(source.position);
            OrderedJson stored = OrderedJson::array();
            for (const StoredAttribute& attribute : source.attributes) {
                OrderedJson entry = {{"attribute", attribute.attribute}};
                entry.update(describe(attribute));
                stored.push_back(std::move(entry));
            }
            one["attributes"] = std::move(stored);
            if (const OrderedJson& properties = template_of(scene, source); !properties.empty())
                one["properties"] = properties;
            primitives.push_back(std::move(one));
        }
        meshes.push_back(
            {{"mesh", part.mesh}, {"exponent", part.exponent}, {"primitives", std::move(primitives)}});
    }
    return {{"radius", scene.radius},
            {"unit", scene.unit},
            {"shown", {{"triangles", shown.mesh.triangles.size()}, {"error", shown.error}}},
            {"attributes", std::move(attributes)},
            {"meshes", std::move(meshes)}};
}

Result<std::vector<std::byte>> write_progressive(const Scene& scene, const GltfLevel& given,
                                                 std::span<const std::byte> pmesh,
                                                 const SceneFormat& format) {
    if (format.quantised || format.shared_vertices)
        return fault(ErrorCode::kArgument,
                     "a progressive GLB is not quantised: the stream needs the nodes as they are");
    GltfLevel shown = given;
    if (Status status = check_scene_levels(scene, {&shown, 1}); !status.ok()) return status.error();
    if (shown.mesh.groups.empty()) shown.mesh.groups.assign(shown.mesh.triangles.size(), 0);
    if (Status status = keep_every_part(scene, shown.mesh); !status.ok()) return status.error();
    SceneAssembly assembly(scene, format);
    if (Status status = assembly.add_levels({&shown, 1}); !status.ok()) return status.error();
    assembly.add_kept();
    OrderedJson stream = {{"bufferView", assembly.sink().add_view(pmesh, 8)}};
    stream.update(describe(scene, assembly.shown_at(), given));
    assembly.root()["extensions"][kName] = std::move(stream);
    use_extension(assembly.root(), kName, false);
    return assembly.finish();
}

/// What is read back, each number checked before it is used.
class StreamReader {
  public:
    StreamReader(const OrderedJson& root, const OrderedJson& stream) : root_(root), stream_(stream) {}
    Scene scene;
    TakenPrimitives taken;

    Status read() {
        if (const OrderedJson* radius = member(stream_, "radius"); radius != nullptr && radius->is_number())
            scene.radius = std::max(0.0, radius->get<double>());
        if (const OrderedJson* unit = member(stream_, "unit"); unit != nullptr && unit->is_number())
            scene.unit = unit->get<double>();
        if (!(scene.unit > 0) || !std::isfinite(scene.unit)) return malformed("unit must be positive");
        const OrderedJson* attributes = member(stream_, "attributes");
        const OrderedJson* meshes = member(stream_, "meshes");
        if (attributes == nullptr || !attributes->is_array() || meshes == nullptr || !meshes->is_array())
            return malformed("attributes and meshes must be arrays");
        for (const OrderedJson& attribute : *attributes) {
            const OrderedJson* name = member(attribute, "name");
            const auto components = number(attribute, "components", 17);
            if (name == nullptr || !name->is_string() || !components || *components == 0)
                return malformed("an attribute needs a name and 1 to 16 components");
            const auto& text = name->get_ref<const std::string&>();
            scene.mesh.attributes.push_back({text, semantic_of(text), std::uint32_t(*components), {}});
        }
        if (const char* what = attributes_fault(scene.mesh.attributes, 0)) return malformed(what);
        const OrderedJson* all = member(root_, "meshes");
        sizes_.assign(all != nullptr && all->is_array() ? all->size() : 0, 0);
        std::size_t groups = 0;
        for (const OrderedJson& mesh : *meshes)
            if (const OrderedJson* primitives = member(mesh, "primitives")) groups += primitives->size();
        scene.primitives.resize(groups);
        properties_.resize(groups);
        seen_.assign(groups, 0);
        for (const OrderedJson& mesh : *meshes)
            if (Status status = read_mesh(mesh, *all); !status.ok()) return status;
        return Ok{};
    }

    /// The mesh's primitives as they were before the level shown took their place.
    Status restore(OrderedJson& root) const {
        for (const ScenePart& part : scene.parts) {
            OrderedJson& shown = root["meshes"][part.mesh]["primitives"];
            OrderedJson all = OrderedJson::array();
            std::vector<const OrderedJson*> others;
            for (std::size_t i = 0; i < shown.size(); ++i)
                if (!taken.contains({part.mesh, i})) others.push_back(&shown[i]);
            std::vector<std::size_t> group_at(sizes_[part.mesh] + others.size(), scene.primitives.size());
            for (std::size_t g = 0; g < scene.primitives.size(); ++g)
                if (scene.primitives[g].mesh == part.mesh) {
                    if (scene.primitives[g].primitive >= group_at.size() ||
                        group_at[scene.primitives[g].primitive] != scene.primitives.size())
                        return malformed("primitives of a mesh do not follow each other");
                    group_at[scene.primitives[g].primitive] = g;
                }
            std::size_t next = 0;
            for (const std::size_t g : group_at)
                if (g < scene.primitives.size())
                    all.push_back(properties_[g]);
                else
                    all.push_back(*others[next++]);
            shown = std::move(all);
        }
        return Ok{};
    }

  private:
    static std::optional<std::size_t> number(const OrderedJson& object, const char* key, std::size_t below) {
        const OrderedJson* value = member(object, key);
        if (value == nullptr || !value->is_number_unsigned()) return std::nullopt;
        const auto n = value->get<std::uint64_t>();
        if (n >= below) return std::nullopt;
        return std::size_t(n);
    }

    static bool read_stored(const OrderedJson& from, StoredAttribute& to) {
        const OrderedJson* type = member(from, "type");
        const auto component = number(from, "componentType", kFloat + 1);
        if (type == nullptr || !type->is_string() || !component || *component < kByte || *component == 5124)
            return false;
        to.type = type->get<std::string>();
        to.component_type = std::uint32_t(*component);
        const OrderedJson* normalised = member(from, "normalized");
        to.normalised = normalised != nullptr && normalised->is_boolean() && normalised->get<bool>();
        if (to.normalised && (to.component_type == kFloat || to.component_type == kUnsignedInt)) return false;
        return components_of_name(to.type) > 0;
    }

    Status read_mesh(const OrderedJson& mesh, const OrderedJson& all) {
        const auto at = number(mesh, "mesh", sizes_.size());
        const OrderedJson* exponent = member(mesh, "exponent");
        const OrderedJson* primitives = member(mesh, "primitives");
        if (!at || exponent == nullptr || !exponent->is_number_integer() || primitives == nullptr ||
            !primitives->is_array() || primitives->empty())
            return malformed("a mesh needs its number, an exponent and primitives");
        const auto power = exponent->get<std::int64_t>();
        if (power < -126 || power > 126) return malformed("an exponent is beyond those of floats");
        for (const ScenePart& part : scene.parts)
            if (part.mesh == *at) return malformed("a mesh is described twice");
        scene.parts.push_back({std::uint32_t(*at), int(power), 0, 0});
        const OrderedJson* shown = member(all[*at], "primitives");
        const std::size_t there = shown != nullptr && shown->is_array() ? shown->size() : 0;
        for (const OrderedJson& one : *primitives) {
            const auto group = number(one, "group", seen_.size());
            const auto index = number(one, "index", there + primitives->size());
            if (!group || !index || seen_[*group]++ != 0)
                return malformed("a primitive needs a group of its own and its place");
            ScenePrimitive& primitive = scene.primitives[*group];
            primitive.mesh = std::uint32_t(*at);
            primitive.primitive = std::uint32_t(*index);
            ++sizes_[*at];
            if (one.contains("shown")) {
                const auto place = number(one, "shown", there);
                if (!place || !taken.insert({*at, *place}).second)
                    return malformed("a primitive is shown where there is none");
            }
            if (Status status = read_attributes(one, primitive); !status.ok()) return status;
            const OrderedJson* properties = member(one, "properties");
            properties_[*group] =
                properties != nullptr && properties->is_object() ? *properties : OrderedJson::object();
        }
        return Ok{};
    }

    Status read_attributes(const OrderedJson& one, ScenePrimitive& primitive) const {
        const OrderedJson* position = member(one, "position");
        const OrderedJson* attributes = member(one, "attributes");
        if (position == nullptr || !read_stored(*position, primitive.position) ||
            primitive.position.type != "VEC3" || attributes == nullptr || !attributes->is_array())
            return malformed("a primitive needs the types of its position and attributes");
        std::set<std::size_t> used;
        for (const OrderedJson& entry : *attributes) {
            StoredAttribute stored;
            const auto number_of = number(entry, "attribute", scene.mesh.attributes.size());
            if (!number_of || !used.insert(*number_of).second || !read_stored(entry, stored))
                return malformed("an attribute of a primitive is not one of the stream's");
            const Attribute& attribute = scene.mesh.attributes[*number_of];
            if (components_of_name(stored.type) > attribute.components)
                return malformed("an attribute has fewer components in the stream");
            stored.attribute = std::uint32_t(*number_of);
            // "12/NORMAL": there are no more targets than attributes.
            if (const auto slash = attribute.name.find('/'); slash != attribute.name.npos) {
                const std::string digits = attribute.name.substr(0, slash);
                if (digits.empty() || digits.size() > 6 ||
                    digits.find_first_not_of("0123456789") != digits.npos ||
                    std::stoul(digits) >= scene.mesh.attributes.size())
                    return malformed("an attribute's name has a slash and is no morph target's");
                primitive.targets = std::max(primitive.targets, std::uint32_t(std::stoul(digits)) + 1);
            }
            primitive.attributes.push_back(std::move(stored));
        }
        return Ok{};
    }

    const OrderedJson& root_;
    const OrderedJson& stream_;
    std::vector<std::size_t> sizes_;  // per mesh, its primitives in the stream
    std::vector<OrderedJson> properties_;
    std::vector<std::uint8_t> seen_;
};

Result<Scene> read_progressive(std::span<const std::byte> bytes) {
    const auto container = open_container(bytes);
    if (!container.ok()) return container.error();
    auto document = Document::parse(bytes, "");
    if (!document.ok()) return document.error();
    const OrderedJson root = OrderedJson::parse(container->json);
    const OrderedJson* stream = extension_of(root, kName);
    if (stream == nullptr) return malformed("the scene does not have it");
    StreamReader reader(root, *stream);
    if (Status status = reader.read(); !status.ok()) return status.error();
    const auto use = survey_nodes(*document);
    if (!use.ok()) return use.error();
    auto remains = remaining_document(bytes, *document, "", *use, reader.taken, reader.scene.notes);
    if (!remains.ok()) return remains.error();
    if (Status status = reader.restore(remains->root); !status.ok()) return status.error();
    const OrderedJson* view = member(*stream, "bufferView");
    if (view != nullptr && view->is_number_unsigned()) {
        const auto number = view->get<std::uint64_t>();
        if (number < remains->root["bufferViews"].size()) remains->root["bufferViews"][number] = nullptr;
        remains->views.erase(number);
    }
    erase_extension(remains->root, kName);
    forget_extension(remains->root, kName);
    Scene scene = std::move(reader.scene);
    scene.report.format = "glTF (progressive)";
    scene.document = std::make_shared<SceneDocument>(std::move(*remains));
    return scene;
}

Result<std::optional<CarriedStream>> find_stream(std::span<const std::byte> bytes) {
    const auto u32 = [&](std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, 4);
        return std::uint64_t{value};
    };
    if (bytes.size() < 20 || std::memcmp(bytes.data(), "glTF", 4) != 0 || u32(4) != 2)
        return std::optional<CarriedStream>();
    const std::uint64_t total = u32(8), length = u32(12);
    if (std::memcmp(bytes.data() + 16, "JSON", 4) != 0) return std::optional<CarriedStream>();
    if (length > bytes.size() - 20)
        return Error{ErrorCode::kTruncated, "GLB: the file ends within its JSON", bytes.size(), 0};
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()) + 20, length);
    // Most GLBs have no stream; they need not be parsed to say so.
    if (text.find(kName) == text.npos) return std::optional<CarriedStream>();
    if (Status depth = check_json_depth(text, 20); !depth.ok()) return depth.error();
    const OrderedJson root = OrderedJson::parse(text);
    const OrderedJson* stream = extension_of(root, kName);
    if (stream == nullptr) return std::optional<CarriedStream>();
    const OrderedJson* number = member(*stream, "bufferView");
    const OrderedJson* views = member(root, "bufferViews");
    if (number == nullptr || !number->is_number_unsigned() || views == nullptr || !views->is_array() ||
        number->get<std::uint64_t>() >= views->size())
        return malformed("bufferView names none");
    const OrderedJson& view = (*views)[number->get<std::size_t>()];
    const auto field = [&](const char* key) -> std::optional<std::uint64_t> {
        const OrderedJson* value = member(view, key);
        if (value == nullptr) return 0;
        if (!value->is_number_unsigned()) return std::nullopt;
        return value->get<std::uint64_t>();
    };
    const auto buffer = field("buffer"), offset = field("byteOffset"), size = field("byteLength");
    const std::uint64_t begin = 20 + length + 8;
    if (buffer != std::uint64_t{0} || !offset || !size || begin > total || *offset > total - begin ||
        *size > total - begin - *offset)
        return malformed("its buffer view does not lie in the GLB's binary chunk");
    return std::optional(CarriedStream{begin + *offset, *size});
}

template <class Work>
auto guarded(Work work) -> decltype(work()) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return fault(ErrorCode::kLimit, "not enough memory for this scene");
    } catch (const std::exception& error) {
        return fault(ErrorCode::kMalformed, std::string("glTF: ") + error.what());
    }
}

}  // namespace

Result<std::vector<std::byte>> encode_progressive_scene(const Scene& scene, const GltfLevel& shown,
                                                        std::span<const std::byte> pmesh,
                                                        const SceneFormat& format) {
    return guarded([&] { return write_progressive(scene, shown, pmesh, format); });
}

Result<std::optional<CarriedStream>> find_progressive(std::span<const std::byte> bytes) {
    return guarded([&] { return find_stream(bytes); });
}

Result<Scene> parse_progressive_scene(std::span<const std::byte> bytes) {
    return guarded([&] { return read_progressive(bytes); });
}

}  // namespace vsplit::bake
