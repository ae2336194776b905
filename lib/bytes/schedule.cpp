// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "schedule.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "ask_list.hpp"
#include "sweep_order.hpp"

namespace vsplit {
namespace {

/// How far a sweep reaches ahead in the record: at most and at least so many splits for each vertex alive.
constexpr double kMostReach = 1.4, kLeastReach = 0.3;

/// A record made in batches has about three to five of them each time that its vertices double.
constexpr std::size_t kBatchesADoubling = 8;

/// Which splits of a record must come before which.
class Dependencies {
  public:
    Dependencies(const ProgressiveMesh& mesh, const std::vector<bool>& idle);

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

Dependencies::Dependencies(const ProgressiveMesh& mesh, const std::vector<bool>& idle)
    : mesh_(mesh), corners_(mesh.triangles) {
    const auto count = static_cast<std::uint32_t>(mesh.splits.size());
    first_.assign(mesh.positions.size(), kNoVertex);
    next_.assign(3 * mesh.triangles.size(), kNoVertex);
    for (std::uint32_t t = 0; t < mesh.base_triangles; ++t) link(t);

    // Per vertex: the last split that acted on it, and a chain of those that touched it since; what is out of
    // use among these is a chain too.
    struct Touch {
        std::uint32_t split, next;
    };
    struct Last {
        std::uint32_t actor = kNoVertex, touch = kNoVertex;
    };
    std::vector<Last> last(mesh.positions.size());
    std::vector<Touch> touches;
    std::uint32_t unused = kNoVertex;
    std::vector<std::uint32_t> before;  // what each split waits for, split after split
    std::vector<std::uint32_t> acts, around, waits;
    before.reserve(6 * std::size_t{count});
    around_.reserve(9 * std::size_t{count});
    around_begin_.reserve(std::size_t{count} + 1);
    waits_for.assign(count, 0);

    // A record leaps over the mesh: the memory of the first parent's star is read ahead, one corner and one
    // touch of each of the next splits at a time.
    constexpr std::uint32_t kAhead = 16;
    struct Ahead {
        std::uint32_t parent = kNoVertex, corner = kNoVertex, triangle = kNoVertex, touch = kNoVertex;
        bool open = false;
    };
    std::array<Ahead, kAhead> line;
    const auto advance = [&](Ahead& ahead) {
        if (!ahead.open) {
            if (ahead.parent == kNoVertex) return;
            ahead.open = true;
            ahead.corner = first_[ahead.parent];
            ahead.touch = last[ahead.parent].touch;
        } else {
            if (ahead.triangle != kNoVertex)
                for (const std::uint32_t v : corners_[ahead.triangle]) __builtin_prefetch(&last[v], 1);
            ahead.triangle = ahead.corner == kNoVertex ? kNoVertex : ahead.corner / 3;
            if (ahead.corner != kNoVertex) ahead.corner = next_[ahead.corner];
            if (ahead.touch != kNoVertex) ahead.touch = touches[ahead.touch].next;
        }
        if (ahead.corner != kNoVertex) {
            __builtin_prefetch(&corners_[ahead.corner / 3], 1);
            __builtin_prefetch(&next_[ahead.corner], 1);
        }
        if (ahead.touch != kNoVertex) __builtin_prefetch(&touches[ahead.touch], 1);
    };
    Split from{mesh.base_vertices, mesh.base_triangles, 0, 0, 0};
    for (std::uint32_t s = 0; s < count; ++s) {
        const Split& to = mesh.splits[s];
        for (Ahead& ahead : line) advance(ahead);
        if (s + kAhead < count) {
            Ahead& ahead = line[s % kAhead] = {};
            const std::uint32_t child = mesh.splits[s + kAhead - 1].vertices_end;
            // Not of one that is still to be born: it has nothing yet.
            if (child < mesh.parents.size() && mesh.parents[child] < from.vertices_end) {
                ahead.parent = mesh.parents[child];
                __builtin_prefetch(&first_[ahead.parent]);
                __builtin_prefetch(&last[ahead.parent], 1);
            }
        }
        acts.clear();
        around.clear();
        for (std::uint32_t v = from.vertices_end; v < to.vertices_end; ++v)
            if (mesh.parents[v] != kNoVertex) acts.push_back(mesh.parents[v]);
        for (std::uint32_t i = from.moves_end; i < to.moves_end; ++i)
            if (!idle[i]) acts.push_back(mesh.moves[i].vertex);
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
            if (v < from.vertices_end && last[v].actor != kNoVertex) waits.push_back(last[v].actor);
        for (const std::uint32_t v : acts) {
            for (std::uint32_t i = last[v].touch; i != kNoVertex;) {
                waits.push_back(touches[i].split);
                const std::uint32_t next = touches[i].next;
                touches[i].next = unused;
                unused = i;
                i = next;
            }
            last[v] = {s, kNoVertex};
        }
        std::sort(waits.begin(), waits.end());
        waits.erase(std::unique(waits.begin(), waits.end()), waits.end());
        waits_for[s] = static_cast<std::uint32_t>(waits.size());
        before.insert(before.end(), waits.begin(), waits.end());
        for (std::uint32_t v = from.vertices_end; v < to.vertices_end; ++v) last[v].actor = s;
        for (const std::uint32_t v : around)
            if (last[v].actor != s) {
                std::uint32_t at = unused;
                if (at == kNoVertex) {
                    at = static_cast<std::uint32_t>(touches.size());
                    touches.emplace_back();
                } else {
                    unused = touches[at].next;
                }
                touches[at] = {s, last[v].touch};
                last[v].touch = at;
            }
        replay(from, to);
        from = to;
    }
    std::vector<Last>().swap(last);
    for (auto* done : {&first_, &next_}) std::vector<std::uint32_t>().swap(*done);
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

/// Sweeps of a record that comes in batches.
class Batches {
  public:
    Batches(const ProgressiveMesh& mesh, const std::vector<bool>& traded)
        : mesh_(mesh),
          traded_(traded),
          number_(mesh.positions.size(), kNoVertex),
          changed_(mesh.triangles.size(), 0),
          moved_(mesh.positions.size(), {0, 0}) {
        for (std::uint32_t v = 0; v < mesh.base_vertices; ++v) number_[v] = v;
        alive_ = mesh.base_vertices;
        order_.reserve(mesh.positions.size());
        for (std::uint32_t v = 0; v < mesh.base_vertices; ++v) order_.add(kNoVertex);
    }

    /// Each as long as it can be; none if that makes too many of them. `levels` as halvings() has them.
    std::vector<Sweep> sweeps(const std::vector<std::uint32_t>& levels) {
        const auto count = static_cast<std::uint32_t>(mesh_.splits.size());
        const std::size_t doublings = std::bit_width(mesh_.positions.size() / std::max(alive_, 1u));
        std::vector<Sweep> out;
        for (std::uint32_t first = 0, end = 0; first < count; first = end) {
            if (out.size() >= kBatchesADoubling * (doublings + 1)) return {};
            Sweep& sweep = out.emplace_back();
            sweep.kind = SweepKind::kBatch;
            sweep.error = mesh_.splits[first].error;
            ++sweep_;
            for (end = first; end < count && take(end, sweep); ++end) {
            }
            const auto level = std::upper_bound(levels.begin(), levels.end(), first);
            sweep.reaches_level = level != levels.end() && *level <= end;
            sort(sweep);
            for (const Sweep::Step& step : sweep.steps) bear(step.split);
        }
        return out;
    }

  private:
    Split begin_of(std::uint32_t s) const {
        return s == 0 ? Split{mesh_.base_vertices, mesh_.base_triangles, 0, 0, 0} : mesh_.splits[s - 1];
    }
    /// Adds a split to the sweep, unless it depends on one that is in it.
    bool take(std::uint32_t s, Sweep& sweep) {
        const Split from = begin_of(s), to = mesh_.splits[s];
        std::uint32_t primary = kNoVertex;
        bool trades = false;
        for (std::uint32_t v = from.vertices_end; v < to.vertices_end; ++v) {
            trades |= traded_[v];
            const std::uint32_t parent = mesh_.parents[v];
            if (parent == kNoVertex) continue;
            if (number_[parent] == kNoVertex) return false;  // born in this sweep
            primary = std::min(primary, number_[parent]);
        }
        if (!sweep.steps.empty() && (trades || closed_)) return false;
        for (std::uint32_t c = from.corners_end; c < to.corners_end; ++c)
            if (changed_[mesh_.corner_changes[c].corner / 3] == sweep_) return false;
        for (std::uint32_t m = from.moves_end; m < to.moves_end; ++m) {
            const std::uint32_t v = mesh_.moves[m].vertex;
            if (v < from.vertices_end &&
                (number_[v] == kNoVertex || (moved_[v].sweep == sweep_ && moved_[v].primary != primary)))
                return false;
        }
        for (std::uint32_t t = from.triangles_end; t < to.triangles_end; ++t)
            for (const std::uint32_t v : mesh_.triangles[t])
                if (v < from.vertices_end && number_[v] == kNoVertex) return false;
        for (std::uint32_t m = from.moves_end; m < to.moves_end; ++m)
            moved_[mesh_.moves[m].vertex] = {sweep_, primary};
        bool takes = primary == kNoVertex;
        for (std::uint32_t c = from.corners_end; c < to.corners_end; ++c) {
            changed_[mesh_.corner_changes[c].corner / 3] = sweep_;
            takes |= number_[mesh_.parents[mesh_.corner_changes[c].vertex]] == primary;
        }
        // Where names are traded, other triangles change than the record says: no split but this.
        closed_ = trades;
        // A parent that keeps its triangles may have none left to take.
        if (!takes || trades) sweep.kind = SweepKind::kBatchAll;
        for (std::uint32_t t = from.triangles_end; t < to.triangles_end; ++t) changed_[t] = sweep_;
        sweep.steps.push_back({s, primary});
        return true;
    }
    /// As a decoder comes to them: by numbers where few are marked, else as all are asked.
    void sort(Sweep& sweep) {
        const auto marked = std::count_if(sweep.steps.begin(), sweep.steps.end(),
                                          [](const Sweep::Step& step) { return step.primary != kNoVertex; });
        const bool by_number = is_sparse(static_cast<std::uint32_t>(marked), alive_);
        if (!by_number) {
            order_.list(asked_);
            place_.resize(asked_.size());
            for (std::uint32_t i = 0; i < asked_.size(); ++i) place_[asked_[i]] = i;
        }
        const auto key = [&](const Sweep::Step& step) {
            return by_number || step.primary == kNoVertex ? step.primary : place_[step.primary];
        };
        std::sort(sweep.steps.begin(), sweep.steps.end(), [&](const Sweep::Step& a, const Sweep::Step& b) {
            return a.primary != b.primary ? key(a) < key(b) : a.split < b.split;
        });
    }
    /// Numbers what a split bears.
    void bear(std::uint32_t s) {
        const Split from = begin_of(s), to = mesh_.splits[s];
        births_.clear();
        for (std::uint32_t v = from.vertices_end; v < to.vertices_end; ++v)
            births_.emplace_back(mesh_.parents[v] == kNoVertex ? kNoVertex : number_[mesh_.parents[v]], v);
        std::stable_sort(births_.begin(), births_.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [parent, v] : births_) {
            if (traded_[v]) number_[mesh_.parents[v]] = alive_;
            number_[v] = traded_[v] ? parent : alive_;
            order_.add(parent);
            ++alive_;
        }
    }

    const ProgressiveMesh& mesh_;
    const std::vector<bool>& traded_;
    SweepOrder order_;
    std::vector<std::uint32_t> asked_, place_;  // all vertices in it, and where each is
    std::vector<std::uint32_t> number_;         // as written
    std::vector<std::uint32_t> changed_;        // per triangle, the sweep
    struct Moved {
        std::uint32_t sweep, primary;
    };
    std::vector<Moved> moved_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> births_;  // parent's number, vertex
    std::uint32_t sweep_ = 0, alive_ = 0;
    bool closed_ = false;  // takes no more splits
};

/// How many splits make the mesh in the file as near as the record's is that has half as many triangles as
/// the whole, a quarter, and so on; ascending.
std::vector<std::uint32_t> halvings(const ProgressiveMesh& mesh, const std::function<float(float)>& raised) {
    std::vector<std::uint32_t> levels;
    for (std::uint64_t triangles = mesh.triangles.size() / 2; triangles > mesh.base_triangles;
         triangles /= 2) {
        const double error = error_at(mesh, level_for_triangles(mesh, triangles));
        const auto near = std::partition_point(mesh.splits.begin(), mesh.splits.end(), [&](const Split& s) {
            return double(raised(s.error)) > error;
        });
        levels.push_back(static_cast<std::uint32_t>(near - mesh.splits.begin()));
    }
    std::reverse(levels.begin(), levels.end());
    return levels;
}

}  // namespace

std::vector<Sweep> schedule(const ProgressiveMesh& mesh, const std::vector<bool>& traded,
                            const std::vector<bool>& idle, const std::function<float(float)>& raised) {
    const std::vector<std::uint32_t> levels = halvings(mesh, raised);
    if (auto batches = Batches(mesh, traded).sweeps(levels); !batches.empty()) return batches;
    const auto count = static_cast<std::uint32_t>(mesh.splits.size());
    Dependencies depends(mesh, idle);
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
    SweepOrder order;
    order.reserve(mesh.positions.size());
    for (std::uint32_t v = 0; v < alive; ++v) order.add(kNoVertex);
    std::vector<std::uint32_t> asked, row(mesh.positions.size());
    for (std::uint32_t first = 0; first < count;) {
        Sweep& sweep = sweeps.emplace_back();
        sweep.error = mesh.splits[first].error;
        const auto ahead = [&](double share) {
            return first + std::max<std::uint64_t>(1, static_cast<std::uint64_t>(share * alive));
        };
        const auto level = std::lower_bound(levels.begin(), levels.end(), ahead(kLeastReach));
        const std::uint64_t reach =
            std::min(ahead(kMostReach), level == levels.end() ? count : std::uint64_t{*level});
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
                order.add(parent);
                row[alive] = alive;
                asks.add(alive++);
                asks.add(row[number[v]]);
            }
            for (const std::uint32_t v : depends.around(s)) asks.add(row[number[v]]);
            depends.each_follower(s, [&](std::uint32_t t) {
                if (--depends.waits_for[t] == 0) make_ready(t);
            });
        };
        // As a decoder asks: those that are there in a row, then what the sweep bears, by number.
        order.list(asked);
        for (std::uint32_t i = 0; i < asked.size(); ++i) row[asked[i]] = i;
        asks.begin(alive);
        for (std::uint32_t place; (place = asks.next()) != AskList::kNoPlace;) {
            const std::uint32_t v = place < asked.size() ? asked[place] : place, s = ready[v];
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
        sweep.reaches_level = level != levels.end() && *level <= first;
    }
    return sweeps;
}

}  // namespace vsplit
