// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "picture.hpp"

#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkGLTFImporter.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <cstdio>
#include <cstring>

#include "display.hpp"

namespace vsplit::studio {
namespace {

struct Studio {
    vtkNew<vtkRenderWindow> window;
    vtkNew<vtkRenderer> renderer;
    Studio(int width, int height) {
        window->SetOffScreenRendering(1);
        window->SetMultiSamples(4);
        window->SetSize(width, height);
        window->AddRenderer(renderer);
        dress(renderer);
    }
    std::vector<std::byte> png() {
        renderer->ResetCameraClippingRange();
        window->Render();
        vtkNew<vtkWindowToImageFilter> grab;
        grab->SetInput(window);
        grab->ReadFrontBufferOff();
        vtkNew<vtkPNGWriter> writer;
        writer->SetInputConnection(grab->GetOutputPort());
        writer->WriteToMemoryOn();
        writer->Write();
        vtkUnsignedCharArray* bytes = writer->GetResult();
        const auto* data = reinterpret_cast<const std::byte*>(bytes->GetPointer(0));
        return {data, data + bytes->GetNumberOfValues()};
    }
};

}  // namespace

bool parse_size(const std::string& text, int& width, int& height) {
    char rest = 0;
    return std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) == 2 && width >= 16 &&
           width <= 8192 && height >= 16 && height <= 8192;
}

Result<std::vector<std::byte>> picture(const Document& document, const Camera& camera, const Look& look) {
    if (const Status there = check_display(); !there) return there.error();
    Studio studio(camera.width, camera.height);
    MeshView view(studio.renderer);
    HeatMap map;
    const LevelPicture level = level_picture(document, document.live(), look.heat, &map);
    view.show(level.positions, level.triangles, level.colours, look);
    view.legend(look.heat == Heat::kNone ? nullptr : &map, look.heat);
    set_camera(studio.renderer, camera);
    return studio.png();
}

Result<std::vector<std::byte>> picture_of_points(std::span<const Float3> positions, const Camera& camera) {
    if (const Status there = check_display(); !there) return there.error();
    Studio studio(camera.width, camera.height);
    MeshView view(studio.renderer);
    view.show_points(positions, {40, 70, 110}, 2);
    set_camera(studio.renderer, camera);
    return studio.png();
}

Result<std::vector<std::byte>> picture_of_glb(const std::string& path, const std::string& view, int width,
                                              int height, bool wireframe) {
    if (const Status there = check_display(); !there) return there.error();
    Studio studio(width, height);
    vtkNew<vtkGLTFImporter> importer;
    importer->SetFileName(path.c_str());
    importer->SetRenderWindow(studio.window);
    importer->Update();
    vtkActorCollection* actors = studio.renderer->GetActors();
    actors->InitTraversal();
    while (vtkActor* actor = actors->GetNextActor()) {
        // Physically based light wants an environment that is not there.
        actor->GetProperty()->SetInterpolationToGouraud();
        if (vtkTexture* base = actor->GetProperty()->GetTexture("albedoTex")) {
            actor->SetTexture(base);
            actor->GetProperty()->RemoveAllTextures();
        }
        actor->GetProperty()->SetAmbient(0.15);
        actor->GetProperty()->SetEdgeVisibility(wireframe);
    }
    double b[6];
    studio.renderer->ComputeVisiblePropBounds(b);
    if (!(b[0] <= b[1])) return Error{ErrorCode::kMalformed, "the scene shows nothing", Error::kNowhere, 0};
    const Box box{{b[0], b[2], b[4]}, {b[1], b[3], b[5]}};
    const auto camera = camera_for(box, view, width, height);
    if (!camera) return Error{ErrorCode::kArgument, "there is no view " + view, Error::kNowhere, 0};
    set_camera(studio.renderer, *camera);
    return studio.png();
}

Result<std::vector<std::byte>> script_picture(const Document& document, const Camera& camera,
                                              const nlohmann::ordered_json& step) {
    Look look;
    const auto heat = heat_of(step.value("heat", std::string("none")));
    if (!heat)
        return Error{ErrorCode::kArgument, "'heat' is error, weight, curvature or quality", Error::kNowhere,
                     0};
    look.heat = *heat;
    look.wireframe = step.value("wireframe", false);
    look.flat = step.value("flat", false);
    return picture(document, camera, look);
}

}  // namespace vsplit::studio
