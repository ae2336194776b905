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
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextProperty.h>
#include <vtkTypeInt32Array.h>

#include <cstring>

#include "mesh_prop.hpp"

namespace vsplit::studio {

struct MeshView::Parts {
    vtkRenderer* renderer = nullptr;
    vtkNew<MeshProp> mesh;
    vtkNew<vtkScalarBarActor> bar;
    vtkNew<vtkLookupTable> table;
    std::vector<Float3> normals;
    // Points alone.
    vtkNew<vtkPolyData> data;
    vtkNew<vtkPolyDataMapper> mapper;
    vtkNew<vtkActor> actor;
};

MeshView::MeshView(vtkRenderer* renderer) : parts_(new Parts) {
    Parts& p = *parts_;
    p.renderer = renderer;
    p.mapper->SetInputData(p.data);
    p.actor->SetMapper(p.mapper);
    p.actor->VisibilityOff();
    renderer->AddActor(p.actor);
    renderer->AddViewProp(p.mesh);
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
    parts_->renderer->RemoveViewProp(parts_->mesh);
    parts_->renderer->RemoveActor2D(parts_->bar);
}

void MeshView::show(std::span<const Float3> positions, std::span<const Triangle> triangles,
                    const std::vector<Rgb>& colours, const Look& look) {
    Parts& p = *parts_;
    p.actor->VisibilityOff();
    p.mesh->VisibilityOn();
    p.normals.clear();
    if (!look.flat) smooth_normals(positions, triangles, p.normals);
    p.mesh->set_vertices(positions, p.normals);
    p.mesh->set_triangles(triangles);
    p.mesh->set_patch({});
    p.mesh->set_colours(colours);
    p.mesh->edges = look.wireframe;
    p.mesh->quick = look.quick;
    p.mesh->cull = look.closed;
}

void MeshView::recolour(const std::vector<Rgb>& colours) {
    parts_->mesh->set_colours(colours);
}

void MeshView::patch(std::span<const Triangle> triangles) {
    parts_->mesh->set_patch(triangles);
}

void MeshView::show_points(std::span<const Float3> positions, Rgb colour, float size) {
    Parts& p = *parts_;
    const auto n = vtkIdType(positions.size());
    vtkNew<vtkFloatArray> places;
    places->SetNumberOfComponents(3);
    places->SetNumberOfTuples(n);
    if (n > 0) std::memcpy(places->GetPointer(0), positions.data(), positions.size_bytes());
    vtkNew<vtkPoints> points;
    points->SetData(places);
    vtkNew<vtkTypeInt32Array> offsets, corners;
    offsets->SetNumberOfValues(n + 1);
    corners->SetNumberOfValues(n);
    for (vtkIdType i = 0; i <= n; ++i) offsets->SetValue(i, int(i));
    for (vtkIdType i = 0; i < n; ++i) corners->SetValue(i, int(i));
    vtkNew<vtkCellArray> cells;
    cells->SetData(offsets, corners);
    p.data->SetPoints(points);
    p.data->SetVerts(cells);
    p.actor->GetProperty()->SetPointSize(size);
    p.actor->GetProperty()->SetColor(colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
    p.actor->VisibilityOn();
    p.mesh->VisibilityOff();
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
