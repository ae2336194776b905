// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "poser.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace vsplit::bake {

Poser::Poser(const Mesh& mesh, const PoseSets& sets) {
    if (sets.empty() || sets.set_of.size() != mesh.positions.size()) return;
    sets_ = sets.sets;
    set_of_ = sets.set_of;
    for (const auto& set : sets_) count_ = std::max(count_, set.size());
    std::uint32_t column = 0;
    for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
        const Attribute& attribute = mesh.attributes[a];
        if (attribute.semantic == Semantic::kJoints && a + 1 < mesh.attributes.size() &&
            mesh.attributes[a + 1].semantic == Semantic::kJointWeights)
            influences_.push_back({column, column + attribute.components});
        if (attribute.semantic == Semantic::kMorphOffset) {
            std::size_t target = 0;
            std::from_chars(attribute.name.data(), attribute.name.data() + attribute.name.size(), target);
            offsets_.push_back({target, column});
        }
        column += attribute.components;
    }
}

void Poser::pose(std::uint32_t vertex, const Float3& place, std::span<const float> row,
                 std::span<float> out) const {
    const std::uint32_t set = set_of(vertex);
    const std::size_t own = set == PoseSets::kNone ? 0 : sets_[set].size();
    for (std::size_t p = 0; p < count_; ++p) {
        std::array<double, 3> at{double(place.x), double(place.y), double(place.z)};
        if (p < own) {
            const Pose& pose = sets_[set][p];
            for (const auto& [target, column] : offsets_)
                if (target < pose.morphs.size() && pose.morphs[target] != 0)
                    for (std::size_t i = 0; i < 3; ++i)
                        at[i] += pose.morphs[target] * double(row[column + i]);
            std::array<double, 3> moved{};
            double sum = 0;
            if (!pose.joints.empty())
                for (const Influences& influence : influences_)
                    for (std::size_t j = 0; j < 4; ++j) {
                        const double weight = double(row[influence.weights + j]);
                        const auto joint = std::size_t(std::max(row[influence.joints + j], 0.0f));
                        if (!(weight > 0) || joint >= pose.joints.size()) continue;
                        const auto& m = pose.joints[joint];
                        for (std::size_t r = 0; r < 3; ++r)
                            moved[r] += weight * (m[4 * r] * at[0] + m[4 * r + 1] * at[1] +
                                                  m[4 * r + 2] * at[2] + m[4 * r + 3]);
                        sum += weight;
                    }
            if (sum > 0)
                for (std::size_t r = 0; r < 3; ++r) at[r] = moved[r] / sum;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const auto value = float(at[i]);
            out[3 * p + i] = std::isfinite(value) ? value : (i == 0 ? place.x : i == 1 ? place.y : place.z);
        }
    }
}

}  // namespace vsplit::bake
