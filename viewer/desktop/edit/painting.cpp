// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "painting.hpp"

#include <algorithm>
#include <cassert>

namespace vsplit::studio {

Painting::Painting(std::size_t vertices) : marks_(bake::no_marks(vertices)), touched_(vertices, 0) {}

std::size_t Painting::add_region(std::string name, std::uint32_t colour) {
    if (marks_.regions.size() == bake::Marks::kMaxRegions) return 0;
    const auto taken = [&](const std::string& wanted) {
        return std::any_of(marks_.regions.begin(), marks_.regions.end(),
                           [&](const bake::Region& region) { return region.name == wanted; });
    };
    std::string unique = name;
    for (int i = 2; taken(unique); ++i) unique = name + '-' + std::to_string(i);
    marks_.regions.push_back({std::move(unique), {}, colour});
    return marks_.regions.size();
}

bake::Region& Painting::region(std::size_t number) {
    assert(number >= 1 && number <= marks_.regions.size());
    return marks_.regions[number - 1];
}

void Painting::begin() {
    assert(!open_);
    open_ = true;
    now_.clear();
    ++stroke_;
}

void Painting::mark(std::uint32_t vertex, std::uint8_t region, float strength) {
    assert(open_ && vertex < vertices() && region <= marks_.regions.size());
    if (region == 0) strength = 1;
    std::uint8_t& there = marks_.region[vertex];
    float& how_much = marks_.strength[vertex];
    const bool again = touched_[vertex] == stroke_;
    if (there == region && (how_much == strength || (again && how_much >= strength))) return;
    if (!again) now_.push_back({vertex, there, how_much});
    touched_[vertex] = stroke_;
    there = region;
    how_much = strength;
    changed_.push_back(vertex);
}

bool Painting::end() {
    assert(open_);
    open_ = false;
    if (now_.empty()) return false;
    done_.push_back(std::move(now_));
    now_ = {};
    undone_.clear();
    version_ = ++next_version_;
    return true;
}

void Painting::swap(Stroke& stroke) {
    for (Change& change : stroke) {
        std::swap(change.region, marks_.region[change.vertex]);
        std::swap(change.strength, marks_.strength[change.vertex]);
        changed_.push_back(change.vertex);
    }
    version_ = ++next_version_;
}

bool Painting::undo() {
    if (open_ || done_.empty()) return false;
    swap(done_.back());
    undone_.push_back(std::move(done_.back()));
    done_.pop_back();
    return true;
}

bool Painting::redo() {
    if (open_ || undone_.empty()) return false;
    swap(undone_.back());
    done_.push_back(std::move(undone_.back()));
    undone_.pop_back();
    return true;
}

std::vector<std::uint32_t> Painting::take_changed() {
    std::vector<std::uint32_t> changed;
    changed.swap(changed_);
    return changed;
}

void Painting::replace(bake::Marks marks) {
    assert(marks.region.size() == vertices());
    // Old strokes name regions by number: those must not mean another one.
    done_.clear();
    undone_.clear();
    begin();
    marks_.regions = std::move(marks.regions);
    for (std::uint32_t v = 0; v < vertices(); ++v) {
        if (marks_.region[v] == marks.region[v] && marks_.strength[v] == marks.strength[v]) continue;
        changed_.push_back(v);
        marks_.region[v] = marks.region[v];
        marks_.strength[v] = marks.strength[v];
    }
    open_ = false;
    now_.clear();
    version_ = ++next_version_;
}

}  // namespace vsplit::studio
