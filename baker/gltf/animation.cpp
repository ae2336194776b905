// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "animation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vsplit::bake {
namespace {

/// Keys of one channel that are read; more are no animation that a pose could be found in.
constexpr std::uint64_t kMostValues = std::uint64_t{1} << 24;

Error fault(const std::string& name, const char* what) {
    return {ErrorCode::kMalformed, name + ": " + what, Error::kNowhere, 0};
}

std::optional<std::size_t> index_in(const OrderedJson& object, const char* key, std::size_t below) {
    const OrderedJson* value = member(object, key);
    if (value == nullptr || !value->is_number_unsigned()) return std::nullopt;
    const auto n = value->get<std::uint64_t>();
    return n < below ? std::optional(std::size_t(n)) : std::nullopt;
}

std::string text_of(const OrderedJson& object, const char* key, const char* otherwise) {
    const OrderedJson* value = member(object, key);
    return value != nullptr && value->is_string() ? value->get<std::string>() : otherwise;
}

std::vector<double> numbers(const OrderedJson& object, const char* key) {
    std::vector<double> out;
    const OrderedJson* values = member(object, key);
    if (values == nullptr || !values->is_array()) return out;
    for (const OrderedJson& value : *values) {
        const double number = value.is_number() ? value.get<double>() : 0;
        out.push_back(std::isfinite(number) ? number : 0);
    }
    return out;
}

void make_unit(std::vector<double>& q) {
    double sum = 0;
    for (const double x : q) sum += x * x;
    if (sum > 0 && std::isfinite(sum))
        for (double& x : q) x /= std::sqrt(sum);
    else
        q = {0, 0, 0, 1};
}

/// Spherical interpolation by the shorter way (glTF 2.0, appendix C.5).
std::vector<double> slerp(const std::vector<double>& a, const std::vector<double>& b, double t) {
    double d = 0;
    for (std::size_t i = 0; i < 4; ++i) d += a[i] * b[i];
    const double sign = d < 0 ? -1 : 1;
    const double angle = std::acos(std::min(std::abs(d), 1.0));
    double left = 1 - t, right = t;
    if (const double s = std::sin(angle); s > 1e-6) {
        left = std::sin(left * angle) / s;
        right = std::sin(right * angle) / s;
    }
    std::vector<double> out(4);
    for (std::size_t i = 0; i < 4; ++i) out[i] = left * a[i] + sign * right * b[i];
    make_unit(out);
    return out;
}

}  // namespace

Result<std::optional<Channel>> Channel::open(Document& document, const OrderedJson& animation,
                                             const OrderedJson& channel, const std::string& name) {
    const auto nothing = [] { return std::optional<Channel>(); };
    const OrderedJson* target = member(channel, "target");
    if (target == nullptr) return fault(name, "has no target");
    const std::string path = text_of(*target, "path", "");
    Channel out;
    if (path == "translation")
        out.path = Path::kTranslation;
    else if (path == "rotation")
        out.path = Path::kRotation;
    else if (path == "scale")
        out.path = Path::kScale;
    else if (path == "weights")
        out.path = Path::kWeights;
    else
        return nothing();
    if (!target->contains("node")) return nothing();
    const auto node = index_in(*target, "node", document.model.nodes.size());
    const OrderedJson* samplers = member(animation, "samplers");
    if (!node || samplers == nullptr || !samplers->is_array()) return fault(name, "names what is not there");
    out.node = *node;
    const auto number = index_in(channel, "sampler", samplers->size());
    if (!number) return fault(name, "has no sampler");
    const OrderedJson& sampler = (*samplers)[*number];
    const auto input = index_in(sampler, "input", document.model.accessors.size());
    const auto output = index_in(sampler, "output", document.model.accessors.size());
    if (!input || !output) return fault(name, "has no keys");
    const std::string between = text_of(sampler, "interpolation", "LINEAR");
    out.between_ = between == "STEP"          ? Between::kStep
                   : between == "CUBICSPLINE" ? Between::kCubic
                                              : Between::kLinear;
    auto times = AccessorReader::open(document, int(*input), name + ".input");
    if (!times.ok()) return times.error();
    auto values = AccessorReader::open(document, int(*output), name + ".output");
    if (!values.ok()) return values.error();
    const std::uint64_t keys = times->count();
    if (times->type() != TINYGLTF_TYPE_SCALAR || keys == 0) return fault(name, "has no times");
    const std::uint64_t per_key = out.between_ == Between::kCubic ? 3 : 1;
    const auto components = std::uint64_t(values->components());
    if (keys > kMostValues || values->count() > kMostValues / components)
        return fault(name, "has more keys than are read");
    // Weights are as many scalars a key as there are targets.
    const bool scalars = out.path == Path::kWeights;
    const std::uint64_t wanted = scalars ? 1 : out.path == Path::kRotation ? 4 : 3;
    if (components != wanted || values->count() % (keys * per_key) != 0 || values->count() == 0 ||
        (!scalars && values->count() != keys * per_key))
        return fault(name, "has values that do not fit its keys");
    out.width_ = std::size_t(scalars ? values->count() / (keys * per_key) : components);
    for (std::uint64_t k = 0; k < keys; ++k) {
        float time = 0;
        times->read(k, {&time, 1});
        if (!std::isfinite(time) || (k > 0 && double(time) < out.times_.back()))
            return fault(name, "has times that do not ascend");
        out.times_.push_back(double(time));
    }
    out.values_.resize(values->count() * components);
    for (std::uint64_t i = 0; i < values->count(); ++i)
        values->read(i, std::span(out.values_).subspan(std::size_t(i * components), std::size_t(components)));
    for (float& value : out.values_)
        if (!std::isfinite(value)) value = 0;
    return std::optional(std::move(out));
}

double Channel::value(std::size_t element, std::size_t component) const {
    return double(values_[element * width_ + component]);
}

std::vector<double> Channel::at(double time) const {
    const bool cubic = between_ == Between::kCubic;
    const auto key = [&](std::size_t k) {
        std::vector<double> out(width_);
        for (std::size_t i = 0; i < width_; ++i) out[i] = value(cubic ? 3 * k + 1 : k, i);
        if (path == Path::kRotation) make_unit(out);
        return out;
    };
    const auto after = std::upper_bound(times_.begin(), times_.end(), time);
    if (after == times_.begin()) return key(0);
    const auto k = std::size_t(after - times_.begin()) - 1;
    if (after == times_.end() || between_ == Between::kStep) return key(k);
    const double span = times_[k + 1] - times_[k];
    const double t = span > 0 ? (time - times_[k]) / span : 0;
    if (!cubic) {
        const std::vector<double> a = key(k), b = key(k + 1);
        if (path == Path::kRotation) return slerp(a, b, t);
        std::vector<double> out(width_);
        for (std::size_t i = 0; i < width_; ++i) out[i] = (1 - t) * a[i] + t * b[i];
        return out;
    }
    // Hermite, with tangents per second: each key has its in-tangent, value and out-tangent.
    const double t2 = t * t, t3 = t2 * t;
    std::vector<double> out(width_);
    for (std::size_t i = 0; i < width_; ++i)
        out[i] = (2 * t3 - 3 * t2 + 1) * value(3 * k + 1, i) +
                 span * (t3 - 2 * t2 + t) * value(3 * k + 2, i) + (3 * t2 - 2 * t3) * value(3 * k + 4, i) +
                 span * (t3 - t2) * value(3 * k + 3, i);
    if (path == Path::kRotation) make_unit(out);
    return out;
}

std::vector<Animation> read_animations(Document& document, const OrderedJson& root, std::size_t& unread) {
    std::vector<Animation> out;
    const OrderedJson* animations = member(root, "animations");
    if (animations == nullptr || !animations->is_array()) return out;
    for (std::size_t a = 0; a < animations->size(); ++a) {
        const OrderedJson* channels = member((*animations)[a], "channels");
        if (channels == nullptr || !channels->is_array()) continue;
        Animation animation;
        for (std::size_t c = 0; c < channels->size(); ++c) {
            auto channel = Channel::open(document, (*animations)[a], (*channels)[c],
                                         object_name("animations", a) + "." + object_name("channels", c));
            if (!channel.ok())
                ++unread;
            else if (*channel)
                animation.channels.push_back(std::move(**channel));
        }
        if (animation.channels.empty()) continue;
        animation.first = animation.channels[0].first();
        animation.last = animation.channels[0].last();
        for (const Channel& channel : animation.channels) {
            animation.first = std::min(animation.first, channel.first());
            animation.last = std::max(animation.last, channel.last());
        }
        out.push_back(std::move(animation));
    }
    return out;
}

NodeStates::NodeStates(const Document& document, const OrderedJson& root) {
    const auto& nodes = document.model.nodes;
    parents_.assign(nodes.size(), kNone);
    for (std::size_t n = 0; n < nodes.size(); ++n)
        for (const int child : nodes[n].children) parents_[std::size_t(child)] = n;
    for (std::size_t n = 0; n < nodes.size(); ++n)
        if (parents_[n] == kNone) order_.push_back(n);
    for (std::size_t i = 0; i < order_.size(); ++i)
        for (const int child : nodes[order_[i]].children) order_.push_back(std::size_t(child));
    rest_ = nodes;
    for (tinygltf::Node& node : rest_) node.children.clear();
    rest_weights_.resize(nodes.size());
    const OrderedJson* described = member(root, "nodes");
    const OrderedJson* meshes = member(root, "meshes");
    for (std::size_t n = 0; n < nodes.size() && described != nullptr && n < described->size(); ++n) {
        rest_weights_[n] = numbers((*described)[n], "weights");
        const auto mesh = std::size_t(std::max(nodes[n].mesh, 0));
        if (rest_weights_[n].empty() && nodes[n].mesh >= 0 && meshes != nullptr && mesh < meshes->size())
            rest_weights_[n] = numbers((*meshes)[mesh], "weights");
    }
    reset();
}

void NodeStates::set(const Animation& animation, double time) {
    reset();
    for (const Channel& channel : animation.channels) {
        std::vector<double> value = channel.at(time);
        tinygltf::Node& node = nodes_[channel.node];
        switch (channel.path) {
            case Channel::Path::kTranslation:
                node.translation = std::move(value);
                break;
            case Channel::Path::kRotation:
                node.rotation = std::move(value);
                break;
            case Channel::Path::kScale:
                node.scale = std::move(value);
                break;
            case Channel::Path::kWeights:
                weights_[channel.node] = std::move(value);
                continue;
        }
        node.matrix.clear();
    }
}

std::vector<Matrix> NodeStates::world() const {
    std::vector<Matrix> world(nodes_.size(), kIdentity);
    for (const std::size_t n : order_) {
        const Matrix local = local_matrix(nodes_[n]);
        world[n] = parents_[n] == kNone ? local : product(world[parents_[n]], local);
    }
    return world;
}

}  // namespace vsplit::bake
