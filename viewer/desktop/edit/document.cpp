// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "document.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

#include "vsplit/bake/meshes.hpp"

namespace vsplit::studio {
namespace {

Double3 at(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

/// Of several weights, each becomes a region; of more than these, one region with strengths.
constexpr std::size_t kMaxWeightRegions = 8;
constexpr std::uint32_t kColours[] = {0xE6550D, 0x3182BD, 0x31A354, 0x756BB1,
                                      0xE7298A, 0xE6AB02, 0x1B9E77, 0xA6761D};

bake::Marks marks_of_weights(std::span<const float> weights) {
    bake::Marks marks = bake::no_marks(weights.size());
    std::vector<float> kinds;
    for (const float w : weights) {
        if (w == 1 || std::find(kinds.begin(), kinds.end(), w) != kinds.end()) continue;
        kinds.push_back(w);
        if (kinds.size() > kMaxWeightRegions) break;
    }
    if (kinds.size() <= kMaxWeightRegions) {
        for (std::size_t r = 0; r < kinds.size(); ++r)
            marks.regions.push_back({kinds.size() == 1 ? "painted" : "painted-" + std::to_string(r + 1),
                                     double(kinds[r]), kColours[r % std::size(kColours)]});
        for (std::size_t v = 0; v < weights.size(); ++v) {
            const auto it = std::find(kinds.begin(), kinds.end(), weights[v]);
            if (it != kinds.end()) marks.region[v] = std::uint8_t(it - kinds.begin() + 1);
        }
        return marks;
    }
    // Continuous: more than 1 and less than 1 are two regions, by powers of the farthest finite weight.
    double most = 1, least = 1;
    for (const float w : weights) {
        if (std::isfinite(w)) most = std::max(most, double(w));
        if (w > 0) least = std::min(least, double(w));
    }
    marks.regions = {{"painted", most, kColours[0]},
                     {"light", least, kColours[1]},
                     {"never", double(INFINITY), kColours[4]}};
    for (std::size_t v = 0; v < weights.size(); ++v) {
        const double w = double(weights[v]);
        if (w == 1) continue;
        marks.region[v] = std::isinf(w) ? 3 : w > 1 ? 1 : 2;
        if (std::isinf(w)) continue;
        const double power = w > 1 ? std::log(w) / std::log(most) : w > 0 ? std::log(w) / std::log(least) : 1;
        marks.strength[v] = float(std::clamp(power, 0.0, 1.0));
    }
    return marks;
}

}  // namespace

Result<std::unique_ptr<Document>> Document::open(Source source, bake::CollapseOptions options,
                                                 const bake::Progress& progress) {
    std::unique_ptr<Document> document(new Document);
    Document& d = *document;
    d.source_ = std::move(source);
    d.options_ = std::move(options);
    d.options_.part_of = d.source_.part_of;
    if (d.source_.scene) {
        d.placement_ = Placement(*d.source_.scene);
        d.materials_ = bake::scene_materials(*d.source_.scene);
    }
    const Mesh& mesh = d.source_.mesh;
    d.box_ =
        box_of(d.placed() ? d.show(mesh.positions, mesh.triangles, mesh.groups).positions : mesh.positions);
    d.painting_ = Painting(d.source_.mesh.positions.size());
    if (!d.source_.mesh.weights.empty()) {
        d.painting_.replace(marks_of_weights(d.source_.mesh.weights));
        d.painting_.mark_saved();
    }
    if (d.source_.file_vertices == 0) d.source_.file_vertices = d.source_.mesh.positions.size();
    d.automatic_ = bake::automatic_weights(bake::edge_errors(d.source_.mesh));
    std::optional<ProgressiveMesh> record = std::move(d.source_.record);
    d.source_.record.reset();
    if (!record) {
        auto result = bake::collapse(d.source_.mesh, d.options_, progress);
        if (!result) return result.error();
        record = std::move(result->mesh);
    }
    d.closed_ = d.every_part_closed();
    d.adopt(std::move(*record));
    d.go_to(d.live_->max_level());
    return document;
}

std::size_t Document::level_for_ratio(double ratio) const {
    const ProgressiveMesh& record = live_->state();
    return level_for_triangles(record, std::uint64_t(std::llround(ratio * double(record.triangles.size()))));
}

double Document::ratio() const {
    return double(live_->triangles().size()) /
           double(std::max<std::size_t>(live_->state().triangles.size(), 1));
}

void Document::go_to(std::size_t level) {
    if (level == live_->level()) return;
    live_->go_to(level);
    surface_.reset();
}

std::vector<Triangle> Document::take_repainted() {
    std::vector<std::uint32_t> triangles, changed;
    const std::uint32_t alive = vertices_at(live_->state(), live_->level());
    for (const std::uint32_t origin : painting_.take_changed()) {
        const std::uint32_t v = record_of_[origin];
        if (v >= alive) continue;
        changed.push_back(v);
    }
    Surface& there = surface();
    const auto take = [&](std::uint32_t shown) {
        const auto star = there.star(shown);
        triangles.insert(triangles.end(), star.begin(), star.end());
    };
    if (!placed()) {
        for (const std::uint32_t v : changed) take(v);
    } else {
        std::vector<char> is_changed(alive, 0);
        for (const std::uint32_t v : changed) is_changed[v] = 1;
        for (std::uint32_t i = 0; i < shown_.vertex_of.size(); ++i)
            if (is_changed[shown_.vertex_of[i]]) take(i);
    }
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    std::vector<Triangle> found;
    for (const std::uint32_t t : triangles) found.push_back(shown_triangles()[t]);
    return found;
}

Surface& Document::surface() {
    if (!surface_) {
        if (placed()) shown_ = show(live_->positions(), live_->triangles(), groups_at_level());
        surface_ = std::make_unique<Surface>(shown_positions(), shown_triangles(),
                                             !source_.mesh.attributes.empty() || placed());
    }
    return *surface_;
}

std::span<const Float3> Document::shown_positions() {
    return placed() ? std::span<const Float3>(shown_.positions) : live_->positions();
}

std::span<const Triangle> Document::shown_triangles() {
    return placed() ? std::span<const Triangle>(shown_.triangles) : live_->triangles();
}

std::vector<std::uint32_t> Document::level_vertices(std::vector<std::uint32_t> shown) const {
    for (std::uint32_t& v : shown) v = level_vertex(v);
    return shown;
}

std::span<const std::uint32_t> Document::groups_at_level() const {
    const std::vector<std::uint32_t>& groups = live_->state().groups;
    return {groups.data(), std::min(groups.size(), live_->triangles().size())};
}

void Document::mark_level_vertices(std::span<const std::uint32_t> vertices, std::uint8_t region,
                                   float strength) {
    const std::uint32_t alive = vertices_at(live_->state(), live_->level());
    std::vector<std::uint32_t> stack;
    for (const std::uint32_t v : vertices) {
        stack.push_back(v);
        while (!stack.empty()) {
            const std::uint32_t w = stack.back();
            stack.pop_back();
            if (origins_[w] != kNoVertex) painting_.mark(origins_[w], region, strength);
            // Children are listed by birth: those already alive have their own place under the brush.
            for (std::uint32_t i = child_starts_[w + 1]; i-- > child_starts_[w] && children_[i] >= alive;)
                stack.push_back(children_[i]);
        }
    }
}

void Document::dab(const Hit& hit, const Brush& brush) {
    const auto paint = [&](const Hit& where) {
        const std::vector<std::uint32_t> reached =
            surface().within(where.point, where.triangle, brush.radius);
        if (brush.strength >= 1 || brush.region == 0) {
            mark_level_vertices(level_vertices(reached), brush.region, brush.strength);
            return;
        }
        for (const std::uint32_t v : reached) {
            const double d =
                bake::length(at(shown_positions()[v]) - where.point) / std::max(brush.radius, 1e-30);
            const float falloff = d < 1 ? float(1 - d * d) : 0.05f;
            const std::uint32_t marked = level_vertex(v);
            mark_level_vertices({&marked, 1}, brush.region, brush.strength * std::max(falloff, 0.05f));
        }
    };
    paint(hit);
    std::vector<Double3> points{hit.point};
    for (int axis = 0; axis < 3; ++axis) {
        if (!(brush.mirror & (1u << axis))) continue;
        for (std::size_t i = 0, n = points.size(); i < n; ++i) {
            points.push_back(mirrored(points[i], box_, axis));
            if (const auto other = surface().nearest(points.back(), brush.radius)) paint(*other);
        }
    }
}

bool Document::select_component(std::uint32_t vertex, std::uint8_t region) {
    painting_.begin();
    mark_level_vertices(level_vertices(surface().component(vertex)), region, 1);
    return painting_.end();
}

bool Document::select_sharper_than(double degrees, std::uint8_t region) {
    painting_.begin();
    mark_level_vertices(level_vertices(surface().sharper_than(degrees)), region, 1);
    return painting_.end();
}

std::uint32_t Document::material_number(std::uint32_t group) const {
    return group < materials_.size() ? materials_[group].number : group;
}

std::string Document::material_of(std::uint32_t triangle) {
    surface();
    const auto groups = groups_at_level();
    if (groups.empty()) return {};
    const std::uint32_t group = groups[level_triangle(triangle)];
    if (group < materials_.size() && !materials_[group].name.empty()) return materials_[group].name;
    const std::uint32_t number = material_number(group);
    return number == kNoVertex ? "of the format's default" : std::to_string(number);
}

bool Document::select_material(std::uint32_t triangle, std::uint8_t region) {
    surface();
    const std::vector<std::uint32_t>& groups = live_->state().groups;
    const auto material = [&](std::size_t t) { return groups.empty() ? 0u : material_number(groups[t]); };
    const std::uint32_t wanted = material(level_triangle(triangle));
    painting_.begin();
    // Of the full model: a coarse triangle's corner may have descendants of several materials.
    for (std::size_t t = 0; t < full_.triangles.size(); ++t)
        if (material(t) == wanted)
            for (const std::uint32_t v : full_.triangles[t])
                if (origins_[v] != kNoVertex) painting_.mark(origins_[v], region, 1);
    return painting_.end();
}

double Document::weight_of(std::size_t region) const {
    return painting_.marks().regions[region - 1].weight.value_or(automatic_.factor());
}

std::vector<float> Document::weights() const {
    return bake::weights_of(painting_.marks(), automatic_.factor());
}

Mesh Document::painted() const {
    Mesh mesh = source_.mesh;
    mesh.weights = weights();
    if (std::all_of(mesh.weights.begin(), mesh.weights.end(), [](float w) { return w == 1; }))
        mesh.weights.clear();
    return mesh;
}

bool Document::every_part_closed() const {
    const Mesh& mesh = source_.mesh;
    if (!placed()) return studio::closed(mesh.positions, mesh.triangles);
    std::map<std::uint32_t, std::vector<Triangle>> parts;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        parts[mesh.groups.empty() ? 0 : placement_.part_of_group(mesh.groups[t])].push_back(
            mesh.triangles[t]);
    return std::all_of(parts.begin(), parts.end(),
                       [&](const auto& part) { return studio::closed(mesh.positions, part.second); });
}

void Document::adopt(ProgressiveMesh record) {
    const double ratio_shown = live_ ? ratio() : 1;
    surface_.reset();
    refined_.reset();
    origins_ = bake::record_origins(source_.mesh, record);
    record_of_.assign(source_.mesh.positions.size(), kNoVertex);
    for (std::uint32_t v = 0; v < origins_.size(); ++v)
        if (origins_[v] != kNoVertex) record_of_[origins_[v]] = v;
    full_ = cut(record, record.splits.size());
    const std::size_t n = record.positions.size();
    child_starts_.assign(n + 1, 0);
    for (const std::uint32_t parent : record.parents)
        if (parent != kNoVertex) ++child_starts_[parent];
    std::uint32_t sum = 0;
    for (std::uint32_t& start : child_starts_) start = (sum += start);
    children_.resize(sum);
    for (std::size_t v = n; v-- > 0;)
        if (record.parents[v] != kNoVertex) children_[--child_starts_[record.parents[v]]] = std::uint32_t(v);
    live_ = std::make_unique<LiveMesh>(std::move(record));
    live_->go_to(level_for_ratio(ratio_shown));
}

Result<Mesh> Document::refined_in_place() {
    // An error of what is marked counts so much more that none of it is below any level's.
    constexpr float kMarked = 1e12f;
    if (!refined_) {
        LiveMesh copy = *live_;
        auto made = ViewMesh::make(copy.release());
        if (!made) return made.error();
        refined_.emplace(std::move(*made));
    }
    const bake::Marks& marks = painting_.marks();
    std::vector<float> priorities(origins_.size(), 1);
    for (std::size_t v = 0; v < priorities.size(); ++v)
        if (origins_[v] != kNoVertex && marks.region[origins_[v]] != 0) priorities[v] = kMarked;
    if (const Status set = refined_->set_priority(priorities); !set) return set.error();
    refined_->rank();
    refined_->refine_to(refined_->rank_for_error(live_->error()));
    Mesh mesh;
    mesh.positions.assign(refined_->positions().begin(), refined_->positions().end());
    mesh.triangles.assign(refined_->triangles().begin(), refined_->triangles().end());
    mesh.groups.assign(refined_->groups().begin(), refined_->groups().end());
    mesh.origin = live_->state().origin;
    return mesh;
}

std::vector<std::byte> Document::encode_marks() const {
    return bake::encode_marks(
        bake::marks_of_file(painting_.marks(), source_.vertex_of, source_.file_vertices));
}

std::vector<std::byte> Document::encode_weights() const {
    const bake::Marks marks =
        bake::marks_of_file(painting_.marks(), source_.vertex_of, source_.file_vertices);
    return bake::encode_weights(bake::weights_of(marks, automatic_.factor()));
}

Status Document::load_marks(std::span<const std::byte> bytes) {
    auto marks = bake::parse_marks(bytes, source_.file_vertices);
    if (marks) {
        painting_.replace(bake::marks_of_mesh(*marks, source_.vertex_of, painting_.vertices()));
        return Ok{};
    }
    auto weights = bake::parse_weights(bytes, source_.file_vertices);
    if (!weights) return marks.error();
    painting_.replace(
        bake::marks_of_mesh(marks_of_weights(*weights), source_.vertex_of, painting_.vertices()));
    return Ok{};
}

Result<std::vector<std::byte>> Document::encode(const std::string& extension, double ratio,
                                                const WriteOptions& write) const {
    const auto level = [&](double share) {
        LiveMesh copy = *live_;
        copy.go_to(level_for_ratio(share));
        return bake::GltfLevel{copy.snapshot(), copy.error()};
    };
    if (extension == ".pmesh") {
        LiveMesh copy = *live_;
        return write_progressive_mesh(copy.release(), write);
    }
    if (extension == ".ply" || extension == ".obj") {
        Mesh mesh = level(ratio).mesh;
        if (placed()) {
            // Neither has nodes: everything where it is seen.
            Shown shown = show(mesh.positions, mesh.triangles, mesh.groups);
            mesh = {};
            mesh.positions = std::move(shown.positions);
            mesh.triangles = std::move(shown.triangles);
        }
        return extension == ".ply" ? bake::encode_ply(mesh) : bake::encode_obj(mesh);
    }
    if (extension != ".glb")
        return Error{ErrorCode::kArgument, "exports are .pmesh, .glb, .ply or .obj, not '" + extension + "'",
                     Error::kNowhere, 0};
    const bake::GltfLevel one = level(ratio);
    if (!source_.scene) return bake::encode_levels({&one, 1});
    if (ratio < 1) return bake::encode_scene(*source_.scene, {&one, 1});
    LiveMesh copy = *live_;
    auto stream = write_progressive_mesh(copy.release(), write);
    if (!stream) return stream.error();
    // Of a mesh that has vanished from the base, a triangle of the full one stands in.
    bake::Scene whole = *source_.scene;
    whole.mesh = source_.mesh;
    return bake::encode_progressive_scene(whole, level(0), *stream);
}

}  // namespace vsplit::studio
