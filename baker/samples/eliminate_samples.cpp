// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "surfaces.hpp"

namespace vsplit::bake {
namespace {

/// Points in a grid of cubes, found by sorting their cells.
class PointGrid {
  public:
    PointGrid(const std::vector<Double3>& points, double cell)
        : points_(points), cell_(cell), order_(points.size()) {
        low_ = points[0];
        for (const Double3& p : points)
            low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
        std::vector<std::uint64_t> cells(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) cells[i] = cell_of(points[i], 0, 0, 0);
        std::iota(order_.begin(), order_.end(), 0u);
        std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
            return cells[a] != cells[b] ? cells[a] < cells[b] : a < b;
        });
        cells_.reserve(points.size());
        for (const std::uint32_t i : order_) cells_.push_back(cells[i]);
    }

    /// Calls `visit(j, squared distance)` for all other points within `radius` <= cell of point i, in a fixed
    /// order.
    template <class Visit>
    void for_neighbours(std::uint32_t i, double radius, Visit&& visit) const {
        const Double3 p = points_[i];
        for (int dz = -1; dz <= 1; ++dz)
            for (int dy = -1; dy <= 1; ++dy) {
                // Three cells along x follow each other.
                const std::uint64_t first = cell_of(p, -1, dy, dz), last = cell_of(p, 1, dy, dz);
                auto at = std::lower_bound(cells_.begin(), cells_.end(), first);
                for (; at != cells_.end() && *at <= last; ++at) {
                    const std::uint32_t j = order_[static_cast<std::size_t>(at - cells_.begin())];
                    const Double3 q = points_[j];
                    const double x = q.x - p.x, y = q.y - p.y, z = q.z - p.z, d2 = x * x + y * y + z * z;
                    if (j != i && d2 < radius * radius) visit(j, d2);
                }
            }
    }

  private:
    std::uint64_t cell_of(const Double3& p, int dx, int dy, int dz) const {
        const auto along = [&](double d, int shift) {
            return static_cast<std::uint64_t>(static_cast<std::int64_t>(d / cell_) + 1 + shift);
        };
        return along(p.x - low_.x, dx) | along(p.y - low_.y, dy) << 21 | along(p.z - low_.z, dz) << 42;
    }

    const std::vector<Double3>& points_;
    double cell_;
    Double3 low_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint64_t> cells_;
};

/// A binary heap of all points, most crowded first, whose entries can sink when their neighbours go.
class CrowdHeap {
  public:
    explicit CrowdHeap(std::vector<double>& crowding)
        : crowding_(crowding), heap_(crowding.size()), place_(crowding.size()) {
        std::iota(heap_.begin(), heap_.end(), 0u);
        std::sort(heap_.begin(), heap_.end(), [&](std::uint32_t a, std::uint32_t b) { return before(a, b); });
        for (std::size_t h = 0; h < heap_.size(); ++h) place_[heap_[h]] = static_cast<std::uint32_t>(h);
    }
    std::size_t size() const { return heap_.size(); }
    bool contains(std::uint32_t i) const { return place_[i] != kGone; }
    std::uint32_t pop() {
        const std::uint32_t top = heap_[0], last = heap_.back();
        heap_.pop_back();
        place_[top] = kGone;
        if (!heap_.empty()) {
            put(0, last);
            sink(0);
        }
        return top;
    }
    void lower(std::uint32_t i, double by) {
        crowding_[i] -= by;
        sink(place_[i]);
    }

  private:
    static constexpr std::uint32_t kGone = ~0u;
    /// Ties go to the later point, so that the order is total.
    bool before(std::uint32_t a, std::uint32_t b) const {
        return crowding_[a] != crowding_[b] ? crowding_[a] > crowding_[b] : a > b;
    }
    void put(std::size_t h, std::uint32_t i) {
        heap_[h] = i;
        place_[i] = static_cast<std::uint32_t>(h);
    }
    void sink(std::size_t h) {
        const std::uint32_t i = heap_[h];
        for (std::size_t child; (child = 2 * h + 1) < heap_.size(); h = child) {
            if (child + 1 < heap_.size() && before(heap_[child + 1], heap_[child])) ++child;
            if (!before(heap_[child], i)) break;
            put(h, heap_[child]);
        }
        put(h, i);
    }

    std::vector<double>& crowding_;
    std::vector<std::uint32_t> heap_, place_;
};

}  // namespace

std::vector<Double3> eliminate_samples(const std::vector<Double3>& points, std::size_t count, double area) {
    if (points.size() <= count) return points;
    // Twice the largest radius that `count` discs on this area can have.
    const double reach = 2 * std::sqrt(area / (2 * 1.7320508075688772 * static_cast<double>(count)));
    const PointGrid grid(points, reach);
    const auto crowd = [reach](double d2) {
        double w = 1 - std::sqrt(d2) / reach;
        w *= w;
        w *= w;
        return w * w;
    };
    std::vector<double> crowding(points.size(), 0);
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        grid.for_neighbours(static_cast<std::uint32_t>(i), reach,
                            [&](std::uint32_t, double d2) { crowding[i] += crowd(d2); });
    });
    CrowdHeap heap(crowding);
    while (heap.size() > count)
        grid.for_neighbours(heap.pop(), reach, [&](std::uint32_t j, double d2) {
            if (heap.contains(j)) heap.lower(j, crowd(d2));
        });
    std::vector<Double3> kept;
    kept.reserve(count);
    for (std::uint32_t i = 0; i < points.size(); ++i)
        if (heap.contains(i)) kept.push_back(points[i]);
    return kept;
}

}  // namespace vsplit::bake
