// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "wedge_record.hpp"

#include <algorithm>
#include <cstring>

namespace vsplit::bake {
namespace {

/// Reads a record backwards: wedges are born, triangles open, vertices move back.
class Replay {
  public:
    Replay(const StarMesh& mesh, const WedgeValues& values, const Mesh& input,
           const std::vector<float>& weights)
        : mesh_(mesh),
          values_(values),
          stride_(values.stride()),
          weights_(weights),
          births_(input.positions.size(), kNoVertex),
          triangle_births_(mesh.triangle_count(), kNoVertex),
          corners_(mesh.triangle_count()),
          places_(mesh.vertex_count()) {
        for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) corners_[t] = mesh.corners(t);
        for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) places_[v] = mesh.raw_position(v);
        out.triangles.reserve(mesh.triangle_count());
    }

    bool is_born(std::uint32_t wedge) const { return births_[wedge] != kNoVertex; }
    std::uint32_t birth(std::uint32_t wedge) const { return births_[wedge]; }
    const std::vector<std::uint32_t>& births() const { return births_; }

    void bear(std::uint32_t wedge, std::uint32_t point, std::uint32_t parent, std::span<const float> values) {
        births_[wedge] = std::uint32_t(out.positions.size());
        out.positions.push_back(places_[point]);
        out.parents.push_back(parent);
        if (!weights_.empty()) out.weights.push_back(weights_[point]);
        birth_values.insert(birth_values.end(), values.begin(), values.end());
    }

    /// Opens a triangle; wedges that no other triangle had come with it.
    void open(std::uint32_t t) {
        triangle_births_[t] = std::uint32_t(out.triangles.size());
        Triangle born;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t wedge = corners_[t][k];
            if (!is_born(wedge)) bear(wedge, mesh_.triangle(t)[k], kNoVertex, values_.of(wedge));
            born[k] = births_[wedge];
        }
        out.triangles.push_back(born);
        if (mesh_.has_groups()) out.groups.push_back(mesh_.group(t));
    }

    /// A corner goes back to the wedge it had.
    void give_back(std::uint32_t corner, std::uint32_t before) {
        std::uint32_t& wedge = corners_[corner / 3][corner % 3];
        if (wedge == before) return;  // transferred
        wedge = before;
        out.corner_changes.push_back({3 * triangle_births_[corner / 3] + corner % 3, births_[wedge]});
    }

    void move(std::uint32_t wedge, std::uint32_t point, std::span<const float> values) {
        out.moves.push_back({births_[wedge], places_[point], weights_.empty() ? 1.0f : weights_[point]});
        move_values.insert(move_values.end(), values.begin(), values.end());
    }
    void place(std::uint32_t point, const Float3& position, float weight) {
        places_[point] = position;
        if (!weights_.empty()) weights_[point] = weight;
    }

    void end_split(float error) {
        out.splits.push_back({std::uint32_t(out.positions.size()), std::uint32_t(out.triangles.size()),
                              std::uint32_t(out.corner_changes.size()), std::uint32_t(out.moves.size()),
                              error});
    }

    /// Leaves out moves that change nothing.
    void drop_idle_moves() {
        std::vector<Float3> places(out.positions);
        std::vector<float> weights(out.weights), values(birth_values);
        std::uint32_t from = 0, kept = 0;
        for (Split& split : out.splits) {
            for (; from < split.moves_end; ++from) {
                const VertexMove move = out.moves[from];
                float* now = values.data() + std::size_t{stride_} * move.vertex;
                const float* then = move_values.data() + std::size_t{stride_} * from;
                const bool idle = std::memcmp(&places[move.vertex], &move.position, sizeof(Float3)) == 0 &&
                                  (weights.empty() || weights[move.vertex] == move.weight) &&
                                  (stride_ == 0 || std::memcmp(now, then, stride_ * sizeof(float)) == 0);
                places[move.vertex] = move.position;
                if (!weights.empty()) weights[move.vertex] = move.weight;
                std::copy_n(then, stride_, now);
                if (idle) continue;
                std::copy_n(then, stride_, move_values.begin() + std::ptrdiff_t(std::size_t{stride_} * kept));
                out.moves[kept++] = move;
            }
            split.moves_end = kept;
        }
        out.moves.resize(kept);
        move_values.resize(std::size_t{stride_} * kept);
    }

    /// From rows of all attributes to a column each.
    void share_out(const Mesh& input) {
        std::size_t begin = 0;
        for (const Attribute& from : input.attributes) {
            Attribute attribute{from.name, from.semantic, from.components, {}};
            const auto column = [&](const std::vector<float>& rows) {
                std::vector<float> values;
                values.reserve(stride_ == 0 ? 0 : rows.size() / stride_ * from.components);
                for (std::size_t row = begin; row < rows.size(); row += stride_)
                    values.insert(values.end(), rows.begin() + std::ptrdiff_t(row),
                                  rows.begin() + std::ptrdiff_t(row + from.components));
                return values;
            };
            attribute.values = column(birth_values);
            out.moved_values.push_back(column(move_values));
            out.attributes.push_back(std::move(attribute));
            begin += from.components;
        }
    }

    /// Of each pose, behind the attributes.
    void share_out_poses(std::size_t begin, std::vector<PosedRecord>& posed) const {
        const auto column = [&](const std::vector<float>& rows, std::size_t at) {
            std::vector<Float3> places;
            for (std::size_t row = at; row < rows.size(); row += stride_)
                places.push_back({rows[row], rows[row + 1], rows[row + 2]});
            return places;
        };
        for (std::size_t at = begin; at < stride_; at += 3)
            posed.push_back({column(birth_values, at), column(move_values, at)});
    }

    ProgressiveMesh out;
    std::vector<float> birth_values, move_values;

  private:
    const StarMesh& mesh_;
    const WedgeValues& values_;
    std::uint32_t stride_;
    std::vector<float> weights_;  // of points, now
    std::vector<std::uint32_t> births_, triangle_births_;
    std::vector<Triangle> corners_;  // now
    std::vector<Float3> places_;     // of points, now
};

}  // namespace

void WedgeRecord::add(const WedgeStar& star, const WedgeValues& values) {
    pairs.insert(pairs.end(), star.pairs.begin(), star.pairs.end());
    const auto keep = [&](std::uint32_t wedge) {
        moved.push_back(wedge);
        const auto old = values.of(wedge);
        moved_values.insert(moved_values.end(), old.begin(), old.end());
    };
    for (const std::uint32_t wedge : star.moved) keep(wedge);
    own_ = std::uint32_t(moved.size());
    for (const std::uint32_t wedge : star.transferred) keep(wedge);
}

void WedgeRecord::append(const WedgeRecord& other, std::size_t begin, std::size_t end, std::uint32_t stride) {
    if (begin == end) return;
    const Ends from = begin == 0 ? Ends{} : other.ends[begin - 1], to = other.ends[end - 1];
    const Ends now{std::uint32_t(pairs.size()), 0, std::uint32_t(moved.size()),
                   std::uint32_t(corner_wedges.size())};
    for (std::size_t i = begin; i < end; ++i) {
        const Ends& e = other.ends[i];
        ends.push_back({e.pairs - from.pairs + now.pairs, e.own - from.moved + now.moved,
                        e.moved - from.moved + now.moved, e.corners - from.corners + now.corners});
    }
    pairs.insert(pairs.end(), other.pairs.begin() + from.pairs, other.pairs.begin() + to.pairs);
    moved.insert(moved.end(), other.moved.begin() + from.moved, other.moved.begin() + to.moved);
    moved_values.insert(moved_values.end(),
                        other.moved_values.begin() + std::ptrdiff_t(std::size_t{stride} * from.moved),
                        other.moved_values.begin() + std::ptrdiff_t(std::size_t{stride} * to.moved));
    corner_wedges.insert(corner_wedges.end(), other.corner_wedges.begin() + from.corners,
                         other.corner_wedges.begin() + to.corners);
}

ProgressiveMesh finish_with_wedges(const Record& record, const WedgeRecord& wedges, const StarMesh& mesh,
                                   const WedgeValues& values, const Mesh& input,
                                   const std::vector<float>& weights, WedgeExtras& extras) {
    Replay replay(mesh, values, input, weights);
    std::vector<bool> is_removed(mesh.triangle_count(), false);
    for (const std::uint32_t t : record.removed) is_removed[t] = true;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        if (!is_removed[t]) replay.open(t);
    replay.out.base_vertices = std::uint32_t(replay.out.positions.size());
    replay.out.base_triangles = std::uint32_t(replay.out.triangles.size());

    for (std::size_t i = record.size(); i-- > 0;) {
        const Record::Step &step = record.steps()[i],
                           before = i == 0 ? Record::Step{} : record.steps()[i - 1];
        const WedgeRecord::Ends end = wedges.ends[i],
                                begin = i == 0 ? WedgeRecord::Ends{} : wedges.ends[i - 1];
        if (step.child != kNoVertex) {
            const auto pairs = std::span(wedges.pairs).subspan(begin.pairs, end.pairs - begin.pairs);
            replay.place(step.parent, step.parent_position, record.parent_weight(i));
            const auto stride = std::size_t{values.stride()};
            std::vector<bool> was_there;
            for (std::uint32_t j = begin.moved; j < end.moved; ++j)
                was_there.push_back(replay.is_born(wedges.moved[j]));
            // A wedge whose last triangles went with the edge comes back with them, without a parent.
            for (const WedgePair& pair : pairs)
                replay.bear(pair.child, step.child,
                            replay.is_born(pair.parent) ? replay.birth(pair.parent) : kNoVertex,
                            values.of(pair.child));
            for (std::uint32_t j = begin.moved; j < end.moved; ++j) {
                const auto old = std::span(wedges.moved_values).subspan(stride * j, stride);
                const std::uint32_t point = j < end.own ? step.parent : step.child;
                if (was_there[j - begin.moved])
                    replay.move(wedges.moved[j], point, old);
                else
                    replay.bear(wedges.moved[j], point, kNoVertex, old);
            }
            const std::size_t first = replay.out.corner_changes.size();
            for (std::uint32_t j = before.corners_end; j < step.corners_end; ++j)
                replay.give_back(record.corners_changed[j],
                                 wedges.corner_wedges[begin.corners + j - before.corners_end]);
            std::sort(replay.out.corner_changes.begin() + std::ptrdiff_t(first),
                      replay.out.corner_changes.end(),
                      [](const CornerChange& a, const CornerChange& b) { return a.corner < b.corner; });
        }
        for (std::uint32_t j = before.removed_end; j < step.removed_end; ++j) replay.open(record.removed[j]);
        replay.end_split(step.error);
    }
    replay.drop_idle_moves();
    replay.share_out(input);
    replay.share_out_poses(values.plain(), extras.posed);
    extras.births = replay.births();
    return std::move(replay.out);
}

}  // namespace vsplit::bake
