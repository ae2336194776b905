// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "scene_assembly.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <set>

#include "container.hpp"
#include "coverage.hpp"

namespace vsplit::bake {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

Error fault(std::string message) {
    return {ErrorCode::kArgument, std::move(message), Error::kNowhere, 0};
}

/// The mesh's primitives in the document, those of triangles emptied.
OrderedJson& primitives_of(OrderedJson& mesh) {
    return mesh["primitives"];
}

/// Inverse bind matrices of joints for places on `grid`: what a joint does to a vertex it then does to
/// one that the grid has moved and scaled. Not finite where the product is beyond a float.
std::vector<float> on_grid(std::vector<float> matrices, const Grid& grid) {
    for (std::size_t j = 0; j + 16 <= matrices.size(); j += 16) {
        float* m = matrices.data() + j;
        for (std::size_t row = 0; row < 4; ++row) {
            double moved = double(m[12 + row]);
            for (std::size_t c = 0; c < 3; ++c) moved += double(m[4 * c + row]) * grid.offset[c];
            for (std::size_t c = 0; c < 3; ++c) m[4 * c + row] = float(double(m[4 * c + row]) * grid.scale);
            m[12 + row] = float(moved);
        }
    }
    return matrices;
}

}  // namespace

Status check_scene_levels(const Scene& scene, std::span<const GltfLevel> levels) {
    if (scene.document == nullptr) return fault("the scene has no document");
    if (levels.empty()) return fault("no level of detail to write");
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const Mesh& mesh = levels[k].mesh;
        const std::string name = "level " + std::to_string(k);
        if (const char* what = mesh_fault(mesh)) return fault(name + ": " + what);
        if (!(levels[k].error >= 0) || !std::isfinite(levels[k].error))
            return fault(name + ": its error is no distance");
        bool same = mesh.attributes.size() == scene.mesh.attributes.size();
        for (std::size_t a = 0; same && a < mesh.attributes.size(); ++a)
            same = mesh.attributes[a].name == scene.mesh.attributes[a].name &&
                   mesh.attributes[a].components == scene.mesh.attributes[a].components;
        if (!same) return fault(name + " has other attributes than the scene");
        if (mesh.groups.empty() && scene.primitives.size() > 1) return fault(name + " has no groups");
        for (const std::uint32_t group : mesh.groups)
            if (group >= scene.primitives.size())
                return fault(name + " has a group that the scene does not have");
    }
    return Ok{};
}

SceneAssembly::SceneAssembly(const Scene& scene, const SceneFormat& format)
    : scene_(scene),
      format_(format),
      root_(scene.document->root),
      sink_(root_, format.meshopt),
      nodes_(root_),
      users_(nodes_.users()),
      writer_(scene, format, sink_) {}

/// Meshes that a skin moves share a grid with all meshes of that skin, since the grid goes into its
/// matrices; meshes that are instanced on the GPU, or have points or lines too, have no place for one.
void SceneAssembly::choose_grids(std::span<const GltfLevel> levels) {
    writer_.set_boxes(levels);
    if (!format_.quantised) return;
    const OrderedJson& nodes = root_["nodes"];
    const std::size_t skins = root_.contains("skins") ? root_["skins"].size() : 0;
    std::vector<std::size_t> leader(scene_.parts.size() + skins);
    for (std::size_t i = 0; i < leader.size(); ++i) leader[i] = i;
    const auto find = [&](std::size_t i) {
        while (leader[i] != i) i = leader[i] = leader[leader[i]];
        return i;
    };
    std::set<std::size_t> barred;
    for (std::size_t p = 0; p < scene_.parts.size(); ++p)
        for (const std::size_t n : users_[scene_.parts[p].mesh]) {
            if (const OrderedJson* skin = member(nodes[n], "skin"))
                leader[find(p)] = find(scene_.parts.size() + skin->get<std::size_t>());
            if (nodes_.instanced(n)) barred.insert(p);
        }
    // Points and lines of the mesh are not rewritten, and would move along.
    for (std::size_t p = 0; p < scene_.parts.size(); ++p) {
        const std::uint32_t mesh = scene_.parts[p].mesh;
        const auto rewritten =
            std::count_if(scene_.primitives.begin(), scene_.primitives.end(),
                          [&](const ScenePrimitive& primitive) { return primitive.mesh == mesh; });
        if (root_["meshes"][mesh]["primitives"].size() > std::size_t(rewritten)) barred.insert(p);
    }
    std::map<std::size_t, Grid> grids;
    for (std::size_t p = 0; p < scene_.parts.size(); ++p) {
        const auto& box = writer_.box(scene_.parts[p].mesh);
        if (!box) continue;
        const auto [at, fresh] = grids.try_emplace(find(p), *box);
        if (fresh) continue;
        Grid& grid = at->second;
        double scale = std::max(grid.scale, box->scale);
        for (std::size_t c = 0; c < 3; ++c) {
            const double least = std::min(grid.offset[c], box->offset[c]);
            scale =
                std::max({scale, grid.offset[c] + grid.scale - least, box->offset[c] + box->scale - least});
            grid.offset[c] = least;
        }
        grid.scale = scale;
    }
    for (const std::size_t p : barred) grids.erase(find(p));
    // Viewers hold node transforms as floats.
    for (auto& [group, grid] : grids) {
        for (double& x : grid.offset) x = double(float(x));
        grid.scale = double(std::nextafter(float(grid.scale * (1 + 1e-6)), INFINITY));
    }
    // An extent, or a matrix times it, may be beyond what a float holds: such meshes keep float places.
    std::erase_if(grids, [](const auto& entry) { return !std::isfinite(entry.second.scale); });
    for (std::size_t s = 0; s < skins; ++s)
        if (const auto grid = grids.find(find(scene_.parts.size() + s)); grid != grids.end()) {
            const std::vector<float> matrices = on_grid(scene_.document->inverse_bind[s], grid->second);
            if (!std::all_of(matrices.begin(), matrices.end(), [](float x) { return std::isfinite(x); }))
                grids.erase(grid);
        }
    for (std::size_t p = 0; p < scene_.parts.size(); ++p)
        if (const auto grid = grids.find(find(p)); grid != grids.end())
            writer_.quantise(scene_.parts[p].mesh, grid->second);
    for (std::size_t p = 0; p < scene_.parts.size(); ++p)
        if (const auto grid = grids.find(find(p)); grid != grids.end())
            for (std::size_t& n : users_[scene_.parts[p].mesh]) n = nodes_.apply_grid(n, grid->second);
    std::map<std::size_t, Grid> by_skin;
    for (std::size_t s = 0; s < skins; ++s)
        if (const auto grid = grids.find(find(scene_.parts.size() + s)); grid != grids.end())
            by_skin.emplace(s, grid->second);
    quantise_skins(by_skin);
}

void SceneAssembly::quantise_skins(const std::map<std::size_t, Grid>& grids) {
    if (grids.empty()) return;
    OrderedJson& skins = root_["skins"];
    std::set<std::size_t> old;
    for (const auto& [s, grid] : grids)
        if (const OrderedJson* accessor = member(skins[s], "inverseBindMatrices")) {
            old.insert(accessor->get<std::size_t>());
            skins[s].erase("inverseBindMatrices");
        }
    for (const OrderedJson& skin : skins)
        if (const OrderedJson* accessor = member(skin, "inverseBindMatrices"))
            old.erase(accessor->get<std::size_t>());
    for (const std::size_t accessor : old) drop_accessor(accessor);
    for (const auto& [s, grid] : grids) {
        skins[s]["inverseBindMatrices"] = sink_.add_matrices(on_grid(scene_.document->inverse_bind[s], grid));
    }
}

void SceneAssembly::drop_accessor(std::size_t accessor) {
    OrderedJson& accessors = root_["accessors"];
    const OrderedJson* view = member(accessors[accessor], "bufferView");
    const std::size_t number = view != nullptr ? view->get<std::size_t>() : kNone;
    const bool sparse = accessors[accessor].contains("sparse");
    accessors[accessor] = nullptr;
    if (number == kNone || sparse) return;
    const auto names = [&](const OrderedJson& object) {
        const OrderedJson* other = member(object, "bufferView");
        return other != nullptr && *other == number;
    };
    for (const OrderedJson& other : accessors) {
        if (names(other)) return;
        if (const OrderedJson* parts = member(other, "sparse"))
            for (const OrderedJson& part : *parts)
                if (names(part)) return;
    }
    // Only views that were cut out for one accessor, or are plainly its own, have no other user to look for.
    const OrderedJson* kept = &root_["bufferViews"][number];
    if (kept->contains("extensions")) return;
    const std::function<bool(const OrderedJson&)> used = [&](const OrderedJson& value) {
        if (names(value)) return true;
        return (value.is_object() || value.is_array()) && std::any_of(value.begin(), value.end(), used);
    };
    if (used(root_)) return;
    root_["bufferViews"][number] = nullptr;
    dropped_views_.insert(number);
}

std::vector<double> SceneAssembly::radii(const Mesh& mesh) const {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    struct Box {
        float least[3] = {kFar, kFar, kFar}, most[3] = {-kFar, -kFar, -kFar};
    };
    std::vector<Box> boxes(scene_.document->root["meshes"].size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        Box& box = boxes[scene_.primitives[mesh.groups.empty() ? 0 : mesh.groups[t]].mesh];
        for (const std::uint32_t v : mesh.triangles[t]) {
            const float p[3] = {mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z};
            for (std::size_t c = 0; c < 3; ++c) {
                box.least[c] = std::min(box.least[c], p[c]);
                box.most[c] = std::max(box.most[c], p[c]);
            }
        }
    }
    std::vector<double> out;
    for (const Box& box : boxes) {
        double square = 0;
        for (std::size_t c = 0; c < 3; ++c)
            if (const double side = double(box.most[c]) - double(box.least[c]); side > 0)
                square += side * side;
        out.push_back(0.5 * std::sqrt(square));
    }
    return out;
}

/// One vertex array a primitive: the finest level's vertices, then those of coarser ones that are not among
/// them, of which there are none where vertices only ever take the place of others (placement endpoint).
Mesh SceneAssembly::share_vertices(std::span<const GltfLevel> levels) {
    Mesh all = levels[0].mesh;
    all.triangles.clear();
    all.groups.clear();
    for (std::size_t g = 0; g < scene_.primitives.size(); ++g) {
        const auto& stored = scene_.primitives[g].attributes;
        const auto each = [&](const Mesh& mesh, std::uint32_t v, auto use) {
            const Float3& p = mesh.positions[v];
            use(p.x), use(p.y), use(p.z);
            for (const StoredAttribute& attribute : stored) {
                const Attribute& from = mesh.attributes[attribute.attribute];
                for (std::size_t c = 0; c < from.components; ++c)
                    use(from.values[std::size_t{v} * from.components + c]);
            }
        };
        const auto row = [&](const Mesh& mesh, std::uint32_t v) {
            std::vector<std::uint32_t> bits;
            each(mesh, v, [&](float value) { bits.push_back(std::bit_cast<std::uint32_t>(value)); });
            return bits;
        };
        std::map<std::vector<std::uint32_t>, std::uint32_t> place;
        std::vector<std::uint32_t> vertices;
        for (std::size_t k = 0; k < levels.size(); ++k) {
            PrimitiveCut& cut = cuts_[k][g];
            std::vector<std::uint32_t> at(cut.vertices.size());
            for (std::size_t i = 0; i < at.size(); ++i) {
                const std::uint32_t v = cut.vertices[i];
                const auto [found, fresh] =
                    place.try_emplace(row(levels[k].mesh, v), std::uint32_t(vertices.size()));
                at[i] = found->second;
                if (!fresh) continue;
                if (k == 0) {
                    vertices.push_back(v);
                    continue;
                }
                vertices.push_back(std::uint32_t(all.positions.size()));
                all.positions.push_back(levels[k].mesh.positions[v]);
                for (std::size_t a = 0; a < all.attributes.size(); ++a) {
                    const Attribute& from = levels[k].mesh.attributes[a];
                    const auto begin = from.values.begin() + std::ptrdiff_t(std::size_t{v} * from.components);
                    all.attributes[a].values.insert(all.attributes[a].values.end(), begin,
                                                    begin + std::ptrdiff_t(from.components));
                }
            }
            for (std::uint32_t& corner : cut.corners) corner = at[corner];
        }
        for (auto& level : cuts_)
            if (!level[g].corners.empty()) level[g].vertices = vertices;
    }
    return all;
}

Status SceneAssembly::write_meshes(std::span<const GltfLevel> levels) {
    for (const GltfLevel& level : levels)
        cuts_.push_back(split_by_group(level.mesh, scene_.primitives.size()));
    Mesh shared;
    std::vector<OrderedJson> finest(scene_.primitives.size());
    if (format_.shared_vertices) {
        shared = share_vertices(levels);
    } else if (format_.meshopt) {
        for (auto& level : cuts_)
            for (PrimitiveCut& cut : level)
                if (!cut.corners.empty()) order_for_cache(cut);
    }
    OrderedJson& meshes = root_["meshes"];
    shown_at_.assign(scene_.primitives.size(), -1);
    mesh_at_.assign(scene_.parts.size(), std::vector<std::size_t>(levels.size(), kNone));
    // By level, then by part, so that a viewer that wants one level reads one range.
    std::vector<std::vector<std::size_t>> groups(meshes.size());
    for (std::size_t g = 0; g < scene_.primitives.size(); ++g) groups[scene_.primitives[g].mesh].push_back(g);
    std::vector<OrderedJson> templates;
    for (const ScenePart& part : scene_.parts) templates.push_back(std::move(meshes[part.mesh]));
    for (const ScenePart& part : scene_.parts) meshes[part.mesh] = nullptr;
    for (std::size_t k = 0; k < levels.size(); ++k)
        for (std::size_t p = 0; p < scene_.parts.size(); ++p) {
            OrderedJson mesh = templates[p];
            OrderedJson& all = primitives_of(mesh);
            std::vector<std::size_t> group_of(all.size(), kNone);
            for (const std::size_t g : groups[scene_.parts[p].mesh])
                group_of.at(scene_.primitives[g].primitive) = g;
            OrderedJson kept = OrderedJson::array();
            for (std::size_t i = 0; i < all.size(); ++i) {
                const std::size_t g = group_of[i];
                if (g != kNone) {
                    const PrimitiveCut& cut = cuts_[k][g];
                    if (cut.corners.empty()) continue;
                    OrderedJson primitive = OrderedJson::object();
                    if (format_.shared_vertices && !finest[g].is_null()) {
                        primitive = finest[g];
                        primitive["indices"] = sink_.add_indices(cut.corners, cut.vertices.size());
                    } else {
                        const Mesh& from = format_.shared_vertices ? shared : levels[k].mesh;
                        if (Status status = writer_.write(from, g, cut, primitive); !status.ok())
                            return status;
                        finest[g] = primitive;
                    }
                    for (auto& [key, value] : all[i].items())
                        if (key == "extensions")
                            primitive[key].update(value);
                        else
                            primitive[key] = value;
                    if (k == 0) shown_at_[g] = int(kept.size());
                    kept.push_back(std::move(primitive));
                } else {
                    kept.push_back(all[i]);
                }
            }
            if (kept.empty()) continue;
            all = std::move(kept);
            if (k == 0) {
                meshes[scene_.parts[p].mesh] = std::move(mesh);
                mesh_at_[p][0] = scene_.parts[p].mesh;
                continue;
            }
            if (OrderedJson* name = member(mesh, "name"); name != nullptr && name->is_string())
                *name = name->get_ref<const std::string&>() + "_LOD" + std::to_string(k);
            mesh_at_[p][k] = meshes.size();
            meshes.push_back(std::move(mesh));
        }
    return Ok{};
}

void SceneAssembly::place_levels(std::span<const GltfLevel> levels) {
    const std::vector<double> radius = radii(levels[0].mesh);
    for (std::size_t p = 0; p < scene_.parts.size(); ++p) {
        const auto& at = mesh_at_[p];
        const auto& users = users_[scene_.parts[p].mesh];
        if (at[0] == kNone) {
            for (const std::size_t n : users) nodes_.take_mesh(n);
            continue;
        }
        // Levels until the part vanishes, and where it does the distance at which it may.
        std::vector<double> errors;
        std::vector<std::size_t> meshes;
        bool vanishes = false;
        for (std::size_t k = 0; k < levels.size() && !vanishes; ++k) {
            errors.push_back(levels[k].error);
            vanishes = at[k] == kNone;
            if (k > 0 && !vanishes) meshes.push_back(at[k]);
        }
        std::vector<double> coverage = screen_coverage(errors, radius[scene_.parts[p].mesh], format_.screen);
        if (vanishes) coverage.pop_back();
        for (const std::size_t n : users) nodes_.add_levels(n, meshes, coverage);
    }
}

Status SceneAssembly::add_levels(std::span<const GltfLevel> levels) {
    choose_grids(levels);
    if (Status status = write_meshes(levels); !status.ok()) return status;
    place_levels(levels);
    nodes_.drop_missing_meshes();
    if (writer_.beyond_core()) use_extension(root_, "KHR_mesh_quantization", true);
    if (format_.draco) use_extension(root_, "KHR_draco_mesh_compression", true);
    return Ok{};
}

void SceneAssembly::add_kept() {
    for (const bool images : {false, true})
        for (const auto& [number, view] : scene_.document->views)
            if (view.image == images && !dropped_views_.contains(number)) sink_.keep_view(number, view);
}

Result<std::vector<std::byte>> SceneAssembly::finish() {
    sink_.finish();
    for (const char* key : {"nodes", "scenes", "materials", "images", "textures", "samplers", "skins",
                            "animations", "cameras", "meshes"})
        if (const OrderedJson* array = member(root_, key);
            array != nullptr && array->is_array() && array->empty())
            root_.erase(key);
    return seal_container(root_.dump(), sink_.bin);
}

}  // namespace vsplit::bake
