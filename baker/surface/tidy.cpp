// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/tidy.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vsplit::bake {
namespace {

double quality(Vec3 a, Vec3 b, Vec3 c) {
    const double squares = squared_length(b - a) + squared_length(c - b) + squared_length(a - c);
    return squares > 0 ? 2 * std::sqrt(3.0) * length(cross(b - a, c - a)) / squares : 0;
}

/// A crust whose triangles come and go. Only vertices near a repair keep a list of their triangles up to
/// date.
class Tidier {
  public:
    Tidier(Crust& crust, double worst) : crust_(crust), worst_(worst), starts_(crust.points.size() + 1, 0) {
        for (const Triangle& t : crust_.triangles)
            for (const std::uint32_t v : t) ++starts_[v + 1];
        for (std::size_t v = 1; v < starts_.size(); ++v) starts_[v] += starts_[v - 1];
        around_.resize(starts_.back());
        std::vector<std::uint32_t> cursor(starts_.begin(), starts_.end() - 1);
        for (std::uint32_t t = 0; t < crust_.triangles.size(); ++t)
            for (const std::uint32_t v : crust_.triangles[t]) around_[cursor[v]++] = t;
        changed_.assign(crust_.points.size(), kNoEdge);
        alive_.assign(crust_.triangles.size(), 1);
    }

    void run(TidyReport& report) {
        std::vector<std::uint32_t> todo, next;
        for (std::uint32_t t = 0; t < crust_.triangles.size(); ++t)
            if (quality_of(t) < worst_) todo.push_back(t);
        // A repair may make the next one possible; a few rounds reach what can be reached.
        for (int round = 0; round < 4 && !todo.empty(); ++round) {
            next.clear();
            for (const std::uint32_t t : todo) {
                if (!alive_[t] || quality_of(t) >= worst_ || repair(t, report)) continue;
                next.push_back(t);
            }
            if (next.size() == todo.size()) break;
            todo.swap(next);
        }
        std::vector<Triangle> kept;
        kept.reserve(crust_.triangles.size());
        for (std::uint32_t t = 0; t < crust_.triangles.size(); ++t) {
            if (!alive_[t]) continue;
            kept.push_back(crust_.triangles[t]);
            report.slivers_left += quality_of(t) < worst_;
        }
        crust_.triangles = std::move(kept);
        drop_unused(crust_);
    }

  private:
    Vec3 point(std::uint32_t v) const { return crust_.points[v]; }
    double quality_of(std::uint32_t t) const {
        const Triangle& c = crust_.triangles[t];
        return quality(point(c[0]), point(c[1]), point(c[2]));
    }
    std::span<const std::uint32_t> around(std::uint32_t v) const {
        if (changed_[v] != kNoEdge) return lists_[changed_[v]];
        return std::span(around_).subspan(starts_[v], starts_[v + 1] - starts_[v]);
    }
    std::vector<std::uint32_t>& list(std::uint32_t v) {
        if (changed_[v] == kNoEdge) {
            const auto old = around(v);
            lists_.emplace_back(old.begin(), old.end());
            changed_[v] = static_cast<std::uint32_t>(lists_.size() - 1);
        }
        return lists_[changed_[v]];
    }
    void leave(std::uint32_t v, std::uint32_t t) { std::erase(list(v), t); }

    static bool has(const Triangle& t, std::uint32_t v) { return t[0] == v || t[1] == v || t[2] == v; }

    /// Triangles on the edge; false unless there are two, so that an edge of the boundary is left alone.
    bool on_edge(std::uint32_t u, std::uint32_t v, std::array<std::uint32_t, 2>& both) const {
        std::size_t count = 0;
        for (const std::uint32_t t : around(u))
            if (has(crust_.triangles[t], v)) {
                if (count == 2) return false;
                both[count++] = t;
            }
        return count == 2;
    }

    void neighbours(std::uint32_t v, std::vector<std::uint32_t>& result) const {
        result.clear();
        for (const std::uint32_t t : around(v))
            for (const std::uint32_t w : crust_.triangles[t])
                if (w != v) result.push_back(w);
        std::sort(result.begin(), result.end());
    }

    /// Every neighbour of an inner vertex is met twice.
    bool inner(const std::vector<std::uint32_t>& sorted) const {
        for (std::size_t i = 0; i < sorted.size(); i += 2)
            if (i + 1 >= sorted.size() || sorted[i] != sorted[i + 1]) return false;
        return !sorted.empty();
    }

    bool repair(std::uint32_t t, TidyReport& report) {
        const Triangle c = crust_.triangles[t];
        std::array<std::pair<double, std::size_t>, 3> edges;
        for (std::size_t k = 0; k < 3; ++k)
            edges[k] = {squared_length(point(c[(k + 1) % 3]) - point(c[k])), k};
        std::sort(edges.begin(), edges.end());
        const std::size_t least = edges[0].second, most = edges[2].second;
        if (edges[0].first <= 0.04 * edges[2].first) {
            const std::uint32_t u = c[least], v = c[(least + 1) % 3];
            if (collapse(u, v) || collapse(v, u)) {
                ++report.edges_collapsed;
                return true;
            }
        }
        if (flip(t, c[most], c[(most + 1) % 3], c[(most + 2) % 3])) {
            ++report.edges_flipped;
            return true;
        }
        return false;
    }

    /// Moves u to v. Twins of the link condition (Dey, Edelsbrunner, Guha, Nekhayev, "Topology preserving
    /// edge contraction", 1999) for inner vertices: the ends share exactly the two vertices opposite to the
    /// edge.
    bool collapse(std::uint32_t u, std::uint32_t v) {
        std::array<std::uint32_t, 2> both{};
        if (!on_edge(u, v, both)) return false;
        neighbours(u, near_u_);
        neighbours(v, near_v_);
        if (!inner(near_u_)) return false;
        near_u_.erase(std::unique(near_u_.begin(), near_u_.end()), near_u_.end());
        near_v_.erase(std::unique(near_v_.begin(), near_v_.end()), near_v_.end());
        common_.clear();
        std::set_intersection(near_u_.begin(), near_u_.end(), near_v_.begin(), near_v_.end(),
                              std::back_inserter(common_));
        if (common_.size() != 2 || near_u_.size() + near_v_.size() <= 7) return false;
        for (const std::uint32_t w : common_)
            if (around(w).size() <= 3) return false;
        for (const std::uint32_t t : around(u)) {
            const Triangle& c = crust_.triangles[t];
            if (has(c, v)) continue;
            Triangle moved = c;
            for (std::uint32_t& w : moved)
                if (w == u) w = v;
            const Vec3 before = area_normal(crust_, c), after = area_normal(crust_, moved);
            // A triangle without area has no side to turn from, but must not be given a bad one.
            const double q = quality(point(moved[0]), point(moved[1]), point(moved[2]));
            if (q < std::min(worst_, quality_of(t))) return false;
            if (quality_of(t) > 1e-3 && dot(unit(before), unit(after)) < 0.7) return false;
        }
        for (const std::uint32_t t : both) {
            alive_[t] = 0;
            for (const std::uint32_t w : crust_.triangles[t]) leave(w, t);
        }
        const std::vector<std::uint32_t> moving = list(u);
        for (const std::uint32_t t : moving) {
            for (std::uint32_t& w : crust_.triangles[t])
                if (w == u) w = v;
            list(v).push_back(t);
        }
        list(u).clear();
        return true;
    }

    /// The long edge (a, b) of the cap t gives way to one from its apex to the other side.
    bool flip(std::uint32_t t, std::uint32_t a, std::uint32_t b, std::uint32_t apex) {
        std::array<std::uint32_t, 2> both{};
        if (!on_edge(a, b, both)) return false;
        const std::uint32_t other = both[0] == t ? both[1] : both[0];
        std::uint32_t far = kNoEdge;
        for (const std::uint32_t w : crust_.triangles[other])
            if (w != a && w != b) far = w;
        if (far == apex || far == kNoEdge) return false;
        for (const std::uint32_t s : around(apex))
            if (has(crust_.triangles[s], far)) return false;
        if (around(a).size() <= 3 || around(b).size() <= 3) return false;
        const Triangle one{apex, a, far}, two{apex, far, b};
        const Vec3 side = unit(area_normal(crust_, crust_.triangles[other]));
        const double before = std::min(quality_of(t), quality_of(other));
        const double after = std::min(quality(point(one[0]), point(one[1]), point(one[2])),
                                      quality(point(two[0]), point(two[1]), point(two[2])));
        if (after <= before || after < 0.5 * worst_) return false;
        if (dot(unit(area_normal(crust_, one)), side) < 0.5 ||
            dot(unit(area_normal(crust_, two)), side) < 0.5)
            return false;
        crust_.triangles[t] = one;
        crust_.triangles[other] = two;
        leave(b, t);
        leave(a, other);
        list(far).push_back(t);
        list(apex).push_back(other);
        return true;
    }

    Crust& crust_;
    double worst_;
    std::vector<std::uint32_t> starts_, around_, changed_;
    std::vector<std::vector<std::uint32_t>> lists_;
    std::vector<std::uint8_t> alive_;
    std::vector<std::uint32_t> near_u_, near_v_, common_;
};

}  // namespace

void repair_slivers(Crust& crust, double worst, TidyReport& report) {
    Tidier(crust, worst).run(report);
}

void drop_small_components(Crust& crust, std::size_t least, TidyReport& report) {
    std::vector<std::uint32_t> root(crust.points.size());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](std::uint32_t v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    for (const Triangle& t : crust.triangles) {
        root[find(t[1])] = find(t[0]);
        root[find(t[2])] = find(t[0]);
    }
    std::vector<std::size_t> size(crust.points.size(), 0);
    for (const Triangle& t : crust.triangles) ++size[find(t[0])];
    const std::size_t most = size.empty() ? 0 : *std::max_element(size.begin(), size.end());
    const std::size_t bar = std::min(least, most);
    std::size_t kept = 0;
    for (const std::size_t s : size) report.components_dropped += s > 0 && s < bar;
    for (const Triangle& t : crust.triangles)
        if (size[find(t[0])] >= bar) crust.triangles[kept++] = t;
    report.triangles_dropped += crust.triangles.size() - kept;
    if (kept == crust.triangles.size()) return;
    crust.triangles.resize(kept);
    drop_unused(crust);
}

}  // namespace vsplit::bake
