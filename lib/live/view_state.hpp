// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What a ViewMesh holds. Private to this room.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "split_order.hpp"
#include "view_plan.hpp"
#include "vsplit/view_mesh.hpp"

namespace vsplit {

inline constexpr std::uint32_t kPage = 64;

/// Pages of a buffer that changed.
class Pages {
  public:
    void reserve(std::size_t elements) { pages_.reserve((elements + kPage - 1) / kPage); }
    /// New ones are dirty.
    void resize(std::size_t elements) {
        if (elements_ % kPage != 0 && elements > elements_) mark(std::uint32_t(elements_));
        pages_.resize((elements + kPage - 1) / kPage, 1);
        elements_ = elements;
    }
    void mark(std::uint32_t element) { pages_[element / kPage] = 1; }
    void take(std::size_t alive, std::vector<ViewMesh::Range>& ranges) {
        for (std::size_t page = 0; page < pages_.size(); ++page) {
            if (!std::exchange(pages_[page], std::uint8_t{0}) || page * kPage >= alive) continue;
            const auto begin = std::uint32_t(page * kPage);
            const auto end = std::uint32_t(std::min<std::size_t>(alive, (page + 1) * kPage));
            if (!ranges.empty() && ranges.back().end == begin)
                ranges.back().end = end;
            else
                ranges.push_back({begin, end});
        }
    }
    std::size_t memory() const { return pages_.capacity(); }

  private:
    std::size_t elements_ = 0;
    std::vector<std::uint8_t> pages_;
};

/// An active vertex with what a camera must know of it, side by side: a frame reads them in a row.
struct Front {
    std::uint32_t vertex = 0;
    std::uint32_t following = kNoSplit, current = kNoSplit;  ///< In its chain of splits: to do, and done.
    ViewNode after, done;                                    ///< Of these two.
};

/// A view, and what is the same for all places.
struct Frame {
    explicit Frame(const View& of)
        : view(of),
          most(std::max(of.pixels, 0.0f)),
          least(most * of.hysteresis),
          reach(of.pixels_at_distance_1 / least) {}
    const View& view;
    float most, least;  ///< Pixels: more is wanted, not more than the least is not.
    float reach;        ///< From how far an error of 1 is the least.
};

/// Asks the host's clock every few hundred steps.
class Clock {
  public:
    explicit Clock(const std::function<bool()>& out_of_time) : out_of_time_(out_of_time) {}
    bool late(std::size_t steps) {
        if (!out_of_time_ || steps < next_) return false;
        next_ = steps + 512;
        return out_of_time_();
    }

  private:
    const std::function<bool()>& out_of_time_;
    std::size_t next_ = 512;
};

struct ViewMesh::State {
    ProgressiveMesh mesh;
    ViewRoom room;
    ViewPlan plan;
    std::unique_ptr<ViewPlanner> planner;  ///< None once all splits are known.
    enum class Priority { kAlike, kGiven, kWeights } priority = Priority::kAlike;
    std::vector<float> of_vertex, of_split;  ///< Priorities; empty if all are alike.
    float largest = 1;
    SplitOrder order;
    std::size_t low = 0, high = 0;      ///< Ranks below `low` are applied, from `high` on none is.
    std::size_t late = 0;               ///< Of splits without a rank none from here on is.
    std::vector<std::uint8_t> applied;  ///< Of each split.
    std::vector<std::uint32_t> users;   ///< Of each split: applied ones that need it.
    std::vector<Triangle> drawn;
    std::vector<std::uint32_t> number, slot;  ///< Of a drawn triangle its number, and back.
    std::vector<std::uint32_t> drawn_groups;  ///< Empty if the mesh has none.
    std::vector<Front> active;
    std::vector<std::uint32_t> place;  ///< Of an active vertex: where it is among them.
    std::vector<std::uint32_t> stack, changed;
    std::size_t applied_count = 0, cursor = 0;
    Pages dirty_triangles, dirty_vertices;

    void reserve();
    Status extend(const ProgressiveMesh& source);
    void refresh(std::uint32_t k);
    void weigh(std::size_t from_vertex, std::size_t from_split);
    /// Of refine_to(): any splits may be applied now.
    void forget_place() {
        low = 0;
        high = order.splits.size();
        late = applied.size();
    }
    void prioritise(std::vector<float> first);
    std::vector<float> weights_at_birth() const;
    std::size_t last_rank(const std::vector<std::uint32_t>& ends, std::uint64_t count) const;
    Split before(std::uint32_t k) const {
        return k == 0 ? Split{mesh.base_vertices, mesh.base_triangles, 0, 0, 0} : mesh.splits[k - 1];
    }
    void add_triangle(std::uint32_t t);
    void remove_triangle(std::uint32_t t);
    void apply(std::uint32_t k);
    void undo(std::uint32_t k);
    std::size_t force(std::uint32_t k, std::size_t most);
    void add_vertex(std::uint32_t v);
    void turn(std::uint32_t anchor, std::uint32_t following, std::uint32_t current);
    void visit(const Frame& frame, std::size_t at, std::size_t most, ViewUpdated& result);
    static bool wanted(const Frame& frame, const ViewNode& node) { return pixels(frame, node) > frame.most; }
    static bool unwanted(const Frame& frame, const ViewNode& node) {
        return !(pixels(frame, node) > frame.least);
    }
    static float pixels(const Frame& frame, const ViewNode& node);
};

}  // namespace vsplit
