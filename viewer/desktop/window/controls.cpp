// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The studio's controls: what the panel shows, and what its cells and the keys do.
#include <fmt/format.h>
#include <vtkCamera.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "studio_window.hpp"
#include "vsplit/bake/files.hpp"

namespace vsplit::studio {
namespace {

constexpr std::uint32_t kColours[] = {0xE6550D, 0x3182BD, 0x31A354, 0x756BB1,
                                      0xE7298A, 0xE6AB02, 0x1B9E77, 0xA6761D};
constexpr double kMinBrush = 3, kMaxBrush = 120;

double error_share(double error, double diagonal) {
    // The slider is logarithmic: from a 10,000th of the diagonal, or less, to a 10th.
    return error <= 0 ? 0 : std::clamp(1 + std::log10(error / diagonal * 10) / 5, 0.0, 1.0);
}

double error_of_share(double share, double diagonal) {
    return share <= 0 ? 0 : diagonal / 10 * std::pow(10, 5 * (share - 1));
}

Cell title(std::string text) {
    Cell cell;
    cell.kind = Cell::Kind::kTitle;
    cell.text = std::move(text);
    return cell;
}
Cell label(std::string text) {
    Cell cell;
    cell.text = std::move(text);
    return cell;
}
Cell button(std::string text, int id, bool on = false, bool enabled = true) {
    Cell cell;
    cell.kind = Cell::Kind::kButton;
    cell.text = std::move(text);
    cell.id = id;
    cell.on = on;
    cell.enabled = enabled;
    return cell;
}
Cell slider(std::string text, int id, double value) {
    Cell cell;
    cell.kind = Cell::Kind::kSlider;
    cell.text = std::move(text);
    cell.id = id;
    cell.value = value;
    return cell;
}

}  // namespace

std::vector<Line> StudioWindow::lines() const {
    const Document& d = *document_;
    const ProgressiveMesh& record = d.live().state();
    const Painting& painting = d.painting();
    const double diagonal = std::max(d.box().diagonal(), 1e-30);
    const double ratio =
        double(triangles_at(record, level_)) / double(std::max<std::size_t>(record.triangles.size(), 1));
    std::vector<Line> all;
    all.push_back({title("Level")});
    all.push_back({slider(fmt::format("{:.1f} % of the triangles", 100 * ratio), kRatio, ratio)});
    const double error = error_at(record, level_);
    all.push_back({slider(fmt::format("error {:.3g} ({:.3f} %)", error, 100 * error / diagonal), kError,
                          error_share(error, diagonal))});
    all.push_back({button("Side by side", kSplit, split_), button("Refine marked", kRefine, refined_)});
    if (split_)
        all.push_back(
            {slider(fmt::format("right: {:.1f} %", 100 * right_ratio_), kRightRatio, right_ratio_)});
    all.push_back({title("Look")});
    all.push_back({button("Smooth", kSmooth, !look_.flat), button("Flat", kFlat, look_.flat),
                   button("Edges", kWire, look_.wireframe)});
    all.push_back({button("Regions", kHeatNone, look_.heat == Heat::kNone),
                   button("Error", kHeatError, look_.heat == Heat::kError),
                   button("Weight", kHeatWeight, look_.heat == Heat::kWeight)});
    all.push_back({button("Curvature", kHeatCurvature, look_.heat == Heat::kCurvature),
                   button("Quality", kHeatQuality, look_.heat == Heat::kQuality), button("Whole", kReset)});
    all.push_back({title("Regions")});
    const auto& regions = painting.marks().regions;
    const std::size_t first = region_ > 5 ? region_ - 5 : 0;
    for (std::size_t r = first; r < std::min(first + 5, regions.size()); ++r) {
        Cell cell = button(fmt::format("{}  weight {:.3g}{}", regions[r].name, d.weight_of(r + 1),
                                       regions[r].weight ? "" : " auto"),
                           kRegion + int(r) + 1, region_ == r + 1);
        cell.swatch = rgb(regions[r].colour);
        all.push_back({cell});
    }
    all.push_back({button("New", kAddRegion), button("-", kLighter), button("+", kHeavier),
                   button("Auto", kAutomatic, !regions[region_ - 1].weight)});
    all.push_back(
        {label(fmt::format("auto: initial {:.3g}, mark {:.3g}", d.automatic().initial, d.automatic().mark))});
    all.push_back({slider(fmt::format("keep {:.0f} %", 100 * keep_share_), kKeepShare, keep_share_),
                   slider(fmt::format("at {:.0f} %", 100 * keep_ratio_), kKeepRatio, keep_ratio_),
                   button("Find", kKeep)});
    all.push_back({title("Brush")});
    all.push_back({slider(fmt::format("size {:.0f}", brush_pixels_), kSize,
                          (brush_pixels_ - kMinBrush) / (kMaxBrush - kMinBrush)),
                   slider(fmt::format("strength {:.0f} %", 100 * strength_), kStrength, strength_)});
    all.push_back({label("mirror"), button("X", kMirrorX, mirror_ & 1), button("Y", kMirrorY, mirror_ & 2),
                   button("Z", kMirrorZ, mirror_ & 4)});
    all.push_back({button("Part", kPart, pending_ == kPart),
                   button("Material", kMaterial, pending_ == kMaterial), button("Sharp", kSharp)});
    all.push_back({slider(fmt::format("sharp: more than {:.0f} degrees", sharp_degrees_), kSharpDegrees,
                          sharp_degrees_ / 120)});
    all.push_back({button("Undo", kUndo, false, painting.can_undo()),
                   button("Redo", kRedo, false, painting.can_redo())});
    all.push_back({title("Bake")});
    if (busy()) {
        const double done = search_.running() ? search_.progress() : rebake_.progress();
        all.push_back(
            {slider(fmt::format("{} {:.0f} %", search_.running() ? "searching" : "baking", 100 * done),
                    kNothing, done),
             button("Cancel", kCancel)});
    } else
        all.push_back({button(painting.version() != baked_version_ ? "Apply (Return)" : "Apply: up to date",
                              kApply, painting.version() != baked_version_)});
    all.push_back({button(painting.unsaved() ? "Save *" : "Save", kSave), button("Load", kLoad),
                   button("Export", kExport)});
    all.push_back({button("Help (F1)", kHelp)});
    return all;
}

void StudioWindow::refresh_panel() {
    panel_->set(lines(), window_->GetSize()[1]);
    panel_stale_ = true;
    const std::string status =
        message_.empty() ? "CTRL + drag paints, SHIFT + drag erases, drag turns, F1 helps" : message_;
    status_->SetInput(status.c_str());
}

void StudioWindow::say(const std::string& text) {
    message_ = text;
    refresh_panel();
}

void StudioWindow::help() {
    sheet_->show(help_text(), window_->GetSize()[0] - Panel::kWidth, window_->GetSize()[1]);
    draw();
}

void StudioWindow::set_level(std::size_t level) {
    level_ = std::min(level, document_->live().max_level());
    document_->go_to(level_);
    refined_ = false;
    move();
    refresh_panel();
    draw();
}

void StudioWindow::set_split(bool on) {
    // Half as wide: what was in view stays in view.
    if (on != split_) left_.renderer->GetActiveCamera()->Dolly(on ? 0.55 : 1 / 0.55);
    split_ = on;
    if (on) right_.live = std::make_unique<LiveMesh>(document_->live());
    layout();
    draw();
}

void StudioWindow::add_region() {
    const std::size_t count = document_->painting().marks().regions.size();
    const std::size_t number = document_->painting().add_region("region-" + std::to_string(count + 1),
                                                                kColours[count % std::size(kColours)]);
    if (number > 0) region_ = number;
}

void StudioWindow::act_on_region(int action) {
    bake::Region& region = document_->painting().region(region_);
    const double now = document_->weight_of(region_);
    if (action == kAutomatic)
        region.weight.reset();
    else
        region.weight = std::clamp(now * (action == kHeavier ? 1.25 : 0.8), 1e-6, 1e12);
    baked_version_ = ~std::uint64_t{0};  // the record has the old weight
    after_change(fmt::format("{}: weight {:.3g}", region.name, document_->weight_of(region_)));
}

void StudioWindow::act(int action, double value) {
    const double diagonal = document_->box().diagonal();
    const auto heat = [&](Heat what) { look_.heat = what; };
    const auto mirror = [&](unsigned bit) { mirror_ ^= bit; };
    if (action > kRegion) region_ = std::size_t(action - kRegion);
    switch (action) {
        case kRatio:
            return set_level(document_->level_for_ratio(value));
        case kError:
            return set_level(level_for_error(document_->live().state(), error_of_share(value, diagonal)));
        case kRightRatio:
            right_ratio_ = value;
            move();
            break;
        case kSplit:
            return set_split(!split_);
        case kSmooth:
            look_.flat = false;
            break;
        case kFlat:
            look_.flat = true;
            break;
        case kWire:
            look_.wireframe = !look_.wireframe;
            break;
        case kHeatNone:
            heat(Heat::kNone);
            break;
        case kHeatError:
            heat(Heat::kError);
            break;
        case kHeatWeight:
            heat(Heat::kWeight);
            break;
        case kHeatCurvature:
            heat(Heat::kCurvature);
            break;
        case kHeatQuality:
            heat(Heat::kQuality);
            break;
        case kRefine:
            refined_ = !refined_;
            moving_ = false;
            break;
        case kReset:
            set_camera(left_.renderer,
                       *camera_for(document_->box(), "iso", left_width(), window_->GetSize()[1]));
            break;
        case kAddRegion:
            add_region();
            break;
        case kLighter:
        case kHeavier:
        case kAutomatic:
            return act_on_region(action);
        case kKeepShare:
            keep_share_ = value;
            break;
        case kKeepRatio:
            keep_ratio_ = value;
            break;
        case kKeep:
            return keep();
        case kSize:
            brush_pixels_ = kMinBrush + value * (kMaxBrush - kMinBrush);
            break;
        case kStrength:
            strength_ = std::max(0.05, value);
            break;
        case kMirrorX:
            mirror(1);
            break;
        case kMirrorY:
            mirror(2);
            break;
        case kMirrorZ:
            mirror(4);
            break;
        case kPart:
        case kMaterial:
            pending_ = pending_ == action ? int(kNothing) : action;
            say(pending_ == kNothing ? "" : "click on the model");
            break;
        case kSharp:
            if (document_->select_sharper_than(sharp_degrees_, std::uint8_t(region_)))
                after_change("selected what is sharp");
            return;
        case kSharpDegrees:
            sharp_degrees_ = 120 * value;
            break;
        case kUndo:
            if (document_->painting().undo()) after_change("undone");
            return;
        case kRedo:
            if (document_->painting().redo()) after_change("redone");
            return;
        case kApply:
            return apply();
        case kCancel:
            pending_ = kNothing;
            say("");
            cancel();
            break;
        case kSave:
            save();
            break;
        case kLoad:
            return load();
        case kExport:
            return export_all();
        case kHelp:
            return help();
        case kClose:
            return asked_to_close();
        case kOneCoarser:
            return set_level(level_ > 0 ? level_ - 1 : 0);
        case kOneFiner:
            return set_level(level_ + 1);
        case kTenCoarser:
        case kTenFiner:
            return set_level(document_->level_for_ratio(
                std::clamp(document_->ratio() + (action == kTenFiner ? 0.1 : -0.1), 0.0, 1.0)));
        case kCoarsest:
            return set_level(0);
        case kFinest:
            return set_level(document_->live().max_level());
        case kSmallerBrush:
            brush_pixels_ = std::max(kMinBrush, brush_pixels_ / 1.2);
            break;
        case kLargerBrush:
            brush_pixels_ = std::min(kMaxBrush, brush_pixels_ * 1.2);
            break;
        case kWeakerBrush:
            strength_ = std::max(0.05, strength_ - 0.1);
            break;
        case kStrongerBrush:
            strength_ = std::min(1.0, strength_ + 0.1);
            break;
        default:
            break;
    }
    refresh_panel();
    draw();
}

void StudioWindow::click_select(int x, int y) {
    const int what = pending_;
    pending_ = kNothing;
    const auto hit = pick_at(x, y);
    const auto number = std::uint8_t(region_);
    if (!hit)
        say("nothing there");
    else if (what == kPart ? document_->select_component(hit->vertex, number)
                           : document_->select_material(hit->triangle, number))
        return after_change(what == kPart ? std::string("selected a part")
                                          : "selected material " + document_->material_of(hit->triangle));
    refresh_panel();
    draw();
}

void StudioWindow::key(const std::string& name) {
    if (question_) {
        if (name == "s" || name == "S") {
            if (save()) interactor_->TerminateApp();
        } else if (name == "d" || name == "D") {
            std::error_code ignored;
            std::filesystem::remove(beside(".autosave.marks"), ignored);
            interactor_->TerminateApp();
        } else if (name == "Escape") {
            question_ = false;
            sheet_->show("", 1, 1);
            draw();
        }
        return;
    }
    if (sheet_->visible()) {
        sheet_->show("", 1, 1);
        return draw();
    }
    // Caps lock is no reason to do nothing.
    std::string folded = name;
    if (folded.size() == 1 || folded.starts_with("Control+"))
        folded.back() = char(std::tolower(static_cast<unsigned char>(folded.back())));
    const std::optional<int> action = action_of(folded);
    if (!action) return;
    if (*action > kRegion && std::size_t(*action - kRegion) > document_->painting().marks().regions.size())
        return;
    act(*action, 0);
}

}  // namespace vsplit::studio
