// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The column of controls at the left: labels, buttons and sliders, drawn with the renderer's own text.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../edit/heat.hpp"

class vtkRenderer;

namespace vsplit::studio {

/// One control. Cells of a line share its width.
struct Cell {
    enum class Kind : std::uint8_t { kTitle, kLabel, kButton, kSlider };
    Kind kind = Kind::kLabel;
    std::string text;
    int id = 0;       ///< What a click is told by; 0: not for clicking.
    bool on = false;  ///< Of a button: pressed.
    bool enabled = true;
    double value = 0;           ///< Of a slider: 0 to 1.
    std::optional<Rgb> swatch;  ///< A square of colour before the text.
    bool operator==(const Cell&) const = default;
};

using Line = std::vector<Cell>;

class Panel {
  public:
    static constexpr int kWidth = 264;

    /// Draws into a renderer of its own, whose viewport is the window's left kWidth pixels.
    explicit Panel(vtkRenderer* renderer);
    ~Panel();

    /// Lays the lines out from the top of `height` pixels, closer if they would not fit. What the next
    /// picture draws is only what differs from what was drawn: a text costs as much as a thousand triangles.
    void set(const std::vector<Line>& lines, int height);

    /// The picture has been made.
    void drawn();

    struct Press {
        int id = 0;
        double value = 0;  ///< Along the cell, 0 to 1.
    };
    /// What is at a pixel, from the window's top left.
    std::optional<Press> at(int x, int y) const;
    /// The value along cell `id` at x, even beyond its ends: 0 to 1.
    double along(int id, int x) const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// A text over the whole view: help, a question. Empty hides it.
class Sheet {
  public:
    explicit Sheet(vtkRenderer* renderer);
    ~Sheet();
    void show(const std::string& text, int width, int height);
    bool visible() const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace vsplit::studio
