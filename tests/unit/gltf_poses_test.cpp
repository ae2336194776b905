// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Scenes as one mesh in the world, and the poses that animations give them.
#include <algorithm>
#include <cmath>

#include "gltf_scene.hpp"
#include "mesh_checks.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/live_mesh.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

Scene posed_scene(std::span<const std::byte> bytes, std::size_t poses) {
    GltfOptions options;
    options.poses = poses;
    auto scene = parse_scene(bytes, "", options);
    INFO((scene.ok() ? std::string() : scene.error().message));
    REQUIRE(scene.ok());
    return std::move(*scene);
}

std::size_t attribute(const Mesh& mesh, const std::string& name) {
    for (std::size_t a = 0; a < mesh.attributes.size(); ++a)
        if (mesh.attributes[a].name == name) return a;
    FAIL("no attribute " << name);
    return 0;
}

/// A sheet of n by n cells in the plane z = 0, its right half on a joint that turns by 90 degrees about the
/// line x = 0.5. `path` and `interpolation` of its animation, one number after another.
struct Hinge {
    GltfDocument document;

    explicit Hinge(int n = 16, const char* interpolation = "LINEAR", bool matrix = false) {
        GltfDocument& d = document;
        std::vector<float> positions, normals;
        std::vector<std::uint8_t> joints;
        std::vector<float> weights;
        std::vector<std::uint16_t> corners;
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n; ++j) {
                const float u = float(j) / float(n);
                positions.insert(positions.end(), {u, float(i) / float(n), 0});
                normals.insert(normals.end(), {0, 0, 1});
                joints.insert(joints.end(), {0, std::uint8_t(u > 0.5f ? 1 : 0), 0, 0});
                weights.insert(weights.end(), {u > 0.5f ? 0.0f : 1.0f, u > 0.5f ? 1.0f : 0.0f, 0, 0});
            }
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const int a = i * (n + 1) + j, b = a + n + 1;
                for (const int c : {a, a + 1, b + 1, a, b + 1, b}) corners.push_back(std::uint16_t(c));
            }
        const std::size_t count = positions.size() / 3;
        const std::size_t mesh = d.mesh({{"attributes",
                                          {{"POSITION", d.floats(positions)},
                                           {"NORMAL", d.floats(normals)},
                                           {"JOINTS_0", d.accessor(joints, 5121, "VEC4", count)},
                                           {"WEIGHTS_0", d.floats(weights, "VEC4", 4)}}},
                                         {"indices", d.shorts(corners)}});
        json turning = {{"name", "turning"}};
        if (matrix)
            turning["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 1};
        else
            turning["translation"] = {0.5, 0, 0};
        // The hips stand two to the right; the node of the mesh, elsewhere, says nothing.
        d.root["nodes"] = {{{"name", "hip"}, {"translation", {2, 0, 0}}, {"children", {1}}},
                           turning,
                           {{"mesh", mesh}, {"skin", 0}, {"translation", {0, 0, 7}}}};
        const std::vector<float> inverse = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,     0, 0, 1,
                                            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.5f, 0, 0, 1};
        d.root["skins"] = {{{"joints", {0, 1}}, {"inverseBindMatrices", d.floats(inverse, "MAT4", 16)}}};
        const float half = std::sqrt(0.5f);
        std::vector<float> turns = {0, 0, 0, 1, 0, half, 0, half};
        if (std::string(interpolation) == "CUBICSPLINE")
            turns = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, half, 0, half, 0, 0, 0, 0};
        const std::size_t times = d.floats({1, 3}, "SCALAR", 1);
        d.root["animations"] = {
            {{"samplers",
              {{{"input", times}, {"output", d.floats(turns, "VEC4", 4)}, {"interpolation", interpolation}}}},
             {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}}};
        d.scene({0, 2});
    }
};

}  // namespace

TEST_CASE("a scene as one mesh has its meshes where nodes place them, with their attributes") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    REQUIRE(scene.places.size() == 3);
    const auto placed = placed_mesh(scene);
    REQUIRE(placed.ok());
    REQUIRE(mesh_fault(*placed) == nullptr);
    REQUIRE(placed->triangles.size() == 96);
    REQUIRE(placed->attributes.size() == scene.mesh.attributes.size());
    // Material 0 for one primitive, and the number after the last for those without.
    REQUIRE(std::count(placed->groups.begin(), placed->groups.end(), 0u) == 16);
    REQUIRE(std::count(placed->groups.begin(), placed->groups.end(), 1u) == 80);
    float low = 10, high = -10;
    for (const Float3& p : placed->positions) {
        low = std::min(low, p.x);
        high = std::max(high, p.x);
    }
    REQUIRE(low == 0);
    REQUIRE(high == Approx(8));  // 3 + 5 * 1
    REQUIRE(placed_mesh(scene, 95).error().code == ErrorCode::kLimit);
    Scene nowhere = scene;
    nowhere.places.clear();
    REQUIRE(placed_mesh(nowhere).error().code == ErrorCode::kMalformed);
}

TEST_CASE("a mirroring, stretching node turns triangles, normals, tangents and morph offsets with it") {
    GltfDocument d;
    const Sheet sheet(2);
    const std::size_t position = d.floats(sheet.positions);
    std::vector<float> offsets;
    for (std::size_t v = 0; v < sheet.vertices; ++v) offsets.insert(offsets.end(), {1, 0, 0.5f});
    const float s = std::sqrt(0.5f);
    std::vector<float> normals, tangents;
    for (std::size_t v = 0; v < sheet.vertices; ++v) {
        normals.insert(normals.end(), {s, 0, s});
        tangents.insert(tangents.end(), {s, 0, -s, 1});
    }
    const std::size_t mesh = d.mesh({{"attributes",
                                      {{"POSITION", position},
                                       {"NORMAL", d.floats(normals)},
                                       {"TANGENT", d.floats(tangents, "VEC4", 4)}}},
                                     {"targets", {{{"POSITION", d.floats(offsets)}}}},
                                     {"indices", d.shorts(sheet.corners)}});
    d.scene({d.node({{"mesh", mesh}, {"scale", {-2, 1, 1}}})});
    const Scene scene = scene_of(d.glb());
    const auto placed = placed_mesh(scene);
    REQUIRE(placed.ok());
    const Mesh& m = *placed;
    const auto at = [&](const char* name, std::size_t c) {
        return m.attributes[attribute(m, name)].values[c];
    };
    // Normals by the inverse transposed: (s / -2, 0, s), made unit again.
    REQUIRE(at("NORMAL", 0) == Approx(-0.5 / std::sqrt(1.25)));
    REQUIRE(at("NORMAL", 2) == Approx(1 / std::sqrt(1.25)));
    REQUIRE(at("TANGENT", 0) == Approx(-2 / std::sqrt(5.0)));
    REQUIRE(at("TANGENT", 2) == Approx(-1 / std::sqrt(5.0)));
    REQUIRE(at("TANGENT", 3) == -1);
    REQUIRE(at("0/POSITION", 0) == -2);
    REQUIRE(at("0/POSITION", 2) == 0.5f);
    for (const Triangle& t : m.triangles) {
        const Float3 &a = m.positions[t[0]], &b = m.positions[t[1]], &c = m.positions[t[2]];
        REQUIRE((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0);
    }
}

TEST_CASE("poses are what the animation does to joints and morph weights at evenly spread times") {
    const Scene still = posed_scene(RichScene().document.glb(), 0);
    REQUIRE(still.poses.empty());
    const Scene scene = posed_scene(RichScene().document.glb(), 2);
    REQUIRE(scene.poses.sets.size() == 1);
    REQUIRE(scene.poses.sets[0].size() == 2);
    REQUIRE(scene.poses.sets[0][0].morphs == std::vector<double>{0.25, 0.25});
    REQUIRE(scene.poses.sets[0][1].morphs == std::vector<double>{0.75, 0.75});
    REQUIRE(scene.poses.sets[0][0].joints.size() == 2);
    for (std::size_t v = 0; v < scene.poses.set_of.size(); ++v)
        REQUIRE(scene.poses.set_of[v] == (scene.part_of[v] == 0 ? 0 : PoseSets::kNone));
    for (const char* between : {"LINEAR", "STEP", "CUBICSPLINE"})
        for (const bool matrix : {false, true}) {
            const Scene hinge = posed_scene(Hinge(4, between, matrix).document.glb(), 1);
            REQUIRE(hinge.poses.sets.size() == 1);
            const auto& joints = hinge.poses.sets[0][0].joints;
            REQUIRE(joints.size() == 2);
            // Halfway: 45 degrees; a step stays at its first key. The joint that turns also loses its matrix,
            // which an animated node must not have.
            const double angle = std::string(between) == "STEP" ? 0 : std::acos(-1.0) / 4;
            const double scale = std::ldexp(1.0, hinge.parts[0].exponent);
            REQUIRE(joints[1][0] == Approx(std::cos(angle)));
            REQUIRE(joints[1][8] == Approx(-std::sin(angle)).margin(1e-9));
            const double origin = matrix ? 2 : 2.5;
            REQUIRE(joints[1][3] / scale == Approx(origin - 0.5 * std::cos(angle)));
            REQUIRE(joints[0][3] / scale == Approx(2));
            // In the world, places are the node's seven up, which its joints take back.
            const Pose& placed = hinge.places[0].poses.at(0);
            REQUIRE(placed.joints[0][11] == Approx(-7));
        }
    const Scene many = posed_scene(Hinge(4).document.glb(), 5000);
    REQUIRE(many.poses.sets[0].size() == 1024);
}

TEST_CASE("animations that cannot be read are left out, and said") {
    const auto broken = [](const auto& change) {
        Hinge hinge(4);
        change(hinge.document.root);
        return posed_scene(hinge.document.glb(), 4);
    };
    for (int i = 0; i < 6; ++i) {
        CAPTURE(i);
        const Scene scene = broken([&](json& root) {
            json& animation = root["animations"][0];
            switch (i) {
                case 0:
                    animation["samplers"][0]["output"] = 0;  // places
                    break;
                case 1:
                    animation["samplers"][0]["input"] = 99;
                    break;
                case 2:
                    animation["channels"][0]["sampler"] = 7;
                    break;
                case 3:
                    animation["channels"][0]["target"]["node"] = 70;
                    break;
                case 4:
                    root["accessors"][animation["samplers"][0]["input"].get<std::size_t>()]["count"] = 1;
                    break;
                default:
                    animation["samplers"] = 3;
            }
        });
        REQUIRE(scene.poses.empty());
        REQUIRE(std::any_of(scene.notes.begin(), scene.notes.end(), [](const std::string& note) {
            return note.find("cannot be read") != std::string::npos;
        }));
    }
    // A path that nobody knows is an extension's.
    REQUIRE(broken([](json& root) {
                root["animations"][0]["channels"][0]["target"]["path"] = "pointer";
            }).poses.empty());
}

TEST_CASE("what folds in a pose keeps its fold, and the recorded error tells of poses") {
    // Flat in the bind pose, so that nothing but poses speaks for the line where it folds. Joint weights
    // count nothing here.
    const Scene scene = posed_scene(Hinge(16).document.glb(), 4);
    CollapseOptions options;
    options.attribute_weights.joints = 0;
    options.part_of = scene.part_of;
    const auto folded = [&](const Mesh& mesh) {
        // By the joints alone, at the end of the animation; the hinge is at x = 0.5.
        Mesh out = mesh;
        const auto& joints = mesh.attributes[attribute(mesh, "JOINTS_0")].values;
        const auto& weights = mesh.attributes[attribute(mesh, "WEIGHTS_0")].values;
        const float hinge = 0.5f * std::ldexp(1.0f, scene.parts[0].exponent);
        for (std::size_t v = 0; v < out.positions.size(); ++v) {
            float turned = 0;
            for (std::size_t j = 4 * v; j < 4 * v + 4; ++j)
                if (joints[j] == 1) turned += weights[j];
            Float3& p = out.positions[v];
            const Float3 moved{hinge, p.y, -(p.x - hinge)};
            p = {p.x + turned * (moved.x - p.x), p.y, turned * moved.z};
        }
        return out;
    };
    const Mesh full = folded(scene.mesh);
    double apart[2], told[2];
    for (const bool posed : {false, true}) {
        CollapseOptions with = options;
        if (posed) with.poses = scene.poses;
        const auto baked = collapse(scene.mesh, with);
        REQUIRE(baked.ok());
        REQUIRE(progressive_mesh_fault(baked->mesh) == nullptr);
        REQUIRE(baked->mesh.attributes.size() == scene.mesh.attributes.size());
        const std::size_t level = level_for_triangles(baked->mesh, 32);
        const Mesh coarse = folded(cut(baked->mesh, level));
        apart[posed] = distance_to(coarse, full.positions);
        told[posed] = error_at(baked->mesh, level);
        // Everything comes back.
        const Mesh back = cut(baked->mesh, baked->mesh.splits.size());
        REQUIRE(triangle_bits(back) == triangle_bits(scene.mesh));
    }
    CAPTURE(apart[0], apart[1], told[0], told[1]);
    REQUIRE(apart[1] < 0.5 * apart[0]);
    REQUIRE(told[1] > told[0]);
    REQUIRE(apart[1] <= 1.5 * told[1] + 1e-6);
}
