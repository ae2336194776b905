// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What each key does and the mouse does, and the help that says so: the help is made of the table by which
// keys are looked up.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vsplit::studio {

/// What keys and the cells of the panel do. Regions are kRegion + number.
enum Action : int {
    kNothing = 0,
    kRatio,
    kError,
    kRightRatio,
    kSplit,
    kSmooth,
    kFlat,
    kWire,
    kHeatNone,
    kHeatError,
    kHeatWeight,
    kHeatCurvature,
    kHeatQuality,
    kRefine,
    kReset,
    kAddRegion,
    kLighter,
    kHeavier,
    kAutomatic,
    kKeepShare,
    kKeepRatio,
    kKeep,
    kSize,
    kStrength,
    kMirrorX,
    kMirrorY,
    kMirrorZ,
    kPart,
    kMaterial,
    kSharp,
    kSharpDegrees,
    kUndo,
    kRedo,
    kApply,
    kCancel,
    kSave,
    kLoad,
    kExport,
    kHelp,
    kOneCoarser,
    kOneFiner,
    kTenCoarser,
    kTenFiner,
    kCoarsest,
    kFinest,
    kSmallerBrush,
    kLargerBrush,
    kWeakerBrush,
    kStrongerBrush,
    kClose,
    kRegion = 1000
};

/// A key by its X name, after "Control+" if that is held.
struct Binding {
    std::string_view key;
    int action;
    std::string_view shown;  ///< In the help; keys of one line have the same.
    std::string_view what;
};
std::span<const Binding> bindings();
/// Nothing if the key does nothing.
std::optional<int> action_of(std::string_view key);

struct Gesture {
    std::string_view how, what;
};
/// What the mouse does over the model.
std::span<const Gesture> gestures();

/// All of it, lines of one length.
std::string help_text();

}  // namespace vsplit::studio
