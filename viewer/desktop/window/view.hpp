// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A mesh in a renderer, for a window or a picture.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "../edit/heat.hpp"

class vtkRenderer;

namespace vsplit::studio {

struct Look {
    bool flat = false;
    bool wireframe = false;  ///< Edges over the surface.
    Heat heat = Heat::kNone;
    bool quick = false;   ///< Light at vertices only.
    bool closed = false;  ///< Nobody sees the surface from inside: it is, and the eye is not.
};

/// One mesh, or a cloud of points. Copies what it shows.
class MeshView {
  public:
    explicit MeshView(vtkRenderer* renderer);
    ~MeshView();
    MeshView(const MeshView&) = delete;
    MeshView& operator=(const MeshView&) = delete;

    void show(std::span<const Float3> positions, std::span<const Triangle> triangles,
              const std::vector<Rgb>& colours, const Look& look);
    void show_points(std::span<const Float3> positions, Rgb colour, float size);
    /// Colours alone, of the vertices shown.
    void recolour(const std::vector<Rgb>& colours);
    /// The next pictures draw only these of the triangles shown, over what is there: the renderer and what
    /// lies over it must leave colours and depths as they are. None: all again.
    void patch(std::span<const Triangle> triangles);
    /// The bar that says what colours mean; nothing hides it.
    void legend(const HeatMap* map, Heat heat);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

void set_camera(vtkRenderer* renderer, const Camera& camera);
/// `width` and `height` are the renderer's, in pixels.
Camera camera_of(vtkRenderer* renderer, int width, int height);
/// The studio's background and light.
void dress(vtkRenderer* renderer);

}  // namespace vsplit::studio
