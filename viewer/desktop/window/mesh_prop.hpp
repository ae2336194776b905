// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Triangles by buffers and shaders of our own. VTK's mapper makes its buffers anew at every change, and its
// shader lights each pixel of both sides: on a software renderer most of a frame.
#pragma once

#include <vtkProp.h>
#include <vtk_glew.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "../edit/heat.hpp"

class vtkOpenGLRenderWindow;
class vtkRenderer;

namespace vsplit::studio {

/// What one renderer draws. Holds what it was given until it is drawn, then the renderer's buffers do.
class MeshProp : public vtkProp {
  public:
    static MeshProp* New();
    vtkTypeMacro(MeshProp, vtkProp);
    MeshProp(const MeshProp&) = delete;
    MeshProp& operator=(const MeshProp&) = delete;

    /// `normals` empty: each triangle has its own shade.
    void set_vertices(std::span<const Float3> positions, std::span<const Float3> normals);
    /// One a vertex.
    void set_colours(std::span<const Rgb> colours);
    void set_triangles(std::span<const Triangle> triangles);
    /// Draws these over the picture that is there, and no others, until it is called with none. Their
    /// positions must be those of the picture, which the renderer must have been told to preserve.
    void set_patch(std::span<const Triangle> triangles);

    bool cull = false;   ///< Back sides are not seen: the mesh is closed and its normals point outwards.
    bool edges = false;  ///< Over the surface.
    bool quick = false;  ///< Light at vertices, not at pixels.

    double* GetBounds() override { return bounds_.data(); }
    vtkTypeBool HasTranslucentPolygonalGeometry() override { return 0; }
    int RenderOpaqueGeometry(vtkViewport* viewport) override;
    void ReleaseGraphicsResources(vtkWindow* window) override;

  protected:
    MeshProp() = default;
    ~MeshProp() override = default;

  private:
    enum Buffer : std::uint8_t { kPositions, kNormals, kColours, kTriangles, kPatch, kBuffers };
    void upload();
    void draw(vtkOpenGLRenderWindow* window, vtkRenderer* renderer, bool lines);

    std::vector<Float3> positions_, normals_;
    std::vector<std::array<std::uint8_t, 4>> colours_;
    std::vector<Triangle> triangles_, patch_;
    std::array<bool, kBuffers> stale_{};
    std::size_t triangle_count_ = 0, patch_count_ = 0;
    bool flat_ = false;
    Double3 centre_;  // what positions in the buffer are relative to
    std::array<double, 6> bounds_{1, -1, 1, -1, 1, -1};
    GLuint array_ = 0;
    std::array<GLuint, kBuffers> buffers_{};
};

}  // namespace vsplit::studio
