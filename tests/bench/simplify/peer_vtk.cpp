// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>
#include <vtkVersion.h>

#include "peer.hpp"

namespace vsplit::bench {
namespace {

Result<std::vector<Mesh>> simplify(const Mesh& mesh, std::span<const std::size_t> targets) {
    vtkNew<vtkPoints> points;
    points->SetNumberOfPoints(vtkIdType(mesh.positions.size()));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        points->SetPoint(vtkIdType(i), mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z);
    vtkNew<vtkCellArray> cells;
    for (const Triangle& t : mesh.triangles)
        cells->InsertNextCell({vtkIdType(t[0]), vtkIdType(t[1]), vtkIdType(t[2])});
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(cells);

    std::vector<Mesh> levels;
    for (const std::size_t target : targets) {
        vtkNew<vtkQuadricDecimation> decimation;
        decimation->SetInputData(data);
        decimation->SetTargetReduction(1 - double(target) / double(mesh.triangles.size()));
        decimation->Update();
        vtkPolyData* out = decimation->GetOutput();
        Mesh level;
        for (vtkIdType i = 0; i < out->GetNumberOfPoints(); ++i) {
            double p[3];
            out->GetPoint(i, p);
            level.positions.push_back({float(p[0]), float(p[1]), float(p[2])});
        }
        vtkNew<vtkIdList> corners;
        for (vtkIdType i = 0; i < out->GetPolys()->GetNumberOfCells(); ++i) {
            out->GetPolys()->GetCellAtId(i, corners);
            if (corners->GetNumberOfIds() != 3)
                return Error{ErrorCode::kMalformed, "VTK returned a cell that is no triangle",
                             Error::kNowhere, 0};
            level.triangles.push_back({std::uint32_t(corners->GetId(0)), std::uint32_t(corners->GetId(1)),
                                       std::uint32_t(corners->GetId(2))});
        }
        levels.push_back(std::move(level));
    }
    return levels;
}

}  // namespace

// VolumePreservationOn gave the same meshes on the bunny, fandisk and rocker-arm, so it has no row.
Peer vtk_quadric() {
    return {"VTK", std::string("VTK ") + vtkVersion::GetVTKVersion(),
            "vtkQuadricDecimation, defaults; a run for each ratio", "", simplify};
}

}  // namespace vsplit::bench
