// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "pack.hpp"
#include "scene_document.hpp"
#include "transforms.hpp"
#include "vsplit/bake/scene.hpp"

namespace vsplit::bake {
namespace {

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}

/// The linear part of a place and the one that turns normals, up to its length.
struct Turn {
    explicit Turn(const Matrix& m) : mirrored(determinant(m) < 0) {
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t r = 0; r < 3; ++r) linear[3 * c + r] = m[4 * c + r];
        // The cofactors: the inverse transposed, times the determinant.
        const double sign = mirrored ? -1 : 1;
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t r = 0; r < 3; ++r) {
                const std::size_t c1 = (c + 1) % 3, c2 = (c + 2) % 3, r1 = (r + 1) % 3, r2 = (r + 2) % 3;
                normal[3 * c + r] = sign * (linear[3 * c1 + r1] * linear[3 * c2 + r2] -
                                            linear[3 * c1 + r2] * linear[3 * c2 + r1]);
            }
    }
    std::array<double, 9> linear{}, normal{};
    bool mirrored;
};

std::array<double, 3> times(const std::array<double, 9>& m, const float* v) {
    std::array<double, 3> out{};
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t r = 0; r < 3; ++r) out[r] += m[3 * c + r] * double(v[c]);
    return out;
}

double length(const std::array<double, 3>& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// Finite, whatever the matrix is.
float narrowed(double value) {
    constexpr double kMost = std::numeric_limits<float>::max();
    return std::isfinite(value) ? float(std::clamp(value, -kMost, kMost)) : 0.0f;
}

/// Writes v over `out`, times `scale`.
void put(const std::array<double, 3>& v, double scale, float* out) {
    for (std::size_t i = 0; i < 3; ++i) out[i] = narrowed(v[i] * scale);
}

/// The factor that makes the unit vector `v` one again after `m`; 0 if nothing is left of it.
double stretch(const std::array<double, 9>& m, const float* v) {
    const double n = length(times(m, v));
    return n > 0 && std::isfinite(n) ? 1 / n : 0;
}

/// Which attribute has the base's values for a morph target's, as NORMAL for "2/NORMAL"; none: the count.
std::size_t base_of(const Mesh& mesh, Semantic semantic) {
    std::size_t a = 0;
    while (a < mesh.attributes.size() && mesh.attributes[a].semantic != semantic) ++a;
    return a;
}

/// Turns one part's vertices from `begin` on, in coordinates of the mesh times 2^exponent, to the world.
class Placer {
  public:
    Placer(const Mesh& from, Mesh& to)
        : from_(from),
          to_(to),
          normals_(base_of(from, Semantic::kNormal)),
          tangents_(base_of(from, Semantic::kTangent)) {}

    void place(const ScenePart& part, const Matrix& matrix) {
        const Turn turn(matrix);
        const bool as_is = matrix == kIdentity;
        for (std::uint32_t v = part.first_vertex; v < part.end_vertex; ++v) {
            const Float3& p = from_.positions[v];
            const float at[3] = {std::ldexp(p.x, -part.exponent), std::ldexp(p.y, -part.exponent),
                                 std::ldexp(p.z, -part.exponent)};
            float out[3] = {at[0], at[1], at[2]};
            if (!as_is) {
                const auto moved = times(turn.linear, at);
                for (std::size_t r = 0; r < 3; ++r) out[r] = narrowed(moved[r] + matrix[12 + r]);
            }
            to_.positions.push_back({out[0], out[1], out[2]});
            if (!from_.weights.empty()) to_.weights.push_back(from_.weights[v]);
        }
        for (std::size_t a = 0; a < from_.attributes.size(); ++a) {
            const Attribute& source = from_.attributes[a];
            const auto n = std::size_t{source.components};
            std::vector<float>& values = to_.attributes[a].values;
            const std::size_t begin = values.size();
            values.insert(values.end(), source.values.begin() + std::ptrdiff_t(part.first_vertex * n),
                          source.values.begin() + std::ptrdiff_t(part.end_vertex * n));
            const std::size_t count = part.end_vertex - part.first_vertex;
            for (std::size_t i = 0; i < count; ++i)
                turn_value(source.semantic, part.first_vertex + i, part.exponent, turn, as_is,
                           values.data() + begin + n * i);
        }
    }

  private:
    void turn_value(Semantic semantic, std::size_t vertex, int exponent, const Turn& turn, bool as_is,
                    float* value) const {
        const auto base = [&](std::size_t attribute) -> const float* {
            if (attribute == from_.attributes.size()) return nullptr;
            const Attribute& a = from_.attributes[attribute];
            return a.values.data() + vertex * a.components;
        };
        switch (semantic) {
            case Semantic::kMorphOffset:
                for (std::size_t i = 0; i < 3; ++i) value[i] = std::ldexp(value[i], -exponent);
                if (!as_is) put(times(turn.linear, value), 1, value);
                return;
            case Semantic::kNormal:
                if (!as_is) put(times(turn.normal, value), stretch(turn.normal, value), value);
                return;
            case Semantic::kTangent:
                if (as_is) return;
                put(times(turn.linear, value), stretch(turn.linear, value), value);
                if (turn.mirrored) value[3] = -value[3];
                return;
            case Semantic::kMorphNormal:
                if (const float* n = base(normals_); n != nullptr && !as_is)
                    put(times(turn.normal, value), stretch(turn.normal, n), value);
                return;
            case Semantic::kMorphTangent:
                if (const float* t = base(tangents_); t != nullptr && !as_is)
                    put(times(turn.linear, value), stretch(turn.linear, t), value);
                return;
            case Semantic::kTexcoord:
            case Semantic::kColor:
            case Semantic::kJoints:
            case Semantic::kJointWeights:
            case Semantic::kOther:
                return;
        }
    }

    const Mesh& from_;
    Mesh& to_;
    std::size_t normals_, tangents_;
};

/// Per primitive of the scene, the number of its material.
std::vector<std::uint32_t> materials_of(const Scene& scene) {
    const OrderedJson& root = scene.document->root;
    const std::size_t count = root.contains("materials") ? root["materials"].size() : 0;
    std::vector<std::uint32_t> out;
    for (const ScenePrimitive& primitive : scene.primitives) {
        const OrderedJson& source =
            root.at("meshes").at(primitive.mesh).at("primitives").at(primitive.primitive);
        const auto material = source.find("material");
        const bool given = material != source.end() && material->is_number_unsigned() &&
                           material->get<std::uint64_t>() < count;
        out.push_back(given ? material->get<std::uint32_t>() : std::uint32_t(count));
    }
    return out;
}

/// The scene's colours with white where a primitive has none: what a viewer takes there.
std::vector<Attribute> colours_of(const Scene& scene) {
    std::vector<Attribute> out = scene.mesh.attributes;
    std::vector<std::uint32_t> group(scene.mesh.positions.size(), 0);
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t)
        for (const std::uint32_t v : scene.mesh.triangles[t]) group[v] = scene.mesh.groups[t];
    for (std::size_t a = 0; a < out.size(); ++a) {
        if (out[a].semantic != Semantic::kColor) continue;
        std::vector<std::uint8_t> has(scene.primitives.size(), 0);
        for (std::size_t g = 0; g < has.size(); ++g)
            for (const StoredAttribute& stored : scene.primitives[g].attributes)
                if (stored.attribute == a) has[g] = 1;
        for (std::size_t v = 0; v < group.size(); ++v)
            if (has[group[v]] == 0)
                std::fill_n(out[a].values.begin() + std::ptrdiff_t(v * out[a].components), out[a].components,
                            1.0f);
    }
    return out;
}

}  // namespace

Result<Mesh> placed_mesh(const Scene& scene, std::uint64_t max_triangles) {
    const Mesh& from = scene.mesh;
    // Triangles of a part follow each other, as its vertices do.
    std::vector<std::size_t> ends;
    std::size_t t = 0;
    for (const ScenePart& part : scene.parts) {
        while (t < from.triangles.size() && from.triangles[t][0] < part.end_vertex) ++t;
        ends.push_back(t);
    }
    std::uint64_t triangles = 0, vertices = 0;
    for (const PlacedPart& place : scene.places) {
        triangles += ends[place.part] - (place.part == 0 ? 0 : ends[place.part - 1]);
        vertices += scene.parts[place.part].end_vertex - scene.parts[place.part].first_vertex;
    }
    if (triangles == 0) return fault(ErrorCode::kMalformed, "no node of the scene shows a triangle");
    if (triangles > max_triangles || vertices >= std::numeric_limits<std::uint32_t>::max())
        return fault(ErrorCode::kLimit, "the scene has more triangles, with its instances, than the limit");
    Mesh mesh;
    for (const Attribute& a : from.attributes)
        mesh.attributes.push_back({a.name, a.semantic, a.components, {}});
    const bool coloured = std::any_of(from.attributes.begin(), from.attributes.end(),
                                      [](const Attribute& a) { return a.semantic == Semantic::kColor; });
    Mesh white;
    if (coloured) {
        white = from;
        white.attributes = colours_of(scene);
    }
    Placer placer(coloured ? white : from, mesh);
    const std::vector<std::uint32_t> materials = materials_of(scene);
    for (const PlacedPart& place : scene.places) {
        const ScenePart& part = scene.parts[place.part];
        const auto base = std::uint32_t(mesh.positions.size());
        const bool mirrored = determinant(place.matrix) < 0;
        placer.place(part, place.matrix);
        for (t = place.part == 0 ? 0 : ends[place.part - 1]; t < ends[place.part]; ++t) {
            Triangle moved = from.triangles[t];
            for (std::uint32_t& corner : moved) corner += base - part.first_vertex;
            // A mirror turns triangles inside out (glTF 2.0, section 3.7.4).
            if (mirrored) std::swap(moved[1], moved[2]);
            mesh.triangles.push_back(moved);
            mesh.groups.push_back(materials[from.groups[t]]);
        }
    }
    if (std::all_of(mesh.groups.begin(), mesh.groups.end(),
                    [&](std::uint32_t group) { return group == mesh.groups.front(); }))
        mesh.groups.clear();
    return mesh;
}

PoseSets placed_poses(const Scene& scene) {
    PoseSets out;
    for (const PlacedPart& place : scene.places) {
        const ScenePart& part = scene.parts[place.part];
        const bool posed = !place.poses.empty();
        out.set_of.insert(out.set_of.end(), part.end_vertex - part.first_vertex,
                          posed ? std::uint32_t(out.sets.size()) : PoseSets::kNone);
        if (posed) out.sets.push_back(place.poses);
    }
    if (out.sets.empty()) out.set_of.clear();
    return out;
}

}  // namespace vsplit::bake
