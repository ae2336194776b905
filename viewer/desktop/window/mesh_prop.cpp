// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "mesh_prop.hpp"

#include <vtkCamera.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>
#include <vtkShaderProgram.h>

#include <algorithm>
#include <string>

namespace vsplit::studio {

vtkStandardNewMacro(MeshProp);

namespace {

// Two lights that come with the camera, and a highlight half way between the first and the eye.
constexpr const char* kLight = R"(
vec3 lit(vec3 colour, vec3 n) {
    float key = max(0.0, dot(n, vec3(0.3637, 0.5819, 0.7274)));
    float fill = max(0.0, dot(n, vec3(-0.8018, -0.2673, 0.5345)));
    float shine = pow(max(0.0, dot(n, vec3(0.1957, 0.3131, 0.9293))), 25.0);
    return colour * (0.08 + 0.92 * (0.85 * key + 0.35 * fill)) + 0.10 * shine;
}
)";

constexpr const char* kHead = "//VTK::System::Dec\n";
constexpr const char* kFragmentHead = "//VTK::System::Dec\n//VTK::Output::Dec\n";

/// Light at vertices: those that face away are seen from behind.
constexpr const char* kQuickVertex = R"(
in vec3 position; in vec3 normal; in vec4 colour;
uniform mat4 matrix; uniform mat3 turn;
out vec3 shade;
void main() {
    gl_Position = matrix * vec4(position, 1.0);
    vec3 n = turn * normal;
    shade = lit(colour.rgb, n.z < 0.0 ? -n : n);
}
)";
constexpr const char* kQuickFragment = R"(
in vec3 shade;
void main() { gl_FragData[0] = vec4(shade, 1.0); }
)";

constexpr const char* kVertex = R"(
in vec3 position; in vec3 normal; in vec4 colour;
uniform mat4 matrix; uniform mat3 turn;
out vec3 side; out vec3 tint;
void main() {
    gl_Position = matrix * vec4(position, 1.0);
    side = turn * normal;
    tint = colour.rgb;
}
)";
constexpr const char* kFragment = R"(
in vec3 side; in vec3 tint;
void main() {
    vec3 n = side * inversesqrt(max(dot(side, side), 1e-20));
    gl_FragData[0] = vec4(lit(tint, gl_FrontFacing ? n : -n), 1.0);
}
)";

constexpr const char* kFlatVertex = R"(
in vec3 position; in vec4 colour;
uniform mat4 matrix; uniform mat4 eye;
out vec3 place; out vec3 tint;
void main() {
    gl_Position = matrix * vec4(position, 1.0);
    place = (eye * vec4(position, 1.0)).xyz;
    tint = colour.rgb;
}
)";
constexpr const char* kFlatFragment = R"(
in vec3 place; in vec3 tint;
void main() {
    vec3 n = cross(dFdx(place), dFdy(place));
    n *= inversesqrt(max(dot(n, n), 1e-30));
    gl_FragData[0] = vec4(lit(tint, n.z < 0.0 ? -n : n), 1.0);
}
)";

constexpr const char* kLineVertex = R"(
in vec3 position;
uniform mat4 matrix;
void main() { gl_Position = matrix * vec4(position, 1.0); }
)";
constexpr const char* kLineFragment = R"(
void main() { gl_FragData[0] = vec4(0.12, 0.16, 0.22, 1.0); }
)";

template <class T>
void send(GLenum target, GLuint buffer, std::vector<T>& data) {
    glBindBuffer(target, buffer);
    glBufferData(target, GLsizeiptr(data.size() * sizeof(T)), data.data(), GL_DYNAMIC_DRAW);
}

}  // namespace

void MeshProp::set_vertices(std::span<const Float3> positions, std::span<const Float3> normals) {
    const Box box = box_of(positions);
    bounds_ = positions.empty() ? std::array<double, 6>{1, -1, 1, -1, 1, -1}
                                : std::array<double, 6>{box.low.x,  box.high.x, box.low.y,
                                                        box.high.y, box.low.z,  box.high.z};
    centre_ = box.centre();
    positions_.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        positions_[i] = {float(double(positions[i].x) - centre_.x), float(double(positions[i].y) - centre_.y),
                         float(double(positions[i].z) - centre_.z)};
    flat_ = normals.empty();
    normals_.assign(normals.begin(), normals.end());
    stale_[kPositions] = stale_[kNormals] = true;
    Modified();
}

void MeshProp::set_colours(std::span<const Rgb> colours) {
    colours_.resize(colours.size());
    for (std::size_t i = 0; i < colours.size(); ++i)
        colours_[i] = {colours[i][0], colours[i][1], colours[i][2], 255};
    stale_[kColours] = true;
    Modified();
}

void MeshProp::set_triangles(std::span<const Triangle> triangles) {
    triangles_.assign(triangles.begin(), triangles.end());
    triangle_count_ = triangles_.size();
    stale_[kTriangles] = true;
    Modified();
}

void MeshProp::set_patch(std::span<const Triangle> triangles) {
    patch_.assign(triangles.begin(), triangles.end());
    patch_count_ = patch_.size();
    stale_[kPatch] = true;
    Modified();
}

void MeshProp::upload() {
    if (array_ == 0) {
        glGenVertexArrays(1, &array_);
        glGenBuffers(kBuffers, buffers_.data());
        stale_.fill(true);
    }
    glBindVertexArray(array_);
    if (stale_[kPositions]) send(GL_ARRAY_BUFFER, buffers_[kPositions], positions_);
    if (stale_[kNormals]) send(GL_ARRAY_BUFFER, buffers_[kNormals], normals_);
    if (stale_[kColours]) send(GL_ARRAY_BUFFER, buffers_[kColours], colours_);
    if (stale_[kTriangles]) send(GL_ELEMENT_ARRAY_BUFFER, buffers_[kTriangles], triangles_);
    if (stale_[kPatch]) send(GL_ELEMENT_ARRAY_BUFFER, buffers_[kPatch], patch_);
    stale_.fill(false);
}

void MeshProp::draw(vtkOpenGLRenderWindow* window, vtkRenderer* renderer, bool lines) {
    const std::string light = kLight;
    const auto program = [&](const char* vertex, const char* fragment, bool light_at_vertex) {
        return window->GetShaderCache()->ReadyShaderProgram(
            (kHead + (light_at_vertex ? light : std::string()) + vertex).c_str(),
            (kFragmentHead + (light_at_vertex ? std::string() : light) + fragment).c_str(), "");
    };
    vtkShaderProgram* shader = lines   ? program(kLineVertex, kLineFragment, false)
                               : flat_ ? program(kFlatVertex, kFlatFragment, false)
                               : quick ? program(kQuickVertex, kQuickFragment, true)
                                       : program(kVertex, kFragment, false);
    if (!shader) return;
    const auto handle = GLuint(shader->GetHandle());
    const auto attribute = [&](const char* name, Buffer buffer, int components, GLenum type) {
        const GLint place = glGetAttribLocation(handle, name);
        if (place < 0) return;
        glBindBuffer(GL_ARRAY_BUFFER, buffers_[buffer]);
        glEnableVertexAttribArray(GLuint(place));
        glVertexAttribPointer(GLuint(place), components, type, type == GL_UNSIGNED_BYTE, 0, nullptr);
    };
    // One array for all shaders, whose attributes have other places in each.
    for (GLuint i = 0; i < 4; ++i) glDisableVertexAttribArray(i);
    attribute("position", kPositions, 3, GL_FLOAT);
    attribute("normal", kNormals, 3, GL_FLOAT);
    attribute("colour", kColours, 4, GL_UNSIGNED_BYTE);

    vtkCamera* camera = renderer->GetActiveCamera();
    vtkNew<vtkMatrix4x4> centre, eye, all;
    centre->SetElement(0, 3, centre_.x);
    centre->SetElement(1, 3, centre_.y);
    centre->SetElement(2, 3, centre_.z);
    vtkMatrix4x4::Multiply4x4(camera->GetModelViewTransformMatrix(), centre, eye);
    vtkMatrix4x4::Multiply4x4(camera->GetProjectionTransformMatrix(renderer->GetTiledAspectRatio(), -1, 1),
                              eye, all);
    const auto columns = [](vtkMatrix4x4* m) {
        std::array<float, 16> out;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) out[std::size_t(4 * j + i)] = float(m->GetElement(i, j));
        return out;
    };
    const std::array<float, 16> matrix = columns(all), view = columns(eye);
    const std::array<float, 9> turn{view[0], view[1], view[2], view[4], view[5],
                                    view[6], view[8], view[9], view[10]};
    glUniformMatrix4fv(glGetUniformLocation(handle, "matrix"), 1, GL_FALSE, matrix.data());
    glUniformMatrix4fv(glGetUniformLocation(handle, "eye"), 1, GL_FALSE, view.data());
    glUniformMatrix3fv(glGetUniformLocation(handle, "turn"), 1, GL_FALSE, turn.data());
    const bool patch = patch_count_ > 0;
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[patch ? kPatch : kTriangles]);
    glDrawElements(GL_TRIANGLES, GLsizei(3 * (patch ? patch_count_ : triangle_count_)), GL_UNSIGNED_INT,
                   nullptr);
}

int MeshProp::RenderOpaqueGeometry(vtkViewport* viewport) {
    if (triangle_count_ == 0) return 0;
    auto* renderer = vtkRenderer::SafeDownCast(viewport);
    auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
    upload();
    vtkOpenGLState* state = window->GetState();
    // A software renderer takes twice as long to blend as to write.
    const vtkOpenGLState::ScopedglEnableDisable keep_blending(state, GL_BLEND);
    state->vtkglDisable(GL_BLEND);
    state->vtkglEnable(GL_DEPTH_TEST);
    state->vtkglDepthMask(GL_TRUE);
    state->vtkglDepthFunc(GL_LEQUAL);
    if (cull) {
        state->vtkglEnable(GL_CULL_FACE);
        state->vtkglCullFace(GL_BACK);
    } else {
        state->vtkglDisable(GL_CULL_FACE);
    }
    if (edges) {
        glEnable(GL_POLYGON_OFFSET_FILL);
        glPolygonOffset(1, 1);
    }
    draw(window, renderer, false);
    if (edges) {
        glDisable(GL_POLYGON_OFFSET_FILL);
        glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
        draw(window, renderer, true);
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    }
    state->vtkglDisable(GL_CULL_FACE);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    return 1;
}

void MeshProp::ReleaseGraphicsResources(vtkWindow*) {
    if (array_ == 0) return;
    glDeleteBuffers(kBuffers, buffers_.data());
    glDeleteVertexArrays(1, &array_);
    array_ = 0;
    buffers_.fill(0);
}

}  // namespace vsplit::studio
