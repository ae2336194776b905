// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What a frame of a moving camera costs ViewMesh, on one thread, as a Markdown table: looking at the active
// vertices, splits, dirty ranges.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "vsplit/bake/collapse.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/read.hpp"
#include "vsplit/view_mesh.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;

namespace {

constexpr std::size_t kActive = 100'000;  // triangles
constexpr int kFrames = 360;
constexpr std::size_t kAll = ~std::size_t{0}, kFew = 15'000;  // places looked at in a frame

double cpu_seconds() {
    return double(std::clock()) / CLOCKS_PER_SEC;
}

/// A .pmesh, or a mesh that is baked and written first, so that splits are in the file's order.
Result<ProgressiveMesh> load(const std::string& path, bake::Placement placement) {
    auto bytes = bake::read_file(path);
    if (!bytes) return bytes.error();
    const std::string ending = path.substr(std::min(path.rfind('.'), path.size()));
    if (ending == ".pmesh") return read_progressive_mesh(*bytes);
    const auto input = bake::parse_mesh(*bytes, ending);
    if (!input) return input.error();
    bake::CollapseOptions options;
    options.placement = placement;
    options.calibrate = false;
    auto record = bake::collapse(input->mesh, options);
    if (!record) return record.error();
    return canonical_progressive_mesh(record->mesh);
}

/// One step of a degree around the object, which it looks at; `distance` in its diagonals.
struct Orbit {
    Float3 centre;
    float diagonal = 0, distance = 1;
    std::vector<ViewPlane> planes;

    View at(int step, float pixels) {
        const float angle = float(step) * 3.14159265f / 180, c = std::cos(angle), s = std::sin(angle);
        View view;
        view.eye = {centre.x + distance * diagonal * c, centre.y, centre.z + distance * diagonal * s};
        view.pixels_at_distance_1 = 1080 / (2 * std::tan(0.5f));
        view.pixels = pixels;
        // Near, left, right, bottom, top of a field of view of 1 radian, 16 : 9.
        const float up = std::sin(0.5f), forward = std::cos(0.5f);
        const float wide = std::atan(std::tan(0.5f) * 16 / 9), w = std::sin(wide), f = std::cos(wide);
        planes.clear();
        const auto plane = [&](float x, float y, float z) {
            planes.push_back({x, y, z, -(x * view.eye.x + y * view.eye.y + z * view.eye.z)});
        };
        plane(-c, 0, -s);
        plane(-c * w - s * f, 0, -s * w + c * f);
        plane(-c * w + s * f, 0, -s * w - c * f);
        plane(-c * up, forward, -s * up);
        plane(-c * up, -forward, -s * up);
        view.planes = planes;
        return view;
    }
};

void settle(ViewMesh& mesh, const View& view) {
    for (int call = 0; call < 100 && !mesh.update(view).settled; ++call) {
    }
}

void row(const std::string& name, ViewMesh& mesh, double made, float distance, std::size_t visits) {
    Orbit orbit;
    Float3 low = mesh.positions()[0], high = low;
    for (const Float3& p : mesh.positions()) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    orbit.centre = {(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
    orbit.diagonal = std::hypot(high.x - low.x, high.y - low.y, high.z - low.z);
    orbit.distance = distance;
    // The tolerance that makes about so many triangles.
    float least = 1e-4f, most = 100;
    for (int step = 0; step < 14; ++step) {
        const float middle = std::sqrt(least * most);
        settle(mesh, orbit.at(0, middle));
        (mesh.triangles().size() > kActive ? least : most) = middle;
    }
    const float pixels = most;
    settle(mesh, orbit.at(0, pixels));
    mesh.take_dirty();
    std::vector<double> frames;
    std::size_t active = 0, splits = 0, sent = 0, most_splits = 0;
    for (int frame = 1; frame <= kFrames; ++frame) {
        const View view = orbit.at(frame, pixels);
        const double start = cpu_seconds();
        const ViewUpdated done = mesh.update(view, {.max_visits = visits});
        const ViewMesh::Dirty dirty = mesh.take_dirty();
        frames.push_back(1e3 * (cpu_seconds() - start));
        active += mesh.triangles().size();
        splits += done.refined + done.coarsened;
        most_splits = std::max(most_splits, done.refined + done.coarsened);
        for (const auto& range : dirty.triangles) sent += sizeof(Triangle) * (range.end - range.begin);
    }
    double sum = 0;
    for (const double ms : frames) sum += ms;
    std::sort(frames.begin(), frames.end());
    fmt::print(
        "| {} | {:.2f} | {} | {:.2f} | {} | {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.0f} | {:.2f} |\n",
        name, distance, visits == kAll ? "all" : std::to_string(visits), pixels, active / kFrames,
        splits / kFrames, most_splits, sent / kFrames / 1024, sum / kFrames, frames[kFrames * 95 / 100],
        frames.back(), 1e3 * made, double(mesh.memory()) / (1 << 20));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "vsplit_bench_view FILE...: .pmesh, or meshes to bake first\n");
        return 2;
    }
    fmt::print(
        "| mesh | eye, diagonals off | visits | pixels | active triangles | splits a frame | most | KiB a "
        "frame | "
        "frame, mean "
        "ms | 95 % | worst | made in ms | MiB |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- "
        "| --- | --- | "
        "--- |\n| bar (goal) | | | | 100000 | | | | 4 (1) | | | | |\n");
    for (int i = 1; i < argc; ++i) {
        const std::string path = argv[i];
        for (const auto& [placement, word] : {std::pair(bake::Placement::kEndpoint, "endpoint"),
                                              std::pair(bake::Placement::kOptimal, "optimal")}) {
            const bool baked = path.ends_with(".pmesh");
            if (baked && placement != bake::Placement::kEndpoint) continue;
            auto record = load(path, placement);
            if (!record) {
                fmt::print(stderr, "{}: {}\n", path, record.error().describe());
                return 3;
            }
            const double start = cpu_seconds();
            auto mesh = ViewMesh::make(*std::move(record));
            const double made = cpu_seconds() - start;
            if (!mesh) {
                fmt::print(stderr, "{}: {}\n", path, mesh.error().describe());
                return 3;
            }
            const std::string name =
                path.substr(path.rfind('/') + 1) + (baked ? "" : std::string(", ") + word);
            for (const float distance : {1.2f, 0.6f})
                for (const std::size_t visits : {kAll, kFew}) row(name, *mesh, made, distance, visits);
        }
    }
}
