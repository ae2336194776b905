// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "star_mesh.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>

namespace vsplit::bake {
namespace {

/// Spreads 21 bits, two zeros between each.
std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x1F00000000FFFFu;
    x = (x | x << 16) & 0x1F0000FF0000FFu;
    x = (x | x << 8) & 0x100F00F00F00F00Fu;
    x = (x | x << 4) & 0x10C30C30C30C30C3u;
    return (x | x << 2) & 0x1249249249249249u;
}

/// The arena's least growth, so that packing it, which looks at all vertices, stays rare.
constexpr std::size_t kLeastRoom = 1 << 16;

template <class Body>
void parallel(std::size_t count, const Body& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
                      });
}

std::uint32_t find_root(std::vector<std::uint32_t>& roots, std::uint32_t i) {
    while (roots[i] != i) i = roots[i] = roots[roots[i]];
    return i;
}

}  // namespace

StarMesh::StarMesh(const Mesh& mesh) : StarMesh(mesh, {}, {}) {}

StarMesh::StarMesh(const Mesh& mesh, const std::vector<Triangle>& corners,
                   const std::vector<std::uint32_t>& groups) {
    const std::size_t vertices = mesh.positions.size();
    Double3 low, high;
    for (std::size_t i = 0; i < vertices; ++i) {
        const Double3 p{mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z};
        if (i == 0) low = high = p;
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Double3 middle = (low + high) * 0.5;
    // A float, so that differences to it are exact in doubles.
    centre_ = {double(float(middle.x)), double(float(middle.y)), double(float(middle.z))};
    const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    int exponent = 0;
    if (extent > 0) std::frexp(extent, &exponent);
    scale_ = std::ldexp(1.0, -exponent);

    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(vertices);
    parallel(vertices, [&](std::size_t i) {
        const Double3 p = work(mesh.positions[i]);
        const auto quantised = [](double c) {
            return static_cast<std::uint64_t>(std::clamp((c + 1) * 0x100000, 0.0, 2097151.0));
        };
        order[i] = {spread(quantised(p.x)) | spread(quantised(p.y)) << 1 | spread(quantised(p.z)) << 2,
                    std::uint32_t(i)};
    });
    tbb::parallel_sort(order.begin(), order.end());
    input_vertices_.resize(vertices);
    vertices_.resize(vertices);
    std::vector<std::uint32_t> renumbered(vertices);
    parallel(vertices, [&](std::size_t i) {
        input_vertices_[i] = order[i].second;
        vertices_[i].position = mesh.positions[order[i].second];
        renumbered[order[i].second] = std::uint32_t(i);
    });
    std::vector<std::pair<std::uint64_t, std::uint32_t>>().swap(order);

    // Triangles by their first vertex on the curve: a counting sort, stable.
    std::vector<std::uint32_t> place(vertices + 1, 0);
    const auto first_of = [&](const Triangle& t) {
        return std::min({renumbered[t[0]], renumbered[t[1]], renumbered[t[2]]});
    };
    for (const Triangle& t : mesh.triangles) ++place[first_of(t) + 1];
    std::partial_sum(place.begin(), place.end(), place.begin());
    triangles_.resize(mesh.triangles.size());
    corners_.resize(corners.size());
    groups_.resize(groups.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const std::uint32_t to = place[first_of(t)]++;
        triangles_[to] = {renumbered[t[0]], renumbered[t[1]], renumbered[t[2]]};
        if (!corners.empty()) corners_[to] = corners[i];
        if (!groups.empty()) groups_[to] = groups[i];
    }

    if (corners.empty()) copies_.merge(triangles_, std::span(place).first(vertices));
    for (const Triangle& t : triangles_)
        for (const std::uint32_t v : t) ++vertices_[v].star_size;
    std::uint32_t begin = 0;
    for (Vertex& v : vertices_) {
        v.star_begin = begin;
        begin += v.star_size;
        v.star_size = 0;
    }
    // Stars that outgrow their place move to the end.
    arena_.resize(begin + begin / 4 + 2 * vertices);
    arena_end_ = begin;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
        for (const std::uint32_t v : triangles_[t])
            arena_[vertices_[v].star_begin + vertices_[v].star_size++] = t;

    live_triangles_ = triangle_count();
    live_vertices_ = 0;
    if (classify() && !has_wedges() && copies_.orient(triangles_)) classify();
}

bool StarMesh::classify() {
    std::atomic<bool> disagree = false;
    tbb::parallel_for(
        tbb::blocked_range<std::uint32_t>(0, vertex_count(), 4096),
        [&](const tbb::blocked_range<std::uint32_t>& range) {
            ClassifyScratch scratch;
            for (std::uint32_t v = range.begin(); v < range.end(); ++v) {
                classify(v, scratch);
                if (kind(v) == VertexKind::kDead || kind(v) == VertexKind::kInner) continue;
                if (std::any_of(scratch.ring.begin(), scratch.ring.end(),
                                [](const Neighbour& n) { return n.out + n.in == 2 && n.out != 1; }))
                    disagree = true;
            }
        });
    live_vertices_ = static_cast<std::uint32_t>(std::count_if(
        vertices_.begin(), vertices_.end(), [](const Vertex& v) { return v.kind != VertexKind::kDead; }));
    return disagree;
}

void StarMesh::classify(std::uint32_t v, ClassifyScratch& scratch) {
    auto& [ring, roots] = scratch;
    Vertex& vertex = vertices_[v];
    vertex.seam = vertex.junction = vertex.open = 0;
    vertex.kind = VertexKind::kFixed;
    if (vertex.star_size == 0) {
        vertex.kind = VertexKind::kDead;
        return;
    }
    if (!has_wedges() && is_closed_fan(v)) {
        vertex.kind = VertexKind::kInner;
        return;
    }
    neighbours_of(*this, v, ring);
    std::size_t special = 0;
    const Neighbour* curve[2] = {};
    for (const Neighbour& n : ring)
        if (n.special()) {
            if (special < 2) curve[special] = &n;
            ++special;
        }
    const auto is_boundary = [](const Neighbour& n) { return n.out + n.in == 1; };
    const auto boundaries = special == 0 ? 0 : std::count_if(ring.begin(), ring.end(), is_boundary);
    vertex.open = boundaries != 0;
    // A curve: two special edges of one kind.
    const bool alike = special == 2 && curve[0]->out + curve[0]->in == curve[1]->out + curve[1]->in &&
                       curve[0]->seam == curve[1]->seam;
    if (special != 0 && !alike) {
        // Several seams, or seams and a boundary, of an orderly fan.
        const bool orderly = std::all_of(ring.begin(), ring.end(), [&](const Neighbour& n) {
            return is_boundary(n) || (n.out == 1 && n.in == 1);
        });
        if (!has_wedges() || !orderly || (boundaries != 0 && boundaries != 2)) return;
        vertex.junction = 1;
    }
    vertex.seam =
        has_wedges() && std::any_of(ring.begin(), ring.end(), [](const Neighbour& n) { return n.seam; });
    // The link must hang together: otherwise several fans meet in this one point.
    roots.resize(ring.size());
    std::iota(roots.begin(), roots.end(), 0u);
    const bool sorted = vertex.star_size > kLargeStar;
    const auto index_of = [&](std::uint32_t w) {
        if (sorted)
            return std::uint32_t(
                std::lower_bound(ring.begin(), ring.end(), w,
                                 [](const Neighbour& n, std::uint32_t x) { return n.vertex < x; }) -
                ring.begin());
        return std::uint32_t(
            std::find_if(ring.begin(), ring.end(), [&](const Neighbour& n) { return n.vertex == w; }) -
            ring.begin());
    };
    for (const std::uint32_t t : star(v)) {
        std::uint32_t ends[2];
        int n = 0;
        for (const std::uint32_t w : triangles_[t])
            if (w != v) ends[n++] = index_of(w);
        roots[find_root(roots, ends[0])] = find_root(roots, ends[1]);
    }
    bool connected = true;
    for (std::uint32_t i = 1; i < ring.size(); ++i) connected &= find_root(roots, i) == find_root(roots, 0);
    if (connected) vertex.kind = special == 0 ? VertexKind::kInner : VertexKind::kCurve;
}

bool StarMesh::is_closed_fan(std::uint32_t v) const {
    constexpr std::size_t kMost = 16;
    std::uint32_t next[kMost], last[kMost];
    const auto fan = star(v);
    if (fan.size() > kMost) return false;
    for (std::size_t i = 0; i < fan.size(); ++i) {
        const Triangle& c = triangles_[fan[i]];
        const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
        next[i] = c[k == 2 ? 0 : k + 1];
        last[i] = c[k == 0 ? 2 : k - 1];
    }
    // From triangle to triangle across the edges at v: back at the first after all of them, and not before.
    std::size_t at = 0;
    for (std::size_t step = 0; step < fan.size(); ++step) {
        const std::uint32_t edge = last[at];
        for (at = 0; at < fan.size() && next[at] != edge; ++at) {
        }
        if (at == fan.size() || (at == 0) != (step + 1 == fan.size())) return false;
    }
    return fan.size() > 2;
}

std::size_t StarMesh::fold(std::uint32_t child, std::uint32_t parent, std::span<const WedgePair> pairs,
                           std::vector<std::uint32_t>& corners_changed, std::vector<std::uint32_t>& removed,
                           std::vector<std::uint32_t>& corner_wedges) {
    const std::size_t first_removed = removed.size();
    const auto has = [&](std::uint32_t t, std::uint32_t v) {
        return triangles_[t][0] == v || triangles_[t][1] == v || triangles_[t][2] == v;
    };
    std::uint32_t kept = 0;
    for (const std::uint32_t t : star(child))
        if (has(t, parent))
            removed.push_back(t);
        else
            ++kept;
    const auto gone = std::span(removed).subspan(first_removed);

    // The parent's star without the removed triangles, then the child's; in place if it fits.
    std::uint32_t size = 0;
    std::size_t taken = 0;
    const std::uint32_t capacity = vertices_[parent].star_size;
    for (std::uint32_t i = 0; i < capacity; ++i) {
        const std::uint32_t t = arena_[vertices_[parent].star_begin + i];
        if (!has(t, child)) arena_[vertices_[parent].star_begin + size++] = t;
    }
    if (size + kept > capacity) {
        taken = size + kept;
        const std::uint32_t begin =
            std::atomic_ref(arena_end_).fetch_add(size + kept, std::memory_order_relaxed);
        std::copy_n(arena_.begin() + vertices_[parent].star_begin, size, arena_.begin() + begin);
        vertices_[parent].star_begin = begin;
    }
    for (std::uint32_t i = 0; i < vertices_[child].star_size; ++i) {
        const std::uint32_t t = arena_[vertices_[child].star_begin + i];
        if (has(t, parent)) continue;
        arena_[vertices_[parent].star_begin + size++] = t;
        const std::uint32_t k = triangles_[t][0] == child ? 0 : triangles_[t][1] == child ? 1 : 2;
        triangles_[t][k] = parent;
        corners_changed.push_back(3 * t + k);
        if (corners_.empty()) continue;
        corner_wedges.push_back(corners_[t][k]);
        for (const WedgePair& pair : pairs)
            if (corners_[t][k] == pair.child) {
                corners_[t][k] = pair.parent;
                break;
            }
    }
    vertices_[parent].star_size = size;
    vertices_[child].star_size = 0;
    vertices_[child].kind = VertexKind::kDead;

    for (const std::uint32_t t : gone)
        for (const std::uint32_t w : triangles_[t])
            if (w != child && w != parent) {
                auto* begin = arena_.data() + vertices_[w].star_begin;
                auto* at = std::find(begin, begin + vertices_[w].star_size, t);
                *at = begin[--vertices_[w].star_size];
            }
    return taken;
}

void StarMesh::grow_room(std::size_t entries) {
    std::size_t used = 0;
    for (const Vertex& v : vertices_) used += v.star_size;
    const std::size_t more = used / 4 + entries + kLeastRoom;
    if (used + used / 8 > arena_end_) {
        arena_.resize(arena_end_ + more);
        return;
    }
    std::vector<std::uint32_t> packed(used + more);
    std::uint32_t end = 0;
    for (Vertex& v : vertices_) {
        std::copy_n(arena_.begin() + v.star_begin, v.star_size, packed.begin() + end);
        v.star_begin = end;
        end += v.star_size;
    }
    arena_ = std::move(packed);
    arena_end_ = end;
}

void StarMesh::vanish(std::span<const std::uint32_t> vertices) {
    for (const std::uint32_t v : vertices) {
        vertices_[v].kind = VertexKind::kDead;
        vertices_[v].star_size = 0;
    }
}

void neighbours_of(const StarMesh& mesh, std::uint32_t v, std::vector<Neighbour>& out) {
    out.clear();
    const auto star = mesh.star(v);
    // A triangle's part of the edges to its second and third corner, seen from v.
    const auto of_triangle = [&](std::uint32_t t, Neighbour(&two)[2]) {
        const Triangle& c = mesh.triangle(t);
        const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
        const std::size_t next = k == 2 ? 0 : k + 1, last = k == 0 ? 2 : k - 1;
        two[0] = {c[next], 1, 0};
        two[1] = {c[last], 0, 1};
        if (!mesh.has_wedges()) return;
        const Triangle& wedges = mesh.corners(t);
        for (Neighbour& n : two) {
            n.here = wedges[k];
            n.there = wedges[&n == &two[0] ? next : last];
            n.group = mesh.group(t);
        }
    };
    const auto join = [](Neighbour& to, const Neighbour& from) {
        to.seam |= from.seam || from.here != to.here || from.there != to.there || from.group != to.group;
        to.out += from.out;
        to.in += from.in;
    };
    Neighbour two[2];
    if (star.size() > kLargeStar) {
        // Hubs of thousands of triangles exist (the poles of a sphere): sort instead of searching.
        for (const std::uint32_t t : star) {
            of_triangle(t, two);
            out.insert(out.end(), two, two + 2);
        }
        std::stable_sort(out.begin(), out.end(),
                         [](const Neighbour& a, const Neighbour& b) { return a.vertex < b.vertex; });
        std::size_t n = 0;
        for (std::size_t i = 1; i < out.size(); ++i) {
            if (out[i].vertex == out[n].vertex)
                join(out[n], out[i]);
            else
                out[++n] = out[i];
        }
        out.resize(n + 1);
        return;
    }
    if (!mesh.has_wedges()) {
        const auto entry = [&](std::uint32_t w) -> Neighbour& {
            for (Neighbour& n : out)
                if (n.vertex == w) return n;
            return out.emplace_back(Neighbour{w});
        };
        for (const std::uint32_t t : star) {
            const Triangle& c = mesh.triangle(t);
            const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
            ++entry(c[k == 2 ? 0 : k + 1]).out;
            ++entry(c[k == 0 ? 2 : k - 1]).in;
        }
        return;
    }
    for (const std::uint32_t t : star) {
        of_triangle(t, two);
        for (const Neighbour& part : two) {
            const auto same = std::find_if(out.begin(), out.end(),
                                           [&](const Neighbour& n) { return n.vertex == part.vertex; });
            if (same == out.end())
                out.push_back(part);
            else
                join(*same, part);
        }
    }
}

}  // namespace vsplit::bake
