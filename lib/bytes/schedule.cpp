// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "schedule.hpp"

#include <algorithm>
#include <span>

#include "ask_list.hpp"

namespace vsplit {
namespace {

/// How far a sweep reaches ahead in the record: so many splits for each vertex alive.
constexpr double kReach = 0.7;

/// Which splits of a record must come before which.
class Dependencies {
  public:
    explicit Dependencies(const ProgressiveMesh& mesh);

    std::vector<std::uint32_t> waits_for;  ///< Per split, how many others are still to come before it.
    /// The vertices whose stars a split changes, but for those that it bears.
    std::span<const std::uint32_t> around(std::uint32_t split) const {
        return std::span(around_).subspan(around_begin_[split],
                                          around_begin_[split + 1] - around_begin_[split]);
    }
    template <class Visit>
    void each_follower(std::uint32_t split, Visit visit) const {
        for (std::uint32_t i = begin_[split]; i < begin_[split + 1]; ++i) visit(follower_[i]);
    }

  private:
    void link(std::uint32_t t);
    void replay(const Split& from, const Split& to);

    const ProgressiveMesh& mesh_;
    std::vector<Triangle> corners_;
    std::vector<std::uint32_t> first_, next_;  // chains of corners, one a vertex
    std::vector<std::uint32_t> begin_, follower_, around_;
    std::vector<std::size_t> around_begin_{0};
};

Dependencies::Dependencies(const ProgressiveMesh& mesh) : mesh_(mesh), corners_(mesh.triangles) {
    const auto count = static_cast<std::uint32_t>(mesh.splits.size());
    first_.assign(mesh.positions.size(), kNoVertex);
    next_.assign(3 * mesh.triangles.size(), kNoVertex);
    for (std::uint32_t t = 0; t < mesh.base_triangles; ++t) link(t);

    // Per vertex: the last split that acted on it, and a chain of those that touched it since; what is out of
    // use among these is a chain too.
    struct Touch {
        std::uint32_t split, next;
    };
    std::vector<std::uint32_t> actor(mesh.positions.size(), kNoVertex),
        touched(mesh.positions.size(), kNoVertex);
    std::vector<Touch> touches;
    std::uint32_t unused = kNoVertex;
    std::vector<std::uint32_t> before;  // what each split waits for, split after split
    std::vector<std::uint32_t> acts, around, waits;
    before.reserve(6 * std::size_t{count});
    around_.reserve(9 * std::size_t{count});
    around_begin_.reserve(std::size_t{count} + 1);
    waits_for.assign(count, 0);
    Split from{mesh.base_vertices, mesh.base_triangles, 0, 0, 0};
    for (std::uint32_t s = 0; s < count; ++s) {
        const Split& to = mesh.splits[s];
        acts.clear();
        around.clear();
        for (std::uint32_t v = from.vertices_end; v < to.vertices_end; ++v)
            if (mesh.parents[v] != kNoVertex) acts.push_back(mesh.parents[v]);
        for (std::uint32_t i = from.moves_end; i < to.moves_end; ++i) acts.push_back(mesh.moves[i].vertex);
        std::sort(acts.begin(), acts.end());
        acts.erase(std::unique(acts.begin(), acts.end()), acts.end());
        for (std::uint32_t t = from.triangles_end; t < to.triangles_end; ++t)
            around.insert(around.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
        for (const std::uint32_t v : acts) {
            around.push_back(v);
            for (std::uint32_t c = first_[v]; c != kNoVertex; c = next_[c])
                around.insert(around.end(), corners_[c / 3].begin(), corners_[c / 3].end());
        }
        std::sort(around.begin(), around.end());
        around.erase(std::unique(around.begin(), around.end()), around.end());
        for (const std::uint32_t v : around)
            if (v < from.vertices_end) around_.push_back(v);
        around_begin_.push_back(around_.size());
        waits.clear();
        for (const std::uint32_t v : around)
            if (v < from.vertices_end && actor[v] != kNoVertex) waits.push_back(actor[v]);
        for (const std::uint32_t v : acts) {
            for (std::uint32_t i = touched[v]; i != kNoVertex;) {
                waits.push_back(touches[i].split);
                const std::uint32_t next = touches[i].next;
                touches[i].next = unused;
                unused = i;
                i = next;
            }
            touched[v] = kNoVertex;
            actor[v] = s;
        }
        std::sort(waits.begin(), waits.end());
        waits.erase(std::unique(waits.begin(), waits.end()), waits.end());
        waits_for[s] = static_cast<std::uint32_t>(waits.size());
        before.insert(before.end(), waits.begin(), waits.end());
        for (std::uint32_t v = from.vertices_end; v < to.vertices_end; ++v) actor[v] = s;
        for (const std::uint32_t v : around)
            if (actor[v] != s) {
                std::uint32_t at = unused;
                if (at == kNoVertex) {
                    at = static_cast<std::uint32_t>(touches.size());
                    touches.emplace_back();
                } else {
                    unused = touches[at].next;
                }
                touches[at] = {s, touched[v]};
                touched[v] = at;
            }
        replay(from, to);
        from = to;
    }
    for (auto* done : {&first_, &next_, &actor, &touched}) std::vector<std::uint32_t>().swap(*done);
    std::vector<Triangle>().swap(corners_);
    std::vector<Touch>().swap(touches);
    begin_.assign(count + 1, 0);
    for (const std::uint32_t earlier : before) ++begin_[earlier + 1];
    for (std::uint32_t s = 0; s < count; ++s) begin_[s + 1] += begin_[s];
    follower_.resize(before.size());
    std::vector<std::uint32_t> at(begin_.begin(), begin_.end() - 1);
    std::size_t i = 0;
    for (std::uint32_t s = 0; s < count; ++s)
        for (const std::size_t end = i + waits_for[s]; i < end; ++i) follower_[at[before[i]]++] = s;
}

void Dependencies::link(std::uint32_t t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
        std::uint32_t& first = first_[corners_[t][k]];
        next_[3 * t + k] = first;
        first = 3 * t + k;
    }
}

void Dependencies::replay(const Split& from, const Split& to) {
    for (std::uint32_t i = from.corners_end; i < to.corners_end; ++i) {
        const CornerChange& change = mesh_.corner_changes[i];
        std::uint32_t& corner = corners_[change.corner / 3][change.corner % 3];
        std::uint32_t* at = &first_[corner];
        while (*at != change.corner) at = &next_[*at];
        *at = next_[change.corner];
        corner = change.vertex;
        next_[change.corner] = first_[change.vertex];
        first_[change.vertex] = change.corner;
    }
    for (std::uint32_t t = from.triangles_end; t < to.triangles_end; ++t) link(t);
}

}  // namespace

std::vector<Sweep> schedule(const ProgressiveMesh& mesh, const std::vector<bool>& traded) {
    const auto count = static_cast<std::uint32_t>(mesh.splits.size());
    Dependencies depends(mesh);
    std::vector<std::uint32_t> number(mesh.positions.size(), kNoVertex);  // as written
    for (std::uint32_t v = 0; v < mesh.base_vertices; ++v) number[v] = v;
    std::uint32_t alive = mesh.base_vertices;
    std::vector<bool> made(count, false);

    const auto begin_of = [&](std::uint32_t s) {
        return s == 0 ? mesh.base_vertices : mesh.splits[s - 1].vertices_end;
    };
    std::vector<std::uint32_t> ready(mesh.positions.size(),
                                     kNoVertex);  // per written number, the split it waits for
    std::vector<std::uint32_t> orphans;           // splits without parents that are ready
    const auto make_ready = [&](std::uint32_t s) {
        std::uint32_t least = kNoVertex;
        for (std::uint32_t v = begin_of(s); v < mesh.splits[s].vertices_end; ++v)
            if (mesh.parents[v] != kNoVertex) least = std::min(least, number[mesh.parents[v]]);
        if (least == kNoVertex)
            orphans.push_back(s);
        else
            ready[least] = s;
    };
    for (std::uint32_t s = 0; s < count; ++s)
        if (depends.waits_for[s] == 0) make_ready(s);

    std::vector<std::pair<std::uint32_t, std::uint32_t>> births;  // parent's number, vertex
    std::vector<Sweep> sweeps;
    AskList asks;
    for (std::uint32_t first = 0; first < count;) {
        Sweep& sweep = sweeps.emplace_back();
        sweep.error = mesh.splits[first].error;
        const std::uint64_t reach =
            first + std::max<std::uint64_t>(1, static_cast<std::uint64_t>(kReach * alive));
        const auto make = [&](std::uint32_t s, std::uint32_t primary) {
            sweep.steps.push_back({s, primary});
            made[s] = true;
            births.clear();
            for (std::uint32_t v = begin_of(s); v < mesh.splits[s].vertices_end; ++v)
                births.emplace_back(mesh.parents[v] == kNoVertex ? kNoVertex : number[mesh.parents[v]], v);
            std::stable_sort(births.begin(), births.end(),
                             [](const auto& a, const auto& b) { return a.first < b.first; });
            for (const auto& [parent, v] : births) {
                if (traded[v]) number[mesh.parents[v]] = alive;
                number[v] = traded[v] ? parent : alive;
                asks.add(alive++);
            }
            for (const std::uint32_t v : depends.around(s)) asks.add(number[v]);
            depends.each_follower(s, [&](std::uint32_t t) {
                if (--depends.waits_for[t] == 0) make_ready(t);
            });
        };
        asks.begin(alive);
        for (std::uint32_t v; (v = asks.next()) != kNoVertex;) {
            const std::uint32_t s = ready[v];
            if (s >= reach) continue;
            ready[v] = kNoVertex;
            make(s, v);
        }
        for (std::size_t i = 0; i < orphans.size(); ++i) {
            const std::uint32_t s = orphans[i];
            if (s >= reach) continue;
            orphans[i--] = orphans.back();
            orphans.pop_back();
            make(s, kNoVertex);
        }
        while (first < count && made[first]) ++first;
    }
    return sweeps;
}

}  // namespace vsplit
