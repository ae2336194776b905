// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Meshes with attributes: seams stay closed, and everything comes back.
#include <tbb/global_control.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "family.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

/// A tube of n by m quads, its texture cut along one line and wrapped in two charts; normals; skin.
Mesh make_skinned_tube(std::uint32_t n, std::uint32_t m) {
    Mesh mesh;
    mesh.attributes = {
        {"NORMAL", Semantic::kNormal, 3, {}},         {"TANGENT", Semantic::kTangent, 4, {}},
        {"TEXCOORD_0", Semantic::kTexcoord, 2, {}},   {"COLOR_0", Semantic::kColor, 3, {}},
        {"JOINTS_0", Semantic::kJoints, 4, {}},       {"WEIGHTS_0", Semantic::kJointWeights, 4, {}},
        {"0/POSITION", Semantic::kMorphOffset, 3, {}}};
    const auto add = [&](std::uint32_t attribute, std::initializer_list<double> values) {
        for (const double value : values) mesh.attributes[attribute].values.push_back(float(value));
    };
    const auto vertex = [&](std::uint32_t i, std::uint32_t j, double u) {
        // The angle of the first and last column must be the same to the bit.
        const double angle = 2 * 3.14159265358979 * double(i % n) / n, z = 4.0 * j / m;
        const double r = 1 + 0.1 * std::sin(3 * angle) * std::sin(2 * z);
        mesh.positions.push_back({float(r * std::cos(angle)), float(r * std::sin(angle)), float(z)});
        add(0, {std::cos(angle), std::sin(angle), 0});
        add(1, {-std::sin(angle), std::cos(angle), 0, u < 0.5 ? 1.0 : -1.0});
        add(2, {u, z / 4});
        add(3, {0.5 + 0.5 * std::cos(angle), z / 4, 0.25});
        add(4, {0, double(1 + j * 3 / m), 0, 0});
        add(5, {1 - z / 4.5, z / 4.5, 0, 0});
        add(6, {0.1 * z, 0, 0});
        return std::uint32_t(mesh.positions.size() - 1);
    };
    // Two charts, each with its own vertices at both borders.
    for (const std::uint32_t chart : {0u, 1u}) {
        const std::uint32_t first = std::uint32_t(mesh.positions.size()), half = n / 2;
        for (std::uint32_t j = 0; j <= m; ++j)
            for (std::uint32_t i = 0; i <= half; ++i)
                vertex(chart * half + i, j, (chart == 0 ? 0.0 : 0.5) + 0.48 * i / half);
        for (std::uint32_t j = 0; j < m; ++j)
            for (std::uint32_t i = 0; i < half; ++i) {
                const std::uint32_t a = first + j * (half + 1) + i, b = a + half + 1;
                mesh.triangles.push_back({a, a + 1, b + 1});
                mesh.triangles.push_back({a, b + 1, b});
                for (int k = 0; k < 2; ++k) mesh.groups.push_back(chart);
            }
    }
    return mesh;
}

using Key = std::tuple<float, float, float>;
Key key_of(const Float3& p) {
    return {p.x, p.y, p.z};
}

/// Edges by places that one triangle has, other than around the two ends of the tube.
std::size_t cracks(const Mesh& mesh) {
    std::map<std::pair<Key, Key>, int> edges;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            Key a = key_of(mesh.positions[t[k]]), b = key_of(mesh.positions[t[(k + 1) % 3]]);
            if (b < a) std::swap(a, b);
            ++edges[{a, b}];
        }
    return std::size_t(std::count_if(edges.begin(), edges.end(), [](const auto& e) {
        const float a = std::get<2>(e.first.first), b = std::get<2>(e.first.second);
        return e.second == 1 && std::max(a, b) > 0.4f && std::min(a, b) < 3.6f;
    }));
}

/// Vertices at one place that joints or morph targets would move apart.
std::size_t apart_in_motion(const Mesh& mesh) {
    std::map<Key, std::vector<float>> motion;
    std::size_t apart = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        std::vector<float> own;
        for (const Attribute& a : mesh.attributes)
            if (a.semantic == Semantic::kJoints || a.semantic == Semantic::kJointWeights ||
                a.semantic == Semantic::kMorphOffset)
                own.insert(own.end(), a.values.begin() + std::ptrdiff_t(a.components * v),
                           a.values.begin() + std::ptrdiff_t(a.components * (v + 1)));
        const auto [there, fresh] = motion.emplace(key_of(mesh.positions[v]), own);
        apart += !fresh && there->second != own;
    }
    return apart;
}

/// All triangles with all that their corners carry, in one order.
std::multiset<std::vector<float>> contents(const Mesh& mesh) {
    std::multiset<std::vector<float>> all;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::vector<std::vector<float>> corners;
        for (const std::uint32_t v : mesh.triangles[t]) {
            std::vector<float> corner{mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z};
            if (!mesh.weights.empty()) corner.push_back(mesh.weights[v]);
            for (const Attribute& a : mesh.attributes)
                corner.insert(corner.end(), a.values.begin() + std::ptrdiff_t(a.components * v),
                              a.values.begin() + std::ptrdiff_t(a.components * (v + 1)));
            corners.push_back(corner);
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        std::vector<float> flat{mesh.groups.empty() ? 0.0f : float(mesh.groups[t])};
        for (const auto& corner : corners) flat.insert(flat.end(), corner.begin(), corner.end());
        all.insert(flat);
    }
    return all;
}

}  // namespace

TEST_CASE("Attributes: a skinned, textured tube in two charts keeps its seams closed at every level") {
    Mesh mesh = make_skinned_tube(48, 40);
    for (const bool painted : {false, true}) {
        if (painted)
            for (std::size_t v = 0; v < mesh.positions.size(); ++v)
                mesh.weights.push_back(mesh.positions[v].z > 3 ? 10.0f : 1.0f);
        for (const bake::Placement placement : {bake::Placement::kOptimal, bake::Placement::kEndpoint}) {
            CAPTURE(painted, int(placement));
            bake::CollapseOptions options;
            options.placement = placement;
            auto result = bake::collapse(mesh, options);
            REQUIRE(result.ok());
            const char* fault = progressive_mesh_fault(result->mesh);
            REQUIRE((fault ? fault : std::string("sound")) == "sound");
            REQUIRE(result->mesh.attributes.size() == mesh.attributes.size());
            REQUIRE(result->mesh.base_triangles * 20 < mesh.triangles.size());
            LiveMesh live(result->mesh);
            const Mesh base = live.snapshot();
            for (std::size_t level = 0; level <= live.max_level(); level += 1 + level / 8) {
                live.go_to(level);
                const Mesh now = live.snapshot();
                REQUIRE(mesh_fault(now) == nullptr);
                REQUIRE(apart_in_motion(now) == 0);
                // Only the two ends of the tube are open: no crack between charts.
                REQUIRE(cracks(now) == 0);
                for (const Attribute& a : now.attributes) {
                    if (a.semantic == Semantic::kNormal)
                        for (std::size_t i = 0; i < a.values.size(); i += 3)
                            REQUIRE(std::hypot(a.values[i], a.values[i + 1], a.values[i + 2]) ==
                                    Approx(1).margin(1e-5));
                    if (a.semantic == Semantic::kTangent)
                        for (std::size_t i = 3; i < a.values.size(); i += 4)
                            REQUIRE(std::abs(a.values[i]) == 1);
                    if (a.semantic == Semantic::kJointWeights)
                        for (std::size_t i = 0; i < a.values.size(); i += 4)
                            REQUIRE(a.values[i] + a.values[i + 1] + a.values[i + 2] + a.values[i + 3] ==
                                    Approx(1).margin(1e-5));
                }
            }
            live.go_to(live.max_level());
            REQUIRE(contents(live.snapshot()) == contents(mesh));
            live.go_to(0);
            const Mesh again = live.snapshot();
            REQUIRE(again.triangles == base.triangles);
            REQUIRE(again.positions == base.positions);
            REQUIRE(again.attributes == base.attributes);
        }
    }
}

TEST_CASE("Attributes: a texture stays where it is, and the charts keep their shape") {
    const Mesh mesh = make_skinned_tube(96, 80);
    auto result = bake::collapse(mesh, {});
    REQUIRE(result.ok());
    const Mesh tenth = cut(result->mesh, level_for_triangles(result->mesh, mesh.triangles.size() / 10));
    const Attribute& uv = tenth.attributes[2];
    const Attribute& normal = tenth.attributes[0];
    double worst_v = 0, worst_normal = 1;
    for (std::size_t v = 0; v < tenth.positions.size(); ++v) {
        const Float3& p = tenth.positions[v];
        worst_v = std::max(worst_v, std::abs(double(uv.values[2 * v + 1]) - double(p.z) / 4));
        const double r = std::hypot(p.x, p.y);
        worst_normal = std::min(worst_normal, (double(normal.values[3 * v]) * double(p.x) +
                                               double(normal.values[3 * v + 1]) * double(p.y)) /
                                                  r);
    }
    REQUIRE(worst_v < 0.01);
    REQUIRE(worst_normal > 0.98);
    // Vertices of each chart stay in it.
    for (std::size_t t = 0; t < tenth.triangles.size(); ++t)
        for (const std::uint32_t v : tenth.triangles[t])
            REQUIRE((tenth.groups[t] == 0 ? uv.values[2 * v] <= 0.4801f : uv.values[2 * v] >= 0.4999f));
}

TEST_CASE("Attributes: colours, joints, morph offsets and custom values stay where they were") {
    Mesh mesh = make_skinned_tube(96, 80);
    mesh.attributes.push_back({"_HEAT", Semantic::kOther, 1, {}});
    for (const Float3& p : mesh.positions) mesh.attributes.back().values.push_back(100 * p.z);
    auto result = bake::collapse(mesh, {});
    REQUIRE(result.ok());
    const Mesh tenth = cut(result->mesh, level_for_triangles(result->mesh, mesh.triangles.size() / 10));
    double colour = 0, tangent = 1, weight = 0, offset = 0, heat = 0;
    for (std::size_t v = 0; v < tenth.positions.size(); ++v) {
        const auto value = [&](std::size_t attribute, std::size_t component) {
            const Attribute& a = tenth.attributes[attribute];
            return double(a.values[a.components * v + component]);
        };
        const Float3& p = tenth.positions[v];
        const double r = std::hypot(p.x, p.y), z = double(p.z);
        tangent = std::min(tangent, (value(1, 1) * double(p.x) - value(1, 0) * double(p.y)) / r);
        colour = std::max({colour, std::abs(value(3, 0) - (0.5 + 0.5 * double(p.x) / r)),
                           std::abs(value(3, 1) - z / 4), std::abs(value(3, 2) - 0.25)});
        offset = std::max(offset, std::abs(value(6, 0) - 0.1 * z));
        heat = std::max(heat, std::abs(value(7, 0) - 100 * z));
        // Joints are of the input's: the root in one place, one of the others by height in another.
        double root = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const double joint = value(4, k);
            REQUIRE((joint >= 0 && joint <= 4 && joint == std::floor(joint)));
            if (joint == 0) root += value(5, k);
            if (value(5, k) > 0.1 && joint > 0) REQUIRE(std::abs(joint - (1 + std::floor(z * 3 / 4))) <= 1);
        }
        weight = std::max(weight, std::abs(root - (1 - z / 4.5)));
    }
    CAPTURE(colour, tangent, weight, offset, heat);
    REQUIRE(colour < 0.05);
    REQUIRE(tangent > 0.98);
    REQUIRE(weight < 0.02);
    REQUIRE(offset < 0.005);
    REQUIRE(heat < 5);
}

TEST_CASE("Attributes: the same for any number of threads, with either cost") {
    for (const bake::Cost cost : {bake::Cost::kQuadric, bake::Cost::kPaper}) {
        const Mesh mesh =
            cost == bake::Cost::kPaper ? make_skinned_tube(60, 50) : make_skinned_tube(200, 170);
        bake::CollapseOptions options;
        options.cost = cost;
        options.calibrate = false;
        ProgressiveMesh first;
        for (const std::size_t threads : {1u, 3u}) {
            const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
            auto result = bake::collapse(mesh, options);
            REQUIRE(result.ok());
            REQUIRE(progressive_mesh_fault(result->mesh) == nullptr);
            if (threads == 1)
                first = std::move(result->mesh);
            else {
                REQUIRE(result->mesh.positions == first.positions);
                REQUIRE(result->mesh.triangles == first.triangles);
                REQUIRE(result->mesh.parents == first.parents);
                REQUIRE(result->mesh.attributes == first.attributes);
                REQUIRE(result->mesh.moved_values == first.moved_values);
                REQUIRE(result->mesh.groups == first.groups);
            }
        }
    }
}

TEST_CASE("Attributes: parts share no point, and unlike wedges make seams of the family's meshes") {
    for (auto& [name, plain] : mesh_family()) {
        CAPTURE(name);
        Mesh mesh = plain;
        mesh.weights.clear();
        // Every triangle for itself: all edges are seams; and then all alike.
        for (const bool apart : {true, false}) {
            mesh.attributes.clear();
            mesh.groups.assign(mesh.triangles.size(), 0);
            if (apart)
                for (std::size_t t = 0; t < mesh.triangles.size(); ++t) mesh.groups[t] = std::uint32_t(t % 7);
            mesh.attributes.push_back({"_HEAT", Semantic::kOther, 1, {}});
            for (std::size_t v = 0; v < mesh.positions.size(); ++v)
                mesh.attributes[0].values.push_back(float(v % 13));
            const auto result = bake::collapse(mesh, {});
            REQUIRE(result.ok());
            const char* fault = progressive_mesh_fault(result->mesh);
            REQUIRE((fault ? fault : std::string("sound")) == "sound");
            REQUIRE(contents(cut(result->mesh, result->mesh.splits.size())) == contents(mesh));
        }
    }
    // Two squares at the same place.
    Mesh two = join(make_grid(4), make_grid(4));
    two.groups.assign(two.triangles.size(), 0);
    bake::CollapseOptions options;
    for (std::size_t v = 0; v < two.positions.size(); ++v)
        options.part_of.push_back(v < two.positions.size() / 2 ? 0 : 1);
    const auto apart = bake::collapse(two, options);
    REQUIRE(apart.ok());
    REQUIRE(apart->report.components == 2);
    options.part_of.pop_back();
    REQUIRE(!bake::collapse(two, options).ok());
}

TEST_CASE("Attributes: triangles with two corners at one point come back at the end") {
    Mesh mesh = make_skinned_tube(16, 12);
    const std::size_t plain = mesh.triangles.size();
    // Across the seam between the charts; and one with vertices that no other triangle has.
    const auto twin = [&](std::uint32_t v) {
        for (std::uint32_t w = v + 1; w < mesh.positions.size(); ++w)
            if (mesh.positions[w] == mesh.positions[v]) return w;
        return v;
    };
    std::uint32_t seam = 20;
    while (twin(seam) == seam) ++seam;
    mesh.triangles.push_back({seam, twin(seam), 0});
    mesh.groups.push_back(1);
    const auto again = [&](std::uint32_t v) {
        mesh.positions.push_back(mesh.positions[v]);
        for (Attribute& a : mesh.attributes) {
            const std::vector<float> values(a.values.begin() + std::ptrdiff_t(a.components * v),
                                            a.values.begin() + std::ptrdiff_t(a.components * (v + 1)));
            a.values.insert(a.values.end(), values.begin(), values.end());
        }
        return std::uint32_t(mesh.positions.size() - 1);
    };
    const std::uint32_t fresh = again(30);
    mesh.triangles.push_back({fresh, again(30), again(31)});
    mesh.groups.push_back(0);
    const auto result = bake::collapse(mesh, {});
    REQUIRE(result.ok());
    REQUIRE(progressive_mesh_fault(result->mesh) == nullptr);
    REQUIRE(result->report.degenerate_triangles == 2);
    const std::size_t last = result->mesh.splits.size();
    REQUIRE(triangles_at(result->mesh, last) == plain + 2);
    REQUIRE(triangles_at(result->mesh, last - 1) == plain);
    REQUIRE(error_at(result->mesh, last - 1) == 0);
    REQUIRE(contents(cut(result->mesh, last)) == contents(mesh));
    // And out of the file.
    WriteOptions exact;
    exact.position_bits = 0;
    const auto bytes = write_progressive_mesh(result->mesh, exact);
    REQUIRE(bytes.ok());
    const auto back = read_progressive_mesh(*bytes);
    REQUIRE(back.ok());
    REQUIRE(contents(cut(*back, back->splits.size())) == contents(mesh));
}
