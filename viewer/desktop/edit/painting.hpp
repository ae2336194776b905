// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The paint on a model, stroke by stroke, with its undo.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vsplit/bake/weights.hpp"

namespace vsplit::studio {

/// Marks that change by strokes. A stroke is all between begin() and end(); what changes nothing is no
/// stroke. Regions are added and renamed outside of strokes and are not undone.
class Painting {
  public:
    explicit Painting(std::size_t vertices = 0);

    const bake::Marks& marks() const { return marks_; }
    std::size_t vertices() const { return marks_.region.size(); }

    /// The new region's number, from 1; 0 if there are 255 already. Its name is made unique.
    std::size_t add_region(std::string name, std::uint32_t colour);
    bake::Region& region(std::size_t number);

    void begin();
    /// Marks a vertex: region 0 erases. Of one stroke's dabs the strongest of the region counts.
    void mark(std::uint32_t vertex, std::uint8_t region, float strength);
    /// False if nothing changed.
    bool end();

    bool undo();
    bool redo();
    bool can_undo() const { return !done_.empty(); }
    bool can_redo() const { return !undone_.empty(); }

    /// Vertices changed since the last call.
    std::vector<std::uint32_t> take_changed();
    /// Whether there is paint that mark_saved() has not seen.
    bool unsaved() const { return version_ != saved_; }
    void mark_saved() { saved_ = version_; }
    /// Grows with every change.
    std::uint64_t version() const { return version_; }

    /// Takes marks as one stroke; those must be of as many vertices.
    void replace(bake::Marks marks);

  private:
    struct Change {
        std::uint32_t vertex;
        std::uint8_t region;
        float strength;
    };
    using Stroke = std::vector<Change>;
    /// Puts back what the stroke says, and makes it say what was there.
    void swap(Stroke& stroke);

    bake::Marks marks_;
    std::vector<Stroke> done_, undone_;
    Stroke now_;
    std::vector<std::uint32_t> touched_;  // the stroke, by its number, that last changed a vertex
    std::uint32_t stroke_ = 0;
    bool open_ = false;
    std::vector<std::uint32_t> changed_;
    std::uint64_t version_ = 0, saved_ = 0, next_version_ = 0;
};

}  // namespace vsplit::studio
