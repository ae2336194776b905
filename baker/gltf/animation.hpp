// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The animations of a glTF document, and what nodes are at a moment of one (glTF 2.0, section 3.11).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "accessor.hpp"
#include "document.hpp"
#include "scene_document.hpp"
#include "transforms.hpp"

namespace vsplit::bake {

/// A channel's keys, checked: times ascend, and every time has its values.
class Channel {
  public:
    enum class Path : std::uint8_t { kTranslation, kRotation, kScale, kWeights };
    std::size_t node = 0;
    Path path = Path::kTranslation;

    /// Nothing for a channel without a node or with a path that is none of the four; an error for one that
    /// cannot be read.
    static Result<std::optional<Channel>> open(Document& document, const OrderedJson& animation,
                                               const OrderedJson& channel, const std::string& name);

    double first() const { return times_.front(); }
    double last() const { return times_.back(); }
    /// The value at a time: 3, 4 (a unit quaternion) or as many as there are targets.
    std::vector<double> at(double time) const;

  private:
    enum class Between : std::uint8_t { kLinear, kStep, kCubic };
    double value(std::size_t element, std::size_t component) const;

    std::vector<double> times_;
    std::vector<float> values_;
    std::size_t width_ = 0;
    Between between_ = Between::kLinear;
};

struct Animation {
    std::vector<Channel> channels;
    double first = 0, last = 0;
};

/// All of them; `unread` counts the channels that cannot be read.
std::vector<Animation> read_animations(Document& document, const OrderedJson& root, std::size_t& unread);

/// Translation, rotation, scale (or matrix) and morph weights of all nodes.
class NodeStates {
  public:
    explicit NodeStates(const Document& document, const OrderedJson& root);
    /// All nodes as the document has them, but for what the animation says of a time.
    void set(const Animation& animation, double time);
    void reset() {
        nodes_ = rest_;
        weights_ = rest_weights_;
    }
    /// World matrices of all nodes. The nodes are a forest.
    std::vector<Matrix> world() const;
    /// Empty if neither node nor mesh has any.
    const std::vector<double>& weights(std::size_t node) const { return weights_[node]; }
    /// Each node's parent, or kNone.
    static constexpr std::size_t kNone = ~std::size_t{0};
    const std::vector<std::size_t>& parents() const { return parents_; }

  private:
    std::vector<tinygltf::Node> rest_, nodes_;  // without children
    std::vector<std::vector<double>> rest_weights_, weights_;
    std::vector<std::size_t> order_, parents_;
};

}  // namespace vsplit::bake
