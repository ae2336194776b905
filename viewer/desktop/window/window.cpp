// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "window.hpp"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkObjectFactory.h>
#include <vtkRendererCollection.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <chrono>

#include "studio_window.hpp"

namespace vsplit::studio {
namespace {

constexpr double kSettle = 0.25;  // seconds without motion until the full picture
/// So many triangles look the same whether light falls on vertices or on pixels.
constexpr std::size_t kSmoothEnough = 20000;
/// Fewer triangles save nothing that is seen: presenting a picture takes longer than drawing these.
constexpr double kLeastBudget = 12000;
constexpr double kFrame = 0.025;  // seconds that a moving picture is to take: 30 a second with room to spare

/// The trackball, but for what belongs to panel, brush and sliders.
class Style : public vtkInteractorStyleTrackballCamera {
  public:
    static Style* New();
    vtkTypeMacro(Style, vtkInteractorStyleTrackballCamera);
    StudioWindow* window = nullptr;

    void OnLeftButtonDown() override {
        const auto [x, y] = where();
        const bool paint = Interactor->GetControlKey() != 0, erase = Interactor->GetShiftKey() != 0;
        taken_ = window->press(x, y, paint, erase);
        if (taken_) return;
        FindPokedRenderer(Interactor->GetEventPosition()[0], Interactor->GetEventPosition()[1]);
        if (CurrentRenderer) StartRotate();
    }
    void OnLeftButtonUp() override {
        if (taken_)
            window->release();
        else
            EndRotate();
        taken_ = false;
    }
    void OnMouseMove() override {
        const auto [x, y] = where();
        if (taken_) {
            window->drag(x, y);
            return;
        }
        if (State != VTKIS_NONE) window->camera_moves();
        vtkInteractorStyleTrackballCamera::OnMouseMove();
    }
    void OnMiddleButtonDown() override {
        if (!on_panel()) vtkInteractorStyleTrackballCamera::OnMiddleButtonDown();
    }
    void OnRightButtonDown() override {
        if (!on_panel()) vtkInteractorStyleTrackballCamera::OnRightButtonDown();
    }
    void OnMouseWheelForward() override {
        if (on_panel()) return;
        window->camera_moves();
        vtkInteractorStyleTrackballCamera::OnMouseWheelForward();
    }
    void OnMouseWheelBackward() override {
        if (on_panel()) return;
        window->camera_moves();
        vtkInteractorStyleTrackballCamera::OnMouseWheelBackward();
    }
    void OnKeyPress() override {
        const char* name = Interactor->GetKeySym();
        if (name)
            window->key(Interactor->GetControlKey() ? std::string("Control+") + name : std::string(name));
    }
    void OnKeyRelease() override {}
    void OnChar() override {}  // the base's letters would quit and switch to wireframe
    void OnTimer() override { window->tick(); }

  private:
    std::pair<int, int> where() const {
        const int* p = Interactor->GetEventPosition();
        return {p[0], Interactor->GetRenderWindow()->GetSize()[1] - 1 - p[1]};
    }
    bool on_panel() const { return where().first < Panel::kWidth; }
    bool taken_ = false;
};
vtkStandardNewMacro(Style);

}  // namespace

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Shell& shell() {
    static Shell one;
    return one;
}

StudioWindow::~StudioWindow() {
    rebake_.cancel();
    search_.cancel();
    for (Pane* pane : {&left_, &right_}) pane->view.reset();
    window_->Finalize();
    for (vtkRenderer* renderer :
         {panel_renderer_.Get(), left_.renderer.Get(), right_.renderer.Get(), sheet_renderer_.Get()})
        window_->RemoveRenderer(renderer);
    interactor_->SetInteractorStyle(nullptr);
}

StudioWindow::StudioWindow(std::unique_ptr<Document> document, const WindowOptions& options)
    : document_(std::move(document)), options_(options) {
    window_->SetSize(options.width, options.height);
    window_->SetMultiSamples(0);
    window_->SetNumberOfLayers(2);
    window_->SetWindowName(("vsplit studio - " + document_->source().path).c_str());
    window_->AddRenderer(panel_renderer_);
    panel_renderer_->InteractiveOff();
    for (Pane* pane : {&left_, &right_}) {
        window_->AddRenderer(pane->renderer);
        dress(pane->renderer);
        pane->view = std::make_unique<MeshView>(pane->renderer);
        vtkTextProperty* text = pane->caption->GetTextProperty();
        text->SetFontSize(15);
        text->SetColor(0.1, 0.13, 0.18);
        text->SetVerticalJustificationToTop();
        pane->renderer->AddActor2D(pane->caption);
    }
    right_.renderer->SetActiveCamera(left_.renderer->GetActiveCamera());
    sheet_renderer_->SetLayer(1);
    // The panes' depths stay below it, for strokes.
    sheet_renderer_->PreserveDepthBufferOn();
    sheet_renderer_->InteractiveOff();
    window_->AddRenderer(sheet_renderer_);
    status_->GetTextProperty()->SetFontSize(14);
    status_->GetTextProperty()->SetColor(0.1, 0.13, 0.18);
    status_->GetTextProperty()->SetVerticalJustificationToBottom();
    sheet_renderer_->AddActor2D(status_);
    panel_ = std::make_unique<Panel>(panel_renderer_);
    sheet_ = std::make_unique<Sheet>(sheet_renderer_);
    if (document_->painting().marks().regions.empty()) add_region();
    left_.live = std::make_unique<LiveMesh>(document_->live());
    level_ = document_->live().level();
    baked_version_ = document_->painting().version();
    set_camera(left_.renderer,
               *camera_for(document_->box(), "iso", options.width - Panel::kWidth, options.height));
    layout();
    interactor_->SetRenderWindow(window_);
    vtkNew<Style> style;
    style->window = this;
    interactor_->SetInteractorStyle(style);
}

bool StudioWindow::in_left_pane(int x) const {
    return x >= Panel::kWidth && x < Panel::kWidth + left_width();
}

int StudioWindow::left_width() const {
    const int wide = window_->GetSize()[0] - Panel::kWidth;
    return split_ ? wide / 2 : wide;
}

void StudioWindow::layout() {
    const int w = std::max(window_->GetSize()[0], Panel::kWidth + 100), h = window_->GetSize()[1];
    const double panel = double(Panel::kWidth) / w, middle = double(Panel::kWidth + left_width()) / w;
    panel_renderer_->SetViewport(0, 0, panel, 1);
    left_.renderer->SetViewport(panel, 0, middle, 1);
    right_.renderer->SetViewport(middle, 0, 1, 1);
    right_.renderer->SetDraw(split_);
    sheet_renderer_->SetViewport(panel, 0, 1, 1);
    left_.caption->SetPosition(14, h - 12);
    right_.caption->SetPosition(14, h - 12);
    status_->SetPosition(14, 10);
    refresh_panel();
}

void StudioWindow::resized() {
    layout();
    draw();
}

void StudioWindow::show_pane(Pane& pane, std::size_t level) {
    if (!pane.live) return;
    const std::size_t cap =
        level_for_triangles(pane.live->state(), std::uint64_t(budget_ / (split_ ? 2 : 1)));
    const std::size_t now = moving_ ? std::min(level, std::max<std::size_t>(cap, 1)) : level;
    shown_coarse_ = shown_coarse_ || now < level;
    pane.live->go_to(now);
    if (refined_ && &pane == &left_ && !moving_) {
        const Result<Mesh> made = document_->refined_in_place();
        if (!made) {
            refined_ = false;
            say(made.error().describe());
            return show_pane(pane, level);
        }
        const Mesh& mesh = *made;
        std::vector<Rgb> colours(mesh.positions.size());
        for (std::uint32_t v = 0; v < colours.size(); ++v) colours[v] = plain_colour(*document_, v);
        if (document_->placed()) {
            const Shown shown = document_->show(mesh.positions, mesh.triangles, mesh.groups);
            std::vector<Rgb> theirs;
            for (const std::uint32_t v : shown.vertex_of) theirs.push_back(colours[v]);
            pane.view->show(shown.positions, shown.triangles, theirs, look_);
        } else {
            pane.view->show(mesh.positions, mesh.triangles, colours, look_);
        }
        pane.view->legend(nullptr, Heat::kNone);
        pane.caption->SetInput(
            fmt::format("{} triangles: marked regions refined in place", mesh.triangles.size()).c_str());
        return;
    }
    HeatMap map;
    // Heat takes longer than a frame: while things move, what is known is regions.
    const Heat heat = moving_ && look_.heat == Heat::kError ? Heat::kNone : look_.heat;
    const LevelPicture level_shown = level_picture(*document_, *pane.live, heat, &map);
    Look look = look_;
    look.heat = heat;
    look.quick = moving_ && now > 0 && pane.live->triangles().size() > kSmoothEnough;
    look.closed = document_->closed() && eye_outside();
    if (moving_ && pane.live->triangles().size() > 20000) look.wireframe = false;
    pane.view->show(level_shown.positions, level_shown.triangles, level_shown.colours, look);
    pane.view->legend(heat == Heat::kNone ? nullptr : &map, heat);
    const ProgressiveMesh& record = pane.live->state();
    const double ratio =
        double(triangles_at(record, level)) / double(std::max<std::size_t>(record.triangles.size(), 1));
    pane.caption->SetInput(fmt::format("{:.1f} %   {} triangles   {} vertices   error {:.4g}", 100 * ratio,
                                       triangles_at(record, level), vertices_at(record, level),
                                       error_at(record, level))
                               .c_str());
}

bool StudioWindow::eye_outside() const {
    const double* eye = left_.renderer->GetActiveCamera()->GetPosition();
    const Box& box = document_->box();
    return eye[0] < box.low.x || eye[0] > box.high.x || eye[1] < box.low.y || eye[1] > box.high.y ||
           eye[2] < box.low.z || eye[2] > box.high.z;
}

void StudioWindow::draw_stroke() {
    // A patch needs the picture under it: of this level, in the regions' colours, from here.
    if (!patchable_) {
        move();
        draw_at_full_level();
        patchable_ = look_.heat == Heat::kNone;
        document_->take_repainted();
        if (split_) right_colours_ = level_picture(*document_, *right_.live, Heat::kNone).colours;
        return;
    }
    const std::vector<Triangle> triangles = document_->take_repainted();
    move();
    if (triangles.empty()) return;
    left_.view->recolour(level_picture(*document_, *left_.live, Heat::kNone).colours);
    left_.view->patch(triangles);
    const bool right = split_ && patch_right();
    for (Pane* pane : {&left_, &right_}) {
        pane->renderer->PreserveColorBufferOn();
        pane->renderer->PreserveDepthBufferOn();
        pane->caption->VisibilityOff();
    }
    right_.renderer->SetDraw(right);
    for (vtkRenderer* other : {sheet_renderer_.Get(), panel_renderer_.Get()}) other->SetDraw(false);
    window_->Render();
    sheet_renderer_->SetDraw(true);
    right_.renderer->SetDraw(split_);
    for (Pane* pane : {&left_, &right_}) {
        pane->caption->VisibilityOn();
        pane->renderer->PreserveColorBufferOff();
        pane->renderer->PreserveDepthBufferOff();
        pane->view->patch({});
    }
}

bool StudioWindow::patch_right() {
    LevelPicture now = level_picture(*document_, *right_.live, Heat::kNone);
    std::vector<Triangle> changed;
    for (const Triangle& t : now.triangles)
        if (std::any_of(t.begin(), t.end(),
                        [&](std::uint32_t v) { return now.colours[v] != right_colours_[v]; }))
            changed.push_back(t);
    if (changed.empty()) return false;
    right_.view->recolour(now.colours);
    right_.view->patch(changed);
    right_colours_ = std::move(now.colours);
    return true;
}

void StudioWindow::draw_panel() {
    for (const Pane* pane : {&left_, &right_}) pane->renderer->SetDraw(false);
    sheet_renderer_->SetDraw(false);
    panel_renderer_->SetDraw(panel_stale_);
    window_->Render();
    if (panel_stale_) panel_->drawn();
    panel_stale_ = false;
    left_.renderer->SetDraw(true);
    right_.renderer->SetDraw(split_);
    sheet_renderer_->SetDraw(true);
}

void StudioWindow::draw_at_full_level() {
    const double budget = budget_;
    budget_ = 1e12;
    draw();
    budget_ = budget;
}

void StudioWindow::draw() {
    patchable_ = false;
    shown_coarse_ = false;
    const double start = seconds_now();
    show_pane(left_, level_);
    if (split_) show_pane(right_, document_->level_for_ratio(right_ratio_));
    // What the panel drew stays in the frame buffer: thirty texts are a third of a frame.
    panel_renderer_->SetDraw(panel_stale_);
    window_->Render();
    if (panel_stale_) panel_->drawn();
    panel_stale_ = false;
    if (!moving_) return;
    window_->WaitForCompletion();
    const double took = seconds_now() - start;
    // Towards what fits in a frame: at once if it took longer, a little at a time if there is room.
    if (shown_coarse_ || took > kFrame) {
        const double fits = std::clamp(kFrame / took, 0.5, 1.5);
        budget_ = std::clamp(budget_ * (fits < 1 ? fits : 0.8 + 0.2 * fits), kLeastBudget, 4e6);
    }
}

void StudioWindow::move() {
    moving_ = true;
    moved_at_ = seconds_now();
}

void StudioWindow::camera_moves() {
    if (!moving_) {
        move();
        draw();
    }
    move();
    for (Pane* pane : {&left_, &right_}) pane->renderer->ResetCameraClippingRange();
}

void StudioWindow::tick() {
    take_bake();
    take_search();
    if (moving_ && !stroke_ && dragging_ == kNothing && seconds_now() - moved_at_ > kSettle) {
        moving_ = false;
        draw();
        document_->prepare();
    } else if (busy() && seconds_now() - progress_drawn_ > 0.1) {
        progress_drawn_ = seconds_now();
        refresh_panel();
        draw_panel();
    }
}

std::optional<Hit> StudioWindow::pick_at(int x, int y) {
    if (!in_left_pane(x)) return std::nullopt;
    const Camera camera = camera_of(left_.renderer, left_width(), window_->GetSize()[1]);
    return document_->pick(ray_through(camera, x - Panel::kWidth, y));
}

void StudioWindow::dab(int x, int y, bool erase) {
    const auto hit = pick_at(x, y);
    if (!hit) return;
    const Camera camera = camera_of(left_.renderer, left_width(), window_->GetSize()[1]);
    Brush brush;
    brush.radius = brush_pixels_ * pixel_size(camera, hit->distance);
    brush.strength = float(strength_);
    brush.region = erase ? std::uint8_t{0} : std::uint8_t(region_);
    brush.mirror = mirror_;
    document_->dab(*hit, brush);
}

bool StudioWindow::press(int x, int y, bool paint, bool erase) {
    if (question_) return true;
    if (sheet_->visible()) {
        sheet_->show("", 1, 1);
        draw();
        return true;
    }
    if (x < Panel::kWidth) {
        const auto pressed = panel_->at(x, y);
        if (!pressed) return true;
        const int id = pressed->id;
        const bool slider = id == kRatio || id == kError || id == kRightRatio || id == kSize ||
                            id == kStrength || id == kKeepShare || id == kKeepRatio || id == kSharpDegrees;
        if (slider) dragging_ = id;
        act(id, pressed->value);
        return true;
    }
    if (pending_ != kNothing && in_left_pane(x)) {
        click_select(x, y);
        return true;
    }
    if ((!paint && !erase) || !in_left_pane(x)) return false;
    stroke_ = true;
    erase_ = erase;
    document_->painting().begin();
    last_x_ = x;
    last_y_ = y;
    dab(x, y, erase);
    draw_stroke();
    return true;
}

bool StudioWindow::drag(int x, int y) {
    if (dragging_ != kNothing) {
        act(dragging_, panel_->along(dragging_, x));
        return true;
    }
    if (!stroke_) return false;
    // Dabs along the way, half a brush apart.
    const double dx = x - last_x_, dy = y - last_y_, far = std::hypot(dx, dy);
    const int steps = std::clamp(int(std::ceil(far / std::max(2.0, 0.5 * brush_pixels_))), 1, 16);
    for (int i = 1; i <= steps; ++i)
        dab(int(last_x_ + dx * i / steps), int(last_y_ + dy * i / steps), erase_);
    last_x_ = x;
    last_y_ = y;
    draw_stroke();
    return true;
}

bool StudioWindow::release() {
    if (dragging_ != kNothing) {
        dragging_ = kNothing;
        return true;
    }
    if (!stroke_) return false;
    stroke_ = false;
    if (document_->painting().end()) after_change(erase_ ? "erased" : "painted");
    return true;
}

void StudioWindow::run() {
    interactor_->Initialize();
    const auto observe = [&](unsigned long event, void (*call)(vtkObject*, unsigned long, void*, void*),
                             vtkObject* from) {
        vtkNew<vtkCallbackCommand> command;
        command->SetClientData(this);
        command->SetCallback(call);
        from->AddObserver(event, command);
    };
    observe(
        vtkCommand::ExitEvent,
        [](vtkObject*, unsigned long, void* self, void*) {
            static_cast<StudioWindow*>(self)->asked_to_close();
        },
        interactor_);
    observe(
        vtkCommand::ConfigureEvent,
        [](vtkObject*, unsigned long, void* self, void*) { static_cast<StudioWindow*>(self)->resized(); },
        interactor_);
    recover();
    draw();
    document_->prepare();
    interactor_->CreateRepeatingTimer(15);
    interactor_->Start();
}

void run_window(std::unique_ptr<Document> document, const WindowOptions& options) {
    StudioWindow window(std::move(document), options);
    if (options.bench)
        window.bench();
    else
        window.run();
}

}  // namespace vsplit::studio
