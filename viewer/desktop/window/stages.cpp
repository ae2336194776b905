// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "stages.hpp"

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>
#include <vtkXMLPolyDataReader.h>

#include <vector>

#include "studio_window.hpp"

namespace vsplit::studio {

struct Stages::Parts {
    vtkRenderWindow* window = shell().window;
    vtkNew<vtkRenderer> renderer;
    vtkRenderWindowInteractor* interactor = shell().interactor;
    unsigned long observer = 0;
    vtkNew<vtkTextActor> text;
    std::unique_ptr<MeshView> view;
    vtkNew<vtkActor> poles;
    std::string stage;
    double drawn = 0;
    bool stopped = false;

    void draw() {
        drawn = seconds_now();
        window->Render();
    }
};

Stages::Stages(int width, int height, const std::string& title) : parts_(new Parts) {
    Parts& p = *parts_;
    p.window->SetSize(width, height);
    p.window->SetMultiSamples(0);
    p.window->SetWindowName(title.c_str());
    p.window->AddRenderer(p.renderer);
    dress(p.renderer);
    p.view = std::make_unique<MeshView>(p.renderer);
    p.text->SetPosition(16, 14);
    p.text->GetTextProperty()->SetFontSize(18);
    p.text->GetTextProperty()->SetColor(0.1, 0.13, 0.18);
    p.renderer->AddActor2D(p.text);
    p.interactor->SetRenderWindow(p.window);
    vtkNew<vtkInteractorStyleTrackballCamera> style;
    p.interactor->SetInteractorStyle(style);
    vtkNew<vtkCallbackCommand> escape;
    escape->SetClientData(&p);
    escape->SetCallback([](vtkObject* from, unsigned long, void* self, void*) {
        const char* key = static_cast<vtkRenderWindowInteractor*>(from)->GetKeySym();
        if (key && std::string_view(key) == "Escape") static_cast<Parts*>(self)->stopped = true;
    });
    p.observer = p.interactor->AddObserver(vtkCommand::KeyPressEvent, escape);
    p.interactor->Initialize();
}

Stages::~Stages() {
    Parts& p = *parts_;
    p.view.reset();
    p.interactor->RemoveObserver(p.observer);
    p.interactor->SetInteractorStyle(nullptr);
    p.window->RemoveRenderer(p.renderer);
}

void Stages::points(std::span<const std::array<double, 3>> positions) {
    Parts& p = *parts_;
    std::vector<Float3> places;
    places.reserve(positions.size());
    for (const auto& q : positions) places.push_back({float(q[0]), float(q[1]), float(q[2])});
    p.view->show_points(places, {40, 70, 110}, 2);
    const int* size = p.window->GetSize();
    set_camera(p.renderer, *camera_for(box_of(places), "iso", size[0], size[1]));
    p.text->SetInput(fmt::format("{} points", places.size()).c_str());
    p.draw();
}

void Stages::poles(std::span<const std::byte> vtp) {
    Parts& p = *parts_;
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->ReadFromInputStringOn();
    reader->SetInputString(std::string(reinterpret_cast<const char*>(vtp.data()), vtp.size()));
    reader->Update();
    vtkPolyData* read = reader->GetOutput();
    vtkDataArray* labels = read->GetPointData()->GetArray("inside");
    vtkNew<vtkPolyData> cloud;
    vtkNew<vtkPoints> places;
    vtkNew<vtkCellArray> verts;
    vtkNew<vtkUnsignedCharArray> colours;
    colours->SetNumberOfComponents(3);
    // Outer poles are as far away as the surface is flat: those beyond the picture are left out.
    double bounds[6];
    p.renderer->ComputeVisiblePropBounds(bounds);
    for (vtkIdType i = 0; i < read->GetNumberOfPoints(); ++i) {
        double q[3];
        read->GetPoint(i, q);
        bool near = true;
        for (int k = 0; k < 3; ++k) {
            const double margin = 0.25 * (bounds[2 * k + 1] - bounds[2 * k]);
            near = near && q[k] >= bounds[2 * k] - margin && q[k] <= bounds[2 * k + 1] + margin;
        }
        if (!near) continue;
        const vtkIdType id = places->InsertNextPoint(q);
        verts->InsertNextCell(1, &id);
        if (labels && labels->GetTuple1(i) > 0)
            colours->InsertNextTuple3(214, 80, 20);
        else
            colours->InsertNextTuple3(90, 150, 200);
    }
    cloud->SetPoints(places);
    cloud->SetVerts(verts);
    cloud->GetPointData()->SetScalars(colours);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(cloud);
    p.poles->SetMapper(mapper);
    p.poles->GetProperty()->SetPointSize(2);
    p.poles->GetProperty()->LightingOff();
    p.renderer->AddActor(p.poles);
    p.view->show_points({}, {0, 0, 0}, 1);
    p.text->SetInput(fmt::format("{} poles", read->GetNumberOfPoints()).c_str());
    p.draw();
}

void Stages::crust(const Mesh& mesh) {
    Parts& p = *parts_;
    p.renderer->RemoveActor(p.poles);
    p.view->show(mesh.positions, mesh.triangles, std::vector<Rgb>(mesh.positions.size(), {205, 208, 212}),
                 {});
    p.text->SetInput(
        fmt::format("crust: {} triangles. Recording the collapse sequence ...", mesh.triangles.size())
            .c_str());
    p.renderer->ResetCameraClippingRange();
    p.draw();
}

bool Stages::progress(std::string_view stage, double done) {
    Parts& p = *parts_;
    if (p.stage != stage || seconds_now() - p.drawn > 0.1) {
        p.stage = stage;
        p.text->SetInput(fmt::format("{} {:.0f} %    (Esc stops)", stage, 100 * done).c_str());
        p.interactor->ProcessEvents();
        p.draw();
    }
    return !p.stopped;
}

void Stages::save(const std::string& path) {
    vtkNew<vtkWindowToImageFilter> grab;
    grab->SetInput(parts_->window);
    grab->ReadFrontBufferOff();
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputConnection(grab->GetOutputPort());
    writer->SetFileName(path.c_str());
    writer->Write();
}

}  // namespace vsplit::studio
