// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "family.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <set>

namespace vsplit::test {
namespace {

using std::numbers::pi;

Mesh make_non_manifold_fan() {
    // Five grids that share one edge row, like the pages of a book, and one vertex shared with a far
    // tetrahedron.
    Mesh mesh;
    constexpr int n = 6;
    for (int i = 0; i <= n; ++i) mesh.positions.push_back({0, 0, float(i) / n});
    for (int page = 0; page < 5; ++page) {
        const float a = float(page) * 0.7f;
        std::uint32_t previous = 0;
        for (int c = 1; c <= n; ++c) {
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (int i = 0; i <= n; ++i)
                mesh.positions.push_back(
                    {std::cos(a) * float(c) / n, std::sin(a) * float(c) / n, float(i) / n});
            for (std::uint32_t i = 0; i < n; ++i) {
                mesh.triangles.push_back({previous + i, first + i, first + i + 1});
                mesh.triangles.push_back({previous + i, first + i + 1, previous + i + 1});
            }
            previous = first;
        }
    }
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back({0, 0, -1});
    mesh.positions.push_back({0.5f, 0, -1});
    mesh.positions.push_back({0, 0.5f, -1});
    mesh.triangles.push_back({0, base, base + 1});
    mesh.triangles.push_back({0, base + 1, base + 2});
    mesh.triangles.push_back({0, base + 2, base});
    mesh.triangles.push_back({base, base + 2, base + 1});
    return mesh;
}

Mesh make_degenerate() {
    // A grid with zero-area triangles: a row collapsed onto a line, coincident vertices, duplicate and
    // reversed triangles.
    Mesh mesh = make_grid(8);
    for (std::uint32_t i = 0; i < 9; ++i) mesh.positions[9 * 4 + i] = mesh.positions[9 * 3 + i];
    mesh.positions[1] = mesh.positions[0];
    mesh.triangles.push_back(mesh.triangles[20]);
    mesh.triangles.push_back({mesh.triangles[30][0], mesh.triangles[30][2], mesh.triangles[30][1]});
    return mesh;
}

}  // namespace

Mesh make_sphere(int slices, int stacks) {
    Mesh mesh;
    mesh.positions.push_back({0, 0, 1});
    for (int i = 1; i < stacks; ++i)
        for (int j = 0; j < slices; ++j) {
            const double t = pi * i / stacks, p = 2 * pi * j / slices;
            mesh.positions.push_back(
                {float(std::sin(t) * std::cos(p)), float(std::sin(t) * std::sin(p)), float(std::cos(t))});
        }
    const auto last = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back({0, 0, -1});
    const auto at = [&](int i, int j) {
        return static_cast<std::uint32_t>(1 + (i - 1) * slices + j % slices);
    };
    for (int j = 0; j < slices; ++j) mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    for (int i = 1; i + 1 < stacks; ++i)
        for (int j = 0; j < slices; ++j) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    for (int j = 0; j < slices; ++j)
        mesh.triangles.push_back({at(stacks - 1, j), last, at(stacks - 1, j + 1)});
    return mesh;
}

Mesh make_grid(int n) {
    Mesh mesh;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) mesh.positions.push_back({float(j) / float(n), float(i) / float(n), 0});
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        }
    return mesh;
}

Mesh make_torus(int n, int m) {
    Mesh mesh;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            const double u = 2 * pi * i / n, v = 2 * pi * j / m, r = 1 + 0.35 * std::cos(v);
            mesh.positions.push_back(
                {float(r * std::cos(u)), float(r * std::sin(u)), float(0.35 * std::sin(v))});
        }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>((i % n) * m + j % m); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

Mesh join(const Mesh& a, const Mesh& b, Float3 shift) {
    Mesh mesh = a;
    const auto base = static_cast<std::uint32_t>(a.positions.size());
    for (const Float3& p : b.positions)
        mesh.positions.push_back({p.x + shift.x, p.y + shift.y, p.z + shift.z});
    for (const Triangle& t : b.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    return mesh;
}

const std::vector<NamedMesh>& mesh_family() {
    static const std::vector<NamedMesh> family = [] {
        std::vector<NamedMesh> all;
        all.push_back({"sphere", make_sphere(24, 16)});
        all.push_back({"torus", make_torus(30, 14)});
        all.push_back({"grid", make_grid(15)});
        Mesh bowl = make_grid(20);
        for (Float3& p : bowl.positions) p.z = (p.x - 0.5f) * (p.x - 0.5f) + 0.3f * std::sin(7 * p.y);
        all.push_back({"bowl", bowl});
        Mesh parts;
        for (int i = 0; i < 24; ++i)
            parts = join(parts, i % 3 == 0 ? make_grid(3) : make_sphere(6 + i % 5, 4 + i % 3),
                         {3.0f * float(i), 0, 0});
        all.push_back({"many components", parts});
        all.push_back({"non-manifold", make_non_manifold_fan()});
        all.push_back({"degenerate", make_degenerate()});
        Mesh far = make_torus(20, 10);
        for (Float3& p : far.positions) p = {p.x + 500000.0f, p.y - 300000.0f, p.z + 1000.0f};
        all.push_back({"far from the origin", far});
        all.push_back({"tetrahedron", make_sphere(3, 2)});
        all.push_back({"single triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}}});
        all.push_back({"empty", {}});
        return all;
    }();
    return family;
}

std::optional<std::string> corpus_file(const std::string& name) {
    const std::string path = std::string(VSPLIT_CORPUS) + "/" + name;
    if (std::filesystem::exists(path)) return path;
    static std::set<std::string> said;
    if (said.insert(name).second)
        std::fprintf(stderr, "SKIPPED: %s is not here, this part of the test runs without it\n",
                     path.c_str());
    return std::nullopt;
}

}  // namespace vsplit::test
