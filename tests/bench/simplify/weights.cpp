// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "weights.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "vsplit/bake/collapse.hpp"
#include "vsplit/live_mesh.hpp"

namespace vsplit::bench {
namespace {

constexpr double kLimitSeconds = 600;
constexpr double kMarked = 568.0 / 2645;
constexpr float kWeight = 10;
constexpr double kWeightRatios[] = {0.6, 0.4, 0.1};

/// A ball around the first vertex that holds the marked ones.
struct Ball {
    Float3 centre;
    double radius2 = 0;

    double distance2(const Float3& p) const {
        const double x = double(p.x) - double(centre.x), y = double(p.y) - double(centre.y),
                     z = double(p.z) - double(centre.z);
        return x * x + y * y + z * z;
    }
    bool has(const Float3& p) const { return distance2(p) <= radius2; }
};

Ball marked_ball(const Mesh& mesh) {
    Ball ball{mesh.positions.front()};
    std::vector<double> distances;
    for (const Float3& p : mesh.positions) distances.push_back(ball.distance2(p));
    const auto at = distances.begin() + std::ptrdiff_t(kMarked * double(distances.size()));
    std::nth_element(distances.begin(), at, distances.end());
    ball.radius2 = *at;
    return ball;
}

/// The triangles that have no corner in the ball.
Mesh rest_of(const Mesh& mesh, const Ball& ball) {
    Mesh rest;
    rest.positions = mesh.positions;
    for (const Triangle& t : mesh.triangles)
        if (std::none_of(t.begin(), t.end(), [&](std::uint32_t v) { return ball.has(mesh.positions[v]); }))
            rest.triangles.push_back(t);
    return rest;
}

std::size_t rest_triangles(const LiveMesh& live, const Ball& ball) {
    const auto positions = live.positions();
    return std::size_t(
        std::count_if(live.triangles().begin(), live.triangles().end(), [&](const Triangle& t) {
            return std::none_of(t.begin(), t.end(), [&](std::uint32_t v) { return ball.has(positions[v]); });
        }));
}

Result<Json> run(const Mesh& mesh, const ruler::RulerOptions& options) {
    const Ball ball = marked_ball(mesh);
    const auto inside = [&](std::span<const Float3> positions) {
        return double(
            std::count_if(positions.begin(), positions.end(), [&](const Float3& p) { return ball.has(p); }));
    };
    const Mesh rest = rest_of(mesh, ball);
    if (rest.triangles.empty())
        return Error{ErrorCode::kUnsupported, "nothing is left beside the marked area", Error::kNowhere, 0};
    Mesh painted = mesh;
    for (const Float3& p : mesh.positions) painted.weights.push_back(ball.has(p) ? kWeight : 1.0f);
    auto with = bake::collapse(painted);
    if (!with) return with.error();
    auto without = bake::collapse(mesh);
    if (!without) return without.error();
    LiveMesh weighted(std::move(with->mesh)), plain(std::move(without->mesh));
    const auto away = [&](const LiveMesh& live) -> Result<double> {
        auto ruler = ruler::Ruler::over(live.snapshot(), options);
        if (!ruler) return ruler.error();
        const auto measured = ruler->measure(rest);
        if (!measured) return measured.error();
        return measured->to_reference.mean;
    };
    WeightRun result;
    const double marked = inside(mesh.positions);
    result.marked = marked / double(mesh.positions.size());
    for (const double ratio : kWeightRatios) {
        const auto count = std::uint64_t(ratio * double(mesh.positions.size()));
        weighted.go_to(level_for_vertices(weighted.state(), count));
        plain.go_to(level_for_vertices(plain.state(), count));
        WeightCheck check{ratio, inside(weighted.positions()) / marked, inside(plain.positions()) / marked,
                          0};
        // The unweighted level with as many triangles in the rest.
        const std::size_t wanted = rest_triangles(weighted, ball);
        std::size_t low = 0, high = plain.max_level();
        while (low < high) {
            const std::size_t middle = low + (high - low) / 2;
            plain.go_to(middle);
            if (rest_triangles(plain, ball) < wanted)
                low = middle + 1;
            else
                high = middle;
        }
        plain.go_to(low);
        const auto a = away(weighted), b = away(plain);
        if (!a) return a.error();
        if (!b) return b.error();
        check.rest = *a / *b;
        result.checks.push_back(check);
    }
    return Json(result);
}

}  // namespace

WeightRun measure_weights(const Model& model, const ruler::RulerOptions& options) {
    WeightRun result;
    const auto mesh = model.load();
    if (!mesh) {
        result.reason = mesh.error().describe();
    } else if (mesh->triangles.empty()) {
        result.reason = "no triangles";
    } else {
        std::fprintf(stderr, "%s: weights\n", model.name.c_str());
        const auto answer = in_child([&] { return run(*mesh, options); }, kLimitSeconds);
        if (answer)
            result = answer->get<WeightRun>();
        else
            result.reason = answer.error().message;
    }
    result.model = model.name;
    return result;
}

}  // namespace vsplit::bench
