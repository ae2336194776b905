// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "panel.hpp"

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

namespace vsplit::studio {
namespace {

constexpr int kMargin = 12, kGap = 5, kButton = 24, kLabel = 20, kTitle = 30, kSlider = 22, kEdge = 8,
              kFont = 13;
constexpr double kLeastScale = 0.65;

int height_of(const Line& line) {
    int height = 0;
    for (const Cell& cell : line)
        height = std::max(height, cell.kind == Cell::Kind::kTitle    ? kTitle
                                  : cell.kind == Cell::Kind::kLabel  ? kLabel
                                  : cell.kind == Cell::Kind::kButton ? kButton
                                                                     : kSlider);
    return height;
}

/// Rectangles of colours, all in one actor.
struct Boxes {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> quads;
    vtkNew<vtkUnsignedCharArray> colours;
    vtkNew<vtkPolyData> data;
    vtkNew<vtkPolyDataMapper2D> mapper;
    vtkNew<vtkActor2D> actor;

    Boxes() {
        colours->SetNumberOfComponents(3);
        data->SetPoints(points);
        data->SetPolys(quads);
        data->GetCellData()->SetScalars(colours);
        mapper->SetInputData(data);
        actor->SetMapper(mapper);
    }
    void clear() {
        points->Reset();
        quads->Reset();
        colours->Reset();
    }
    void add(double x, double y, double w, double h, Rgb c) {
        const vtkIdType first = points->GetNumberOfPoints();
        points->InsertNextPoint(x, y, 0);
        points->InsertNextPoint(x + w, y, 0);
        points->InsertNextPoint(x + w, y + h, 0);
        points->InsertNextPoint(x, y + h, 0);
        const vtkIdType ids[4] = {first, first + 1, first + 2, first + 3};
        quads->InsertNextCell(4, ids);
        colours->InsertNextTuple3(c[0], c[1], c[2]);
    }
    void done() {
        points->Modified();
        quads->Modified();
        colours->Modified();
        data->Modified();
    }
};

constexpr Rgb kBack{33, 38, 46}, kFace{58, 66, 78}, kOn{38, 120, 190}, kTrack{50, 57, 67},
    kFill{86, 148, 205}, kOff{43, 49, 58};

}  // namespace

struct Panel::Parts {
    struct Place {
        Cell cell;
        int x, y, w, h;  // y from the top
        bool operator==(const Place&) const = default;
    };
    vtkRenderer* renderer = nullptr;
    Boxes boxes;
    std::vector<vtkSmartPointer<vtkTextActor>> texts;
    std::vector<Place> places, drawn;  // as they are to be, and as the picture has them
    int height = 0, drawn_height = 0;
    int font = kFont;  ///< Of texts, but for titles, in pixels.
};

Panel::Panel(vtkRenderer* renderer) : parts_(new Parts) {
    parts_->renderer = renderer;
    renderer->SetBackground(kBack[0] / 255.0, kBack[1] / 255.0, kBack[2] / 255.0);
    renderer->AddActor2D(parts_->boxes.actor);
}

Panel::~Panel() {
    for (const auto& text : parts_->texts) parts_->renderer->RemoveActor2D(text);
    parts_->renderer->RemoveActor2D(parts_->boxes.actor);
}

void Panel::set(const std::vector<Line>& lines, int height) {
    Parts& p = *parts_;
    p.places.clear();
    // In a low window all lines are lower, down to where a text is still read.
    int wanted = 2 * kEdge;
    for (const Line& line : lines) wanted += height_of(line) + kGap;
    const double scale = std::clamp(double(height) / wanted, kLeastScale, 1.0);
    const auto scaled = [&](int length) { return int(length * scale); };
    p.font = std::max(9, scaled(kFont));
    int y = scaled(kEdge);
    for (const Line& line : lines) {
        const int h = scaled(height_of(line));
        const int cells = std::max<int>(int(line.size()), 1);
        const int w = (kWidth - 2 * kMargin - (cells - 1) * kGap) / cells;
        for (int i = 0; i < int(line.size()); ++i)
            p.places.push_back({line[std::size_t(i)], kMargin + i * (w + kGap), y, w, h});
        y += h + scaled(kGap);
    }
    p.boxes.clear();
    p.height = height;
    bool all = p.places.size() != p.drawn.size() || height != p.drawn_height;
    for (std::size_t i = 0; i < p.places.size() && !all; ++i)
        all = p.places[i].x != p.drawn[i].x || p.places[i].y != p.drawn[i].y ||
              p.places[i].w != p.drawn[i].w || p.places[i].h != p.drawn[i].h;
    p.renderer->SetPreserveColorBuffer(!all);
    std::size_t used = 0;
    for (std::size_t i = 0; i < p.places.size(); ++i) {
        const Parts::Place& place = p.places[i];
        if (!all && place == p.drawn[i]) continue;
        const Cell& cell = place.cell;
        const double bottom = height - place.y - place.h;
        if (!all) p.boxes.add(place.x, bottom, place.w, place.h, kBack);
        if (cell.kind == Cell::Kind::kButton)
            p.boxes.add(place.x, bottom, place.w, place.h, !cell.enabled ? kOff : cell.on ? kOn : kFace);
        if (cell.kind == Cell::Kind::kSlider) {
            p.boxes.add(place.x, bottom, place.w, place.h, kTrack);
            p.boxes.add(place.x, bottom, std::max(2.0, place.w * std::clamp(cell.value, 0.0, 1.0)), place.h,
                        kFill);
        }
        if (cell.swatch) p.boxes.add(place.x + 5, bottom + 6, 12, place.h - 12, *cell.swatch);
        if (cell.text.empty()) continue;
        if (used == p.texts.size()) {
            auto text = vtkSmartPointer<vtkTextActor>::New();
            text->GetTextProperty()->SetFontFamilyToArial();
            p.renderer->AddActor2D(text);
            p.texts.push_back(text);
        }
        vtkTextActor* text = p.texts[used++];
        vtkTextProperty* look = text->GetTextProperty();
        text->SetVisibility(true);
        const bool centred = cell.kind == Cell::Kind::kButton && !cell.swatch;
        text->SetInput(cell.text.c_str());
        look->SetFontSize(cell.kind == Cell::Kind::kTitle ? p.font + 3 : p.font);
        look->SetBold(cell.kind == Cell::Kind::kTitle);
        if (centred)
            look->SetJustificationToCentered();
        else
            look->SetJustificationToLeft();
        look->SetVerticalJustificationToCentered();
        const double shade = cell.enabled ? (cell.kind == Cell::Kind::kLabel ? 0.80 : 0.96) : 0.5;
        look->SetColor(shade, shade, shade);
        const int inset = cell.swatch ? 24 : cell.kind == Cell::Kind::kSlider ? 6 : 0;
        text->SetPosition(centred ? place.x + place.w / 2.0 : double(place.x + inset),
                          bottom + place.h / 2.0);
    }
    for (; used < p.texts.size(); ++used) p.texts[used]->SetVisibility(false);
    p.boxes.done();
}

void Panel::drawn() {
    parts_->drawn = parts_->places;
    parts_->drawn_height = parts_->height;
}

std::optional<Panel::Press> Panel::at(int x, int y) const {
    for (const Parts::Place& place : parts_->places)
        if (place.cell.id != 0 && place.cell.enabled && x >= place.x && x < place.x + place.w &&
            y >= place.y && y < place.y + place.h)
            return Press{place.cell.id, double(x - place.x) / std::max(1, place.w - 1)};
    return std::nullopt;
}

double Panel::along(int id, int x) const {
    for (const Parts::Place& place : parts_->places)
        if (place.cell.id == id) return std::clamp(double(x - place.x) / std::max(1, place.w - 1), 0.0, 1.0);
    return 0;
}

struct Sheet::Parts {
    vtkRenderer* renderer = nullptr;
    Boxes box;
    vtkNew<vtkTextActor> text;
};

Sheet::Sheet(vtkRenderer* renderer) : parts_(new Parts) {
    Parts& p = *parts_;
    p.renderer = renderer;
    p.text->GetTextProperty()->SetFontFamilyToCourier();
    p.text->GetTextProperty()->SetFontSize(14);
    p.text->GetTextProperty()->SetColor(0.95, 0.96, 0.98);
    p.text->GetTextProperty()->SetLineSpacing(1.25);
    p.text->GetTextProperty()->SetVerticalJustificationToCentered();
    p.text->GetTextProperty()->SetJustificationToCentered();
    p.box.actor->GetProperty()->SetOpacity(0.9);
    renderer->AddActor2D(p.box.actor);
    renderer->AddActor2D(p.text);
    show("", 1, 1);
}

Sheet::~Sheet() {
    parts_->renderer->RemoveActor2D(parts_->box.actor);
    parts_->renderer->RemoveActor2D(parts_->text);
}

void Sheet::show(const std::string& text, int width, int height) {
    Parts& p = *parts_;
    p.text->SetVisibility(!text.empty());
    p.box.actor->SetVisibility(!text.empty());
    if (text.empty()) return;
    std::size_t longest = 0, lines = 1;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        longest = std::max(longest, end - at);
        lines += end < text.size();
        at = end + 1;
    }
    // Courier is about 0.6 of its size wide; what does not fit gets smaller.
    const double size =
        std::min({14.0, width * 0.94 / (0.62 * double(longest)), height * 0.94 / (1.45 * double(lines))});
    p.text->GetTextProperty()->SetFontSize(int(std::max(8.0, size)));
    p.text->SetInput(text.c_str());
    p.text->SetPosition(width / 2.0, height / 2.0);
    const double w = std::min<double>(width, 0.62 * size * double(longest) + 50),
                 h = std::min<double>(height, 1.5 * size * double(lines) + 40);
    p.box.clear();
    p.box.add((width - w) / 2, (height - h) / 2, w, h, kBack);
    p.box.done();
}

bool Sheet::visible() const {
    return parts_->text->GetVisibility() != 0;
}

}  // namespace vsplit::studio
