// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The window's state, and what its keys, buttons and strokes do. Private to this folder.
#pragma once

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "../edit/bindings.hpp"
#include "../edit/rebake.hpp"
#include "panel.hpp"
#include "view.hpp"
#include "window.hpp"

namespace vsplit::studio {

/// The process' one window, and its events. VTK 9.1 keeps a list of its interactors on X from which those
/// that are gone are not taken, so that there must be one for all that is shown.
struct Shell {
    vtkNew<vtkRenderWindow> window;
    vtkNew<vtkRenderWindowInteractor> interactor;
};
Shell& shell();

/// A level of the document's record in a viewport.
struct Pane {
    vtkNew<vtkRenderer> renderer;
    std::unique_ptr<MeshView> view;
    std::unique_ptr<LiveMesh> live;
    vtkNew<vtkTextActor> caption;
};

class StudioWindow {
  public:
    StudioWindow(std::unique_ptr<Document> document, const WindowOptions& options);
    ~StudioWindow();
    StudioWindow(const StudioWindow&) = delete;
    StudioWindow& operator=(const StudioWindow&) = delete;

    void run();
    /// Measures frames, strokes and bakes; prints one line each.
    void bench();

    // What the mouse and the keyboard do; x from the left, y from the top.
    bool press(int x, int y, bool paint, bool erase);  ///< False: the camera's.
    bool drag(int x, int y);
    bool release();
    void key(const std::string& name);
    void tick();
    void camera_moves();
    void asked_to_close();
    void resized();
    /// Draws; in motion a coarser level if the one wanted takes too long.
    void draw();
    bool painting() const { return stroke_; }

  private:
    void act(int action, double value);
    void act_on_region(int action);
    void add_region();
    void set_level(std::size_t level);
    void set_split(bool on);
    void layout();
    void refresh_panel();
    std::vector<Line> lines() const;
    void show_pane(Pane& pane, std::size_t level);
    void dab(int x, int y, bool erase);
    void click_select(int x, int y);
    std::optional<Hit> pick_at(int x, int y);
    bool eye_outside() const;
    /// Draws only what the stroke has changed since the last picture, over it.
    void draw_stroke();
    /// What a stroke changed in the right pane; false if nothing.
    bool patch_right();
    void draw_at_full_level();
    bool in_left_pane(int x) const;
    int left_width() const;
    void move();
    void after_change(const std::string& what);
    void autosave();
    void recover();
    std::string beside(const std::string& suffix) const;
    bool write(const std::string& path, std::span<const std::byte> bytes, bool overwrite);
    bool save();
    void load();
    void export_all();
    void apply();
    void take_bake();
    void keep();
    void take_search();
    void cancel();
    /// A bake or a search is going on.
    bool busy() const { return rebake_.running() || search_.running(); }
    /// The panel alone, beside the picture that is there.
    void draw_panel();
    void say(const std::string& text);
    void help();

    std::unique_ptr<Document> document_;
    WindowOptions options_;
    vtkRenderWindow* window_ = shell().window;
    vtkRenderWindowInteractor* interactor_ = shell().interactor;
    vtkNew<vtkRenderer> panel_renderer_, sheet_renderer_;
    std::unique_ptr<Panel> panel_;
    std::unique_ptr<Sheet> sheet_;
    vtkNew<vtkTextActor> status_;
    Pane left_, right_;
    Rebake rebake_;
    WeightSearch search_;
    bool first_pending_ = false;  // nothing of the bake that runs was shown yet
    double progress_drawn_ = 0;
    std::uint64_t baked_version_ = 0;  // of the paint, in the record

    Look look_;
    bool split_ = false, refined_ = false;
    double right_ratio_ = 1;
    std::size_t level_ = 0;
    std::size_t region_ = 1;
    double brush_pixels_ = 24, strength_ = 1, sharp_degrees_ = 45, keep_share_ = 0.95, keep_ratio_ = 0.4;
    unsigned mirror_ = 0;
    int pending_ = kNothing;  // kPart or kMaterial: the next click selects

    bool stroke_ = false, erase_ = false;
    int last_x_ = 0, last_y_ = 0;
    int dragging_ = kNothing;  // a slider
    bool moving_ = false, question_ = false;
    double moved_at_ = 0;
    double budget_ = 150000;          // triangles that a moving picture may have
    bool patchable_ = false;          // the picture that is there can take a stroke's patches
    std::vector<Rgb> right_colours_;  // as the right pane was drawn last, during a stroke
    bool shown_coarse_ = false, panel_stale_ = true;
    std::string message_;
};

double seconds_now();

}  // namespace vsplit::studio
