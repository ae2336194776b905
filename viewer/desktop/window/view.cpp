// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "view.hpp"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkLight.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextProperty.h>
#include <vtkTypeInt32Array.h>
#include <vtkUnsignedCharArray.h>

#include <cstring>

namespace vsplit::studio {

struct MeshView::Parts {
    vtkRenderer* renderer = nullptr;
    vtkNew<vtkPolyData> data;
    vtkNew<vtkPoints> points;
    vtkNew<vtkFloatArray> places, normals;
    vtkNew<vtkUnsignedCharArray> colours;
    vtkNew<vtkTypeInt32Array> offsets, corners;
    vtkNew<vtkCellArray> cells;
    vtkNew<vtkPolyDataMapper> mapper;
    vtkNew<vtkActor> actor;
    vtkNew<vtkScalarBarActor> bar;
    vtkNew<vtkLookupTable> table;
    std::vector<Float3> scratch;
};

MeshView::MeshView(vtkRenderer* renderer) : parts_(new Parts) {
    Parts& p = *parts_;
    p.renderer = renderer;
    p.places->SetNumberOfComponents(3);
    p.normals->SetNumberOfComponents(3);
    p.normals->SetName("Normals");
    p.colours->SetNumberOfComponents(3);
    p.colours->SetName("Colours");
    p.points->SetData(p.places);
    p.mapper->SetInputData(p.data);
    p.actor->SetMapper(p.mapper);
    vtkProperty* property = p.actor->GetProperty();
    property->SetAmbient(0.08);
    property->SetDiffuse(0.92);
    property->SetSpecular(0.12);
    property->SetSpecularPower(25);
    property->SetEdgeColor(0.12, 0.16, 0.22);
    property->SetLineWidth(1);
    renderer->AddActor(p.actor);
    p.bar->SetLookupTable(p.table);
    p.bar->SetNumberOfLabels(4);
    p.bar->SetOrientationToVertical();
    p.bar->SetPosition(0.885, 0.2);
    p.bar->SetPosition2(0.1, 0.6);
    p.bar->SetMaximumWidthInPixels(90);
    p.bar->UnconstrainedFontSizeOn();
    p.bar->SetVerticalTitleSeparation(8);
    for (vtkTextProperty* text : {p.bar->GetTitleTextProperty(), p.bar->GetLabelTextProperty()}) {
        text->SetFontSize(14);
        text->SetColor(0.1, 0.12, 0.15);
        text->BoldOff();
        text->ItalicOff();
        text->ShadowOff();
    }
    p.bar->VisibilityOff();
    renderer->AddActor2D(p.bar);
}

MeshView::~MeshView() {
    parts_->renderer->RemoveActor(parts_->actor);
    parts_->renderer->RemoveActor2D(parts_->bar);
}

void MeshView::show(std::span<const Float3> positions, std::span<const Triangle> triangles,
                    const std::vector<Rgb>& colours, const Look& look) {
    Parts& p = *parts_;
    const auto n = vtkIdType(positions.size()), m = vtkIdType(triangles.size());
    p.places->SetNumberOfTuples(n);
    std::memcpy(p.places->GetPointer(0), positions.data(), positions.size_bytes());
    if (p.offsets->GetNumberOfValues() != m + 1) {
        p.offsets->SetNumberOfValues(m + 1);
        for (vtkIdType i = 0; i <= m; ++i) p.offsets->SetValue(i, int(3 * i));
        p.offsets->Modified();
    }
    p.corners->SetNumberOfValues(3 * m);
    std::memcpy(p.corners->GetPointer(0), triangles.data(), triangles.size_bytes());
    p.corners->Modified();
    p.cells->SetData(p.offsets, p.corners);
    p.cells->Modified();
    p.data->SetPoints(p.points);
    p.data->SetVerts(nullptr);
    p.data->SetPolys(p.cells);
    if (look.flat) {
        p.data->GetPointData()->SetNormals(nullptr);
        p.actor->GetProperty()->SetInterpolationToFlat();
    } else {
        smooth_normals(positions, triangles, p.scratch);
        p.normals->SetNumberOfTuples(n);
        std::memcpy(p.normals->GetPointer(0), p.scratch.data(), p.scratch.size() * sizeof(Float3));
        p.normals->Modified();
        p.data->GetPointData()->SetNormals(p.normals);
        p.actor->GetProperty()->SetInterpolationToGouraud();
    }
    p.actor->GetProperty()->SetEdgeVisibility(look.wireframe);
    p.places->Modified();
    p.points->Modified();
    p.data->Modified();
    recolour(colours);
}

void MeshView::recolour(const std::vector<Rgb>& colours) {
    Parts& p = *parts_;
    p.colours->SetNumberOfTuples(vtkIdType(colours.size()));
    if (!colours.empty()) std::memcpy(p.colours->GetPointer(0), colours.data(), 3 * colours.size());
    p.colours->Modified();
    p.data->GetPointData()->SetScalars(p.colours);
}

void MeshView::show_points(std::span<const Float3> positions, Rgb colour, float size) {
    Parts& p = *parts_;
    const auto n = vtkIdType(positions.size());
    p.places->SetNumberOfTuples(n);
    std::memcpy(p.places->GetPointer(0), positions.data(), positions.size_bytes());
    vtkNew<vtkTypeInt32Array> offsets, corners;
    offsets->SetNumberOfValues(n + 1);
    corners->SetNumberOfValues(n);
    for (vtkIdType i = 0; i <= n; ++i) offsets->SetValue(i, int(i));
    for (vtkIdType i = 0; i < n; ++i) corners->SetValue(i, int(i));
    vtkNew<vtkCellArray> cells;
    cells->SetData(offsets, corners);
    p.data->SetPoints(p.points);
    p.data->SetPolys(nullptr);
    p.data->SetVerts(cells);
    p.data->GetPointData()->SetNormals(nullptr);
    p.actor->GetProperty()->SetPointSize(size);
    p.places->Modified();
    p.points->Modified();
    p.data->Modified();
    recolour(std::vector<Rgb>(positions.size(), colour));
}

void MeshView::legend(const HeatMap* map, Heat heat) {
    Parts& p = *parts_;
    p.bar->SetVisibility(map != nullptr);
    if (!map) return;
    constexpr int kSteps = 64;
    p.table->SetNumberOfTableValues(kSteps);
    p.table->SetTableRange(double(map->low), double(map->high));
    for (int i = 0; i < kSteps; ++i) {
        const Rgb c = ramp(double(i) / (kSteps - 1));
        p.table->SetTableValue(i, c[0] / 255.0, c[1] / 255.0, c[2] / 255.0);
    }
    p.bar->SetTitle(heat == Heat::kError       ? "error"
                    : heat == Heat::kWeight    ? "weight, log2"
                    : heat == Heat::kCurvature ? "turn, degrees"
                                               : "regularity");
    p.bar->SetLabelFormat("%-.3g");
}

void set_camera(vtkRenderer* renderer, const Camera& camera) {
    vtkCamera* c = renderer->GetActiveCamera();
    c->SetPosition(camera.eye.x, camera.eye.y, camera.eye.z);
    c->SetFocalPoint(camera.target.x, camera.target.y, camera.target.z);
    c->SetViewUp(camera.up.x, camera.up.y, camera.up.z);
    c->SetViewAngle(camera.fov_degrees);
    renderer->ResetCameraClippingRange();
}

Camera camera_of(vtkRenderer* renderer, int width, int height) {
    vtkCamera* c = renderer->GetActiveCamera();
    Camera camera;
    const auto three = [](const double* v) { return Double3{v[0], v[1], v[2]}; };
    camera.eye = three(c->GetPosition());
    camera.target = three(c->GetFocalPoint());
    camera.up = three(c->GetViewUp());
    camera.fov_degrees = c->GetViewAngle();
    camera.width = width;
    camera.height = height;
    return camera;
}

void dress(vtkRenderer* renderer) {
    renderer->GradientBackgroundOn();
    renderer->SetBackground(0.80, 0.83, 0.87);
    renderer->SetBackground2(0.95, 0.96, 0.97);
    renderer->SetTwoSidedLighting(true);
    renderer->AutomaticLightCreationOff();
    vtkNew<vtkLight> key, fill;
    key->SetLightTypeToCameraLight();
    key->SetPosition(0.5, 0.8, 1);
    key->SetIntensity(0.85);
    fill->SetLightTypeToCameraLight();
    fill->SetPosition(-0.9, -0.3, 0.6);
    fill->SetIntensity(0.35);
    renderer->AddLight(key);
    renderer->AddLight(fill);
}

}  // namespace vsplit::studio
