// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "bindings.hpp"

#include <algorithm>
#include <vector>

namespace vsplit::studio {
namespace {

constexpr Binding kBindings[] = {{"F1", kHelp, "F1 H", "this help"},
                                 {"h", kHelp, "F1 H", "this help"},
                                 {"Left", kOneCoarser, "Left Right", "one split coarser, finer"},
                                 {"Right", kOneFiner, "Left Right", "one split coarser, finer"},
                                 {"Next", kTenCoarser, "PgDn PgUp", "10 % coarser, finer"},
                                 {"Prior", kTenFiner, "PgDn PgUp", "10 % coarser, finer"},
                                 {"Home", kCoarsest, "Home End", "coarsest, full"},
                                 {"End", kFinest, "Home End", "coarsest, full"},
                                 {"d", kSplit, "D", "two levels side by side"},
                                 {"r", kRefine, "R", "marked regions in full here"},
                                 {"v", kReset, "V", "whole model in view"},
                                 {"s", kSmooth, "S F", "smooth, flat"},
                                 {"f", kFlat, "S F", "smooth, flat"},
                                 {"w", kWire, "W", "edges"},
                                 {"m", kHeatNone, "M", "colours: regions"},
                                 {"e", kHeatError, "E T C Q", "heat: error, weight,"},
                                 {"t", kHeatWeight, "E T C Q", "heat: error, weight,"},
                                 {"c", kHeatCurvature, "E T C Q", "heat: error, weight,"},
                                 {"q", kHeatQuality, "E T C Q", "heat: error, weight,"},
                                 {"n", kAddRegion, "N", "new region"},
                                 {"minus", kLighter, "- =", "region's weight less, more"},
                                 {"equal", kHeavier, "- =", "region's weight less, more"},
                                 {"plus", kHeavier, "- =", "region's weight less, more"},
                                 {"a", kAutomatic, "A", "automatic weight"},
                                 {"k", kKeep, "K", "find the weight that keeps"},
                                 {"bracketleft", kSmallerBrush, "[ ]", "brush smaller, larger"},
                                 {"bracketright", kLargerBrush, "[ ]", "brush smaller, larger"},
                                 {"semicolon", kWeakerBrush, "; '", "brush weaker, stronger"},
                                 {"apostrophe", kStrongerBrush, "; '", "brush weaker, stronger"},
                                 {"x", kMirrorX, "X Y Z", "brush symmetric across"},
                                 {"y", kMirrorY, "X Y Z", "brush symmetric across"},
                                 {"z", kMirrorZ, "X Y Z", "brush symmetric across"},
                                 {"p", kPart, "P", "then click: connected part"},
                                 {"g", kMaterial, "G", "then click: material"},
                                 {"u", kSharp, "U", "select what is sharp"},
                                 {"Control+z", kUndo, "Ctrl+Z Y", "undo, redo"},
                                 {"Control+y", kRedo, "Ctrl+Z Y", "undo, redo"},
                                 {"Return", kApply, "Return", "apply: bake again"},
                                 {"KP_Enter", kApply, "Return", "apply: bake again"},
                                 {"Escape", kCancel, "Esc", "cancel"},
                                 {"Control+s", kSave, "Ctrl+S O", "save, load marks, weights"},
                                 {"Control+o", kLoad, "Ctrl+S O", "save, load marks, weights"},
                                 {"Control+e", kExport, "Ctrl+E", "export"},
                                 {"Control+q", kClose, "Ctrl+Q", "close; asks if unsaved"},
                                 {"1", kRegion + 1, "1 to 9", "choose region"},
                                 {"2", kRegion + 2, "1 to 9", "choose region"},
                                 {"3", kRegion + 3, "1 to 9", "choose region"},
                                 {"4", kRegion + 4, "1 to 9", "choose region"},
                                 {"5", kRegion + 5, "1 to 9", "choose region"},
                                 {"6", kRegion + 6, "1 to 9", "choose region"},
                                 {"7", kRegion + 7, "1 to 9", "choose region"},
                                 {"8", kRegion + 8, "1 to 9", "choose region"},
                                 {"9", kRegion + 9, "1 to 9", "choose region"}};

constexpr Gesture kGestures[] = {{"CTRL + left drag", "smear the region's colour over the model"},
                                 {"SHIFT + left drag", "erase"},
                                 {"left drag", "turn"},
                                 {"middle drag", "shift"},
                                 {"right drag, wheel", "nearer, farther"},
                                 {"left click", "selects, after [Part] or [Material]"},
                                 {"column at the left", "drag sliders, click buttons and regions"}};

std::string padded(std::string_view text, std::size_t width) {
    std::string out(text);
    out.resize(std::max(width, out.size()), ' ');
    return out;
}

}  // namespace

std::span<const Binding> bindings() {
    return kBindings;
}

std::optional<int> action_of(std::string_view key) {
    for (const Binding& binding : kBindings)
        if (binding.key == key) return binding.action;
    return std::nullopt;
}

std::span<const Gesture> gestures() {
    return kGestures;
}

std::string help_text() {
    constexpr std::size_t kHow = 11, kWhat = 29;
    std::vector<std::string> entries;
    std::string_view last;
    for (const Binding& binding : kBindings) {
        if (binding.shown == last) continue;
        last = binding.shown;
        entries.push_back(padded(binding.shown, kHow) + padded(binding.what, kWhat));
        if (binding.action == kHeatError)
            entries.push_back(padded("", kHow) + padded("curvature, triangle quality", kWhat));
    }
    std::vector<std::string> lines{"Paint what matters, press Return, drag the level: it stays.", "",
                                   "MOUSE"};
    for (const Gesture& gesture : kGestures)
        lines.push_back("  " + padded(gesture.how, 20) + std::string(gesture.what));
    lines.insert(lines.end(), {"", "KEYS"});
    const std::size_t rows = (entries.size() + 1) / 2;
    for (std::size_t i = 0; i < rows; ++i)
        lines.push_back("  " + entries[i] + (i + rows < entries.size() ? "  " + entries[i + rows] : ""));
    lines.insert(lines.end(), {"", "Any key or click closes this."});
    std::size_t longest = 0;
    for (const std::string& line : lines) longest = std::max(longest, line.size());
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + padded(line, longest);
    return text;
}

}  // namespace vsplit::studio
