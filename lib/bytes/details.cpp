// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "details.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "large_pages.hpp"
#include "layout.hpp"

namespace vsplit {
namespace {

/// Behind the weights of all kinds there is an origin that is not zero.
constexpr std::uint8_t kHasOrigin = 1u << kPlaceKinds;

}  // namespace

std::vector<std::byte> encode_details(const Details& details) {
    ByteWriter out;
    const PlaceWeights defaults = default_place_weights();
    std::uint8_t kinds = 0;
    for (std::size_t kind = 0; kind < kPlaceKinds; ++kind)
        if (details.weights[kind] != defaults[kind]) kinds = static_cast<std::uint8_t>(kinds | 1u << kind);
    const bool has_origin = details.origin != std::array<double, 3>{};
    if (has_origin) kinds = static_cast<std::uint8_t>(kinds | kHasOrigin);
    out.put(kinds);
    for (std::size_t kind = 0; kind < kPlaceKinds; ++kind)
        if (kinds >> kind & 1) out.put(details.weights[kind]);
    if (has_origin) out.put(details.origin);
    out.put(static_cast<std::uint16_t>(details.rules.size()));
    for (const ValueRule& rule : details.rules) {
        out.put(static_cast<std::uint8_t>(rule.semantic));
        out.put(static_cast<std::uint8_t>(rule.components));
        out.put(static_cast<std::uint8_t>(rule.coding));
        out.put(static_cast<std::uint8_t>(rule.bits));
        for (std::size_t i = 0; i < rule.step.size(); ++i) {
            out.put(rule.origin[i]);
            out.put(rule.step[i]);
        }
        out.put(static_cast<std::uint16_t>(rule.name.size()));
        for (const char c : rule.name) out.put(c);
    }
    return std::move(out.bytes());
}

std::optional<Details> decode_details(std::span<const std::byte> bytes, const char*& fault, std::size_t& at) {
    Details details;
    at = 0;
    const auto has = [&](std::size_t size) {
        fault = "the details end too early";
        return bytes.size() - at >= size;
    };
    const auto take = [&]<class T>(T& value) {
        value = get<T>(bytes, at);
        at += sizeof(T);
    };
    std::uint16_t count = 0;
    std::uint8_t kinds = 0;
    if (!has(1)) return std::nullopt;
    take(kinds);
    if (kinds & ~(2 * kHasOrigin - 1)) {
        fault = "the details have parts of an unknown kind";
        return std::nullopt;
    }
    details.weights = default_place_weights();
    for (std::size_t kind = 0; kind < kPlaceKinds; ++kind) {
        if (!(kinds >> kind & 1)) continue;
        if (!has(sizeof(details.weights[kind]))) return std::nullopt;
        take(details.weights[kind]);
    }
    if (kinds & kHasOrigin) {
        const std::size_t start = at;
        if (!has(sizeof(details.origin))) return std::nullopt;
        take(details.origin);
        for (const double value : details.origin)
            if (!std::isfinite(value)) {
                fault = "the origin is not finite";
                at = start;
                return std::nullopt;
            }
    }
    if (!has(2)) return std::nullopt;
    take(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        ValueRule rule;
        if (!has(4)) return std::nullopt;
        const std::size_t start = at;
        std::array<std::uint8_t, 4> head;
        take(head);
        rule.semantic = static_cast<Semantic>(head[0]);
        rule.components = head[1];
        rule.coding = static_cast<ValueCoding>(head[2]);
        rule.bits = head[3];
        const bool direction =
            rule.coding == ValueCoding::kOctahedral || rule.coding == ValueCoding::kTangent;
        if (head[0] > static_cast<std::uint8_t>(Semantic::kOther) || rule.components < 1 ||
            rule.components > 16 || head[2] > static_cast<std::uint8_t>(ValueCoding::kTangent) ||
            (direction ? rule.bits < 2 || rule.bits > 16 : rule.bits != 0) ||
            (rule.coding == ValueCoding::kOctahedral && rule.components != 3) ||
            (rule.coding == ValueCoding::kTangent && rule.components != 4)) {
            fault = "an attribute is described by numbers that do not exist";
            at = start;
            return std::nullopt;
        }
        if (rule.coding == ValueCoding::kGrid) {
            if (!has(16 * rule.components)) return std::nullopt;
            for (std::uint32_t c = 0; c < rule.components; ++c) {
                take(rule.origin.emplace_back());
                take(rule.step.emplace_back());
                if (!std::isfinite(rule.origin.back()) || !std::isfinite(rule.step.back()) ||
                    !(rule.step.back() >= 0)) {
                    fault = "an attribute's grid is not finite";
                    return std::nullopt;
                }
            }
        }
        std::uint16_t length = 0;
        if (!has(2)) return std::nullopt;
        take(length);
        if (!has(length)) return std::nullopt;
        rule.name.assign(reinterpret_cast<const char*>(bytes.data()) + at, length);
        at += length;
        details.rules.push_back(std::move(rule));
    }
    if (at != bytes.size()) {
        fault = "the details are longer than they need";
        return std::nullopt;
    }
    // Readers that stream have no other occasion to say so.
    std::vector<Attribute> named;
    for (const ValueRule& rule : details.rules)
        named.push_back({rule.name, rule.semantic, rule.components, {}});
    if (const char* wrong = attributes_fault(named, 0)) {
        fault = wrong;
        at = 0;
        return std::nullopt;
    }
    return details;
}

StreamShape shape_of(const Details& details, bool weights, bool lossless, std::uint32_t largest_group) {
    StreamShape shape;
    shape.lossless = lossless;
    shape.group_bits = static_cast<std::uint32_t>(std::bit_width(largest_group));
    for (const ValueRule& rule : details.rules)
        for (std::uint32_t i = 0; i < rule.numbers(); ++i) {
            shape.mixes.push_back(rule.mixes(i));
            shape.direction_bits.push_back(rule.coding == ValueCoding::kOctahedral && i == 0 ? rule.bits : 0);
        }
    if (weights) {
        shape.mixes.push_back(false);
        shape.direction_bits.push_back(0);
    }
    return shape;
}

MeshOutput::MeshOutput(ProgressiveMesh& mesh, const Lattice& lattice, const Details& details, bool weights,
                       bool lossless, bool groups)
    : mesh_(&mesh),
      lattice_(lattice),
      rules_(details.rules),
      weights_(weights),
      lossless_(lossless),
      groups_(groups) {
    for (const ValueRule& rule : rules_) {
        stride_ += rule.numbers();
        mesh.attributes.push_back({rule.name, rule.semantic, rule.components, {}});
        mesh.moved_values.emplace_back();
    }
    stride_ += weights;
}

void MeshOutput::reserve(std::size_t vertices, std::size_t triangles, std::size_t splits, std::size_t corners,
                         std::size_t moves) {
    reserve_large(mesh_->positions, vertices);
    reserve_large(mesh_->parents, vertices);
    if (weights_) mesh_->weights.reserve(vertices);
    reserve_large(mesh_->triangles, triangles);
    if (groups_) mesh_->groups.reserve(triangles);
    reserve_large(mesh_->splits, splits);
    reserve_large(mesh_->corner_changes, corners);
    reserve_large(mesh_->moves, moves);
    for (std::size_t i = 0; i < rules_.size(); ++i) {
        mesh_->attributes[i].values.reserve(rules_[i].components * vertices);
        mesh_->moved_values[i].reserve(rules_[i].components * moves);
    }
}

Float3 MeshOutput::place(const Lattice3& at, const std::array<std::uint32_t, 3>& finer) {
    if (!lossless_) return lattice_.point(at);
    const Float3 p = lattice_.exact(at, finer);
    sound_ &= std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    return p;
}

void MeshOutput::add_values(const std::int32_t* numbers, bool birth) {
    for (std::size_t i = 0; i < rules_.size(); ++i) {
        auto& to = birth ? mesh_->attributes[i].values : mesh_->moved_values[i];
        to.resize(to.size() + rules_[i].components);
        float* const values = to.data() + to.size() - rules_[i].components;
        rules_[i].restore(numbers, values);
        if (rules_[i].coding == ValueCoding::kFloat)
            sound_ &= std::all_of(values, values + rules_[i].components,
                                  [](float value) { return std::isfinite(value); });
        numbers += rules_[i].numbers();
    }
    if (weights_) {
        const float weight = ordered_float(*numbers);
        sound_ &= weight >= 0;
        if (birth)
            mesh_->weights.push_back(weight);
        else
            mesh_->moves.back().weight = weight;
    }
}

void MeshOutput::add_base(const SplitCodec& codec) {
    mesh_->base_vertices = codec.live.vertex_count();
    mesh_->base_triangles = static_cast<std::uint32_t>(codec.live.triangles.size());
    for (std::uint32_t v = 0; v < mesh_->base_vertices; ++v) {
        mesh_->positions.push_back(
            place(codec.live.vertices[v].at, lossless_ ? codec.finer[v] : std::array<std::uint32_t, 3>{}));
        mesh_->parents.push_back(kNoVertex);
        add_values(codec.values.data() + v * stride_, true);
    }
    mesh_->triangles.insert(mesh_->triangles.end(), codec.live.triangles.begin(), codec.live.triangles.end());
    if (groups_) mesh_->groups.insert(mesh_->groups.end(), codec.groups.begin(), codec.groups.end());
}

void MeshOutput::add(const SplitPlan& plan, float error) {
    ProgressiveMesh& mesh = *mesh_;
    std::uint32_t vertex = static_cast<std::uint32_t>(mesh.positions.size()), begin = 0;
    for (std::size_t i = 0; i < plan.births.size(); ++i, ++vertex) {
        const SplitPlan::Birth& birth = plan.births[i];
        mesh.positions.push_back(place(birth.at, birth.finer));
        mesh.parents.push_back(birth.parent);
        add_values(plan.birth_values.data() + i * stride_, true);
        for (; begin < birth.taken_end; ++begin) mesh.corner_changes.push_back({plan.taken[begin], vertex});
    }
    for (std::size_t i = 0; i < plan.moves.size(); ++i) {
        mesh.moves.push_back({plan.moves[i].vertex, place(plan.moves[i].at, plan.moves[i].finer), 1});
        add_values(plan.move_values.data() + i * stride_, false);
    }
    mesh.triangles.insert(mesh.triangles.end(), plan.triangles.begin(), plan.triangles.end());
    if (groups_) mesh.groups.insert(mesh.groups.end(), plan.groups.begin(), plan.groups.end());
    mesh.splits.push_back({static_cast<std::uint32_t>(mesh.positions.size()),
                           static_cast<std::uint32_t>(mesh.triangles.size()),
                           static_cast<std::uint32_t>(mesh.corner_changes.size()),
                           static_cast<std::uint32_t>(mesh.moves.size()), error});
}

}  // namespace vsplit
