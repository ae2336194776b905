// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "scene_poses.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "animation.hpp"

namespace vsplit::bake {
namespace {

/// Limits of hostile documents: nodes evaluated, and matrices kept.
constexpr std::uint64_t kMostNodes = std::uint64_t{1} << 26, kMostMatrices = std::uint64_t{1} << 21;

/// A moment of an animation.
struct Moment {
    std::size_t animation;
    double time;
};

/// The first three rows, of which nothing is beyond numbers.
std::array<double, 12> rows_of(const Matrix& m) {
    std::array<double, 12> out;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 4; ++c) out[4 * r + c] = std::isfinite(m[4 * c + r]) ? m[4 * c + r] : 0;
    return out;
}

/// The inverse of an affine matrix; nothing if it flattens space.
std::optional<Matrix> inverse(const Matrix& m) {
    const double d = determinant(m);
    if (!(std::abs(d) > 1e-30) || !std::isfinite(d)) return std::nullopt;
    Matrix out = kIdentity;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t r = 0; r < 3; ++r) {
            const std::size_t c1 = (c + 1) % 3, c2 = (c + 2) % 3, r1 = (r + 1) % 3, r2 = (r + 2) % 3;
            // Row c of the inverse: cofactors of column c.
            out[4 * r + c] = (m[4 * c1 + r1] * m[4 * c2 + r2] - m[4 * c1 + r2] * m[4 * c2 + r1]) / d;
        }
    for (std::size_t r = 0; r < 3; ++r)
        out[12 + r] = -(out[r] * m[12] + out[4 + r] * m[13] + out[8 + r] * m[14]);
    return out;
}

Matrix scaled(double factor) {
    return {factor, 0, 0, 0, 0, factor, 0, 0, 0, 0, factor, 0, 0, 0, 0, 1};
}

std::vector<Matrix> inverse_bind(Document& document, const tinygltf::Skin& skin) {
    std::vector<Matrix> out(skin.joints.size(), kIdentity);
    if (skin.inverseBindMatrices < 0) return out;
    auto reader = AccessorReader::open(document, skin.inverseBindMatrices, "inverseBindMatrices");
    if (!reader.ok() || reader->type() != TINYGLTF_TYPE_MAT4) return out;
    for (std::size_t j = 0; j < out.size() && j < reader->count(); ++j) {
        float values[16];
        reader->read(j, values);
        std::copy(std::begin(values), std::end(values), out[j].begin());
    }
    return out;
}

class Sampler {
  public:
    Sampler(Document& document, const OrderedJson& root, std::size_t count)
        : document_(document), states_(document, root), count_(count) {
        animations_ = read_animations(document, root, unread);
    }
    std::size_t unread = 0;

    /// The moments that a place is looked at.
    std::vector<Moment> moments(const Instance& instance) const {
        const auto& nodes = document_.model.nodes;
        std::vector<std::uint8_t> moves(nodes.size(), 0);  // joints and what is above them
        if (const int skin = nodes[instance.node].skin; skin >= 0)
            for (const int joint : document_.model.skins[std::size_t(skin)].joints)
                for (auto n = std::size_t(joint); n != NodeStates::kNone && moves[n] == 0;
                     n = states_.parents()[n])
                    moves[n] = 1;
        std::vector<std::size_t> own;
        double total = 0;
        for (std::size_t a = 0; a < animations_.size(); ++a)
            if (std::any_of(animations_[a].channels.begin(), animations_[a].channels.end(),
                            [&](const Channel& channel) {
                                return channel.path == Channel::Path::kWeights ? channel.node == instance.node
                                                                               : moves[channel.node] != 0;
                            })) {
                own.push_back(a);
                total += length(a);
            }
        std::vector<Moment> out;
        for (std::size_t i = 0; i < count_ && !own.empty(); ++i) {
            double at = (double(i) + 0.5) / double(count_) * total;
            std::size_t a = 0;
            while (a + 1 < own.size() && at >= length(own[a])) at -= length(own[a++]);
            out.push_back({own[a], std::min(animations_[own[a]].first + at, animations_[own[a]].last)});
        }
        return out;
    }

    /// Poses of a place from the mesh's coordinates as the file has them, to the world (skinned) or to the
    /// mesh again (not skinned).
    std::vector<Pose> poses(const Instance& instance) {
        const tinygltf::Node& node = document_.model.nodes[instance.node];
        std::vector<Matrix> bind;
        if (node.skin >= 0) bind = inverse_bind(document_, document_.model.skins[std::size_t(node.skin)]);
        std::vector<Moment> all = moments(instance);
        std::vector<Pose> out;
        const auto take = [&] {
            Pose pose;
            pose.morphs = states_.weights(instance.node);
            if (node.skin >= 0) {
                const std::vector<Matrix> world = states_.world();
                const auto& joints = document_.model.skins[std::size_t(node.skin)].joints;
                for (std::size_t j = 0; j < joints.size(); ++j)
                    pose.joints.push_back(rows_of(product(world[std::size_t(joints[j])], bind[j])));
            }
            out.push_back(std::move(pose));
        };
        for (const Moment& moment : all) {
            states_.set(animations_[moment.animation], moment.time);
            take();
        }
        states_.reset();
        const std::vector<double>& weights = states_.weights(instance.node);
        if (all.empty() &&
            std::any_of(weights.begin(), weights.end(), [](double weight) { return weight != 0; }))
            take();
        return out;
    }

    bool any() const { return !animations_.empty(); }

  private:
    /// A single key counts as a short while.
    double length(std::size_t a) const { return std::max(animations_[a].last - animations_[a].first, 1e-3); }

    Document& document_;
    std::vector<Animation> animations_;
    NodeStates states_;
    std::size_t count_;
};

/// The pose with other coordinates on both sides: `to` after it, `from` before. Both affine.
Pose between(const Pose& pose, const Matrix& to, const Matrix& from) {
    Pose out;
    out.morphs = pose.morphs;
    for (const auto& rows : pose.joints) {
        Matrix m = kIdentity;
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 4; ++c) m[4 * c + r] = rows[4 * r + c];
        out.joints.push_back(rows_of(product(product(to, m), from)));
    }
    return out;
}

}  // namespace

void sample_poses(Document& document, const OrderedJson& root, std::span<const Instance> instances,
                  const SceneUse& use, std::size_t count, Scene& scene) {
    Sampler sampler(document, root, count);
    if (sampler.unread > 0)
        scene.notes.push_back(std::to_string(sampler.unread) +
                              " animation channels cannot be read; poses are sampled without them");
    std::vector<std::vector<Pose>> of_part(scene.parts.size());
    std::uint64_t nodes = 0, matrices = 0;
    std::size_t place = 0;
    for (const Instance& instance : instances) {
        std::size_t part = 0;
        while (part < scene.parts.size() && scene.parts[part].mesh != instance.mesh) ++part;
        if (part == scene.parts.size()) continue;
        PlacedPart& placed = scene.places[place++];
        const int skin = document.model.nodes[instance.node].skin;
        nodes += document.model.nodes.size() * (count + 1);
        if (skin >= 0) matrices += 2 * document.model.skins[std::size_t(skin)].joints.size() * count;
        if (nodes > kMostNodes || matrices > kMostMatrices) {
            scene.notes.push_back(
                "too many nodes or joints to sample poses of all; the rest is measured in its "
                "bind pose");
            break;
        }
        const std::vector<Pose> poses = sampler.poses(instance);
        if (poses.empty()) continue;
        const double scale = use.mesh_scale[instance.mesh];
        const int exponent = scene.parts[part].exponent;
        const auto back = inverse(instance.matrix);
        for (const Pose& pose : poses) {
            // Mesh coordinates are the file's times 2^exponent, and that over `scale` is the world's unit.
            if (skin < 0 || (scale > 0 && std::isfinite(scale)))
                of_part[part].push_back(between(pose,
                                                scaled(std::ldexp(1 / (scale > 0 ? scale : 1), exponent)),
                                                scaled(std::ldexp(1.0, -exponent))));
            if (skin < 0 || back) placed.poses.push_back(between(pose, kIdentity, back.value_or(kIdentity)));
        }
    }
    scene.poses.set_of.assign(scene.mesh.positions.size(), PoseSets::kNone);
    for (std::size_t part = 0; part < of_part.size(); ++part) {
        if (of_part[part].empty()) continue;
        std::fill(scene.poses.set_of.begin() + std::ptrdiff_t(scene.parts[part].first_vertex),
                  scene.poses.set_of.begin() + std::ptrdiff_t(scene.parts[part].end_vertex),
                  std::uint32_t(scene.poses.sets.size()));
        scene.poses.sets.push_back(std::move(of_part[part]));
    }
    if (scene.poses.sets.empty()) scene.poses = {};
}

}  // namespace vsplit::bake
