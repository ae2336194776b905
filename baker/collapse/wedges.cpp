// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "wedges.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace vsplit::bake {
namespace {

Double3 to_double(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

/// World length of a unit of texture: the root of the ratio of the areas.
double texture_length(const Mesh& mesh, const Attribute& attribute) {
    double area = 0, texture_area = 0;
    for (const Triangle& t : mesh.triangles) {
        const Double3 a = to_double(mesh.positions[t[0]]);
        area += length(cross(to_double(mesh.positions[t[1]]) - a, to_double(mesh.positions[t[2]]) - a));
        const float* uv[3];
        for (std::size_t k = 0; k < 3; ++k) uv[k] = &attribute.values[2 * std::size_t{t[k]}];
        texture_area +=
            std::abs((double(uv[1][0]) - double(uv[0][0])) * (double(uv[2][1]) - double(uv[0][1])) -
                     (double(uv[2][0]) - double(uv[0][0])) * (double(uv[1][1]) - double(uv[0][1])));
    }
    const double length = texture_area > 0 ? std::sqrt(area / texture_area) : 0;
    return std::isfinite(length) ? length : 0;
}

/// The largest difference of any component.
double range_of(const Attribute& attribute) {
    double most = 0;
    for (std::size_t k = 0; k < attribute.components; ++k) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::size_t i = k; i < attribute.values.size(); i += attribute.components) {
            low = std::min(low, double(attribute.values[i]));
            high = std::max(high, double(attribute.values[i]));
        }
        most = std::max(most, high - low);
    }
    return most;
}

void normalise(float* v) {
    const double n =
        std::sqrt(double(v[0]) * double(v[0]) + double(v[1]) * double(v[1]) + double(v[2]) * double(v[2]));
    if (n > 0)
        for (std::size_t i = 0; i < 3; ++i) v[i] = float(double(v[i]) / n);
}

}  // namespace

WedgeValues::WedgeValues(const Mesh& mesh, const AttributeWeights& weights, const PoseSets& poses)
    : poser_(mesh, poses) {
    for (const Attribute& attribute : mesh.attributes) {
        double weight = 0;
        switch (attribute.semantic) {
            case Semantic::kNormal:
                weight = weights.normal;
                break;
            case Semantic::kTangent:
                weight = weights.tangent;
                break;
            case Semantic::kTexcoord:
                weight = weights.texcoord * texture_length(mesh, attribute);
                break;
            case Semantic::kColor:
                weight = weights.color;
                break;
            case Semantic::kJoints:
                break;  // Told by their weights.
            case Semantic::kJointWeights:
                weight = weights.joints;
                break;
            case Semantic::kMorphOffset:
                weight = weights.morph;
                break;
            case Semantic::kMorphNormal:
            case Semantic::kMorphTangent:
                weight = weights.normal;
                break;
            case Semantic::kOther: {
                const double range = range_of(attribute);
                weight = range > 0 ? weights.other / range : 0;
                break;
            }
        }
        columns_.push_back({attribute.semantic, stride_, attribute.components, weight});
        stride_ += attribute.components;
    }
    plain_ = stride_;
    stride_ += std::uint32_t(3 * poser_.count());
    values_.resize(std::size_t{stride_} * mesh.positions.size());
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        const std::size_t components = columns_[i].components;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            std::copy_n(mesh.attributes[i].values.begin() + std::ptrdiff_t(components * v), components,
                        values_.begin() + std::ptrdiff_t(stride_ * v + columns_[i].begin));
    }
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) repose(v, mesh.positions[v], of(v));
    originals_ = values_;
    places_ = mesh.positions;
    samples_.resize(mesh.positions.size());
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) samples_[v][0] = v;
    sample_counts_.assign(mesh.positions.size(), 1);
}

void WedgeValues::set_samples(std::uint32_t wedge, std::span<const std::uint32_t> samples) {
    sample_counts_[wedge] = std::uint8_t(std::min(samples.size(), kSamples));
    std::copy_n(samples.begin(), sample_counts_[wedge], samples_[wedge].begin());
}

void WedgeValues::mix(const Blend& blend, std::span<float> out) const {
    for (std::size_t k = 0; k < 3; ++k)
        if (blend.shares[k] == 1) {
            std::copy(blend.of[k].begin(), blend.of[k].end(), out.begin());
            return;
        }
    for (const Column& column : columns_) {
        if (column.semantic == Semantic::kJoints || column.semantic == Semantic::kJointWeights) continue;
        bool alike = true;
        for (std::size_t i = column.begin; i < column.begin + column.components; ++i) {
            const float a = blend.of[0][i], b = blend.of[1][i], c = blend.of[2][i];
            // What is equal stays so, bit by bit.
            const bool same = a == b && b == c;
            alike &= same;
            out[i] = same ? a
                          : float(blend.shares[0] * double(a) + blend.shares[1] * double(b) +
                                  blend.shares[2] * double(c));
        }
        if (alike) continue;
        if (column.semantic == Semantic::kNormal || column.semantic == Semantic::kTangent)
            normalise(&out[column.begin]);
        if (column.semantic == Semantic::kTangent) {
            const auto most =
                std::max_element(blend.shares.begin(), blend.shares.end()) - blend.shares.begin();
            out[column.begin + 3] = blend.of[std::size_t(most)][column.begin + 3];
        }
    }
    mix_joints(blend, out);
}

void WedgeValues::take_linear(std::span<const float> from, std::span<float> out) const {
    for (const Column& column : columns_) {
        if (column.semantic == Semantic::kJoints || column.semantic == Semantic::kJointWeights) continue;
        const bool is_tangent = column.semantic == Semantic::kTangent;
        const std::size_t end = column.begin + (is_tangent ? 3 : column.components);
        bool changes = false;
        for (std::size_t i = column.begin; i < end; ++i) {
            changes |= out[i] != from[i];
            out[i] = from[i];
        }
        if (changes && (column.semantic == Semantic::kNormal || is_tangent)) normalise(&out[column.begin]);
    }
}

void WedgeValues::mix_joints(const Blend& blend, std::span<float> out) const {
    // All sets together: the strongest joints stay, and their weights make one again.
    struct Influence {
        float joint;
        double weight;
    };
    std::size_t slots = 0;
    for (const Column& column : columns_) slots += column.semantic == Semantic::kJoints ? 4 : 0;
    if (slots == 0) return;
    std::vector<Influence> found;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t c = 0; c + 1 < columns_.size(); ++c) {
            if (columns_[c].semantic != Semantic::kJoints) continue;
            for (std::size_t i = 0; i < 4; ++i) {
                const float joint = blend.of[k][columns_[c].begin + i];
                const double weight = blend.shares[k] * double(blend.of[k][columns_[c + 1].begin + i]);
                if (!(weight > 0)) continue;
                const auto same = std::find_if(found.begin(), found.end(),
                                               [&](const Influence& f) { return f.joint == joint; });
                if (same == found.end())
                    found.push_back({joint, weight});
                else
                    same->weight += weight;
            }
        }
    std::stable_sort(found.begin(), found.end(),
                     [](const Influence& x, const Influence& y) { return x.weight > y.weight; });
    if (found.size() > slots) found.resize(slots);
    double sum = 0;
    for (const Influence& f : found) sum += f.weight;
    std::size_t next = 0;
    for (std::size_t c = 0; c + 1 < columns_.size(); ++c) {
        if (columns_[c].semantic != Semantic::kJoints) continue;
        for (std::size_t i = 0; i < 4; ++i, ++next) {
            out[columns_[c].begin + i] = next < found.size() ? found[next].joint : 0.0f;
            out[columns_[c + 1].begin + i] = next < found.size() ? float(found[next].weight / sum) : 0.0f;
        }
    }
}

namespace {

bool is_motion(Semantic semantic) {
    return semantic == Semantic::kJoints || semantic == Semantic::kJointWeights ||
           semantic == Semantic::kMorphOffset;
}

}  // namespace

bool WedgeValues::moves_alike(std::span<const float> a, std::span<const float> b) const {
    return std::all_of(columns_.begin(), columns_.end(), [&](const Column& column) {
        const auto begin = std::ptrdiff_t(column.begin), end = begin + std::ptrdiff_t(column.components);
        return !is_motion(column.semantic) ||
               std::equal(a.begin() + begin, a.begin() + end, b.begin() + begin);
    });
}

void WedgeValues::copy_motion(std::span<const float> from, std::span<float> to) const {
    for (const Column& column : columns_)
        if (is_motion(column.semantic))
            std::copy_n(from.begin() + std::ptrdiff_t(column.begin), column.components,
                        to.begin() + std::ptrdiff_t(column.begin));
}

double WedgeValues::apart2(std::span<const float> old, const Blend& blend, double extent,
                           double scale) const {
    double total = 0;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        const Column& column = columns_[c];
        if (!(column.weight > 0)) continue;
        double sum = 0;
        for (std::size_t i = column.begin; i < column.begin + column.components; ++i) {
            double there = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                if (column.semantic != Semantic::kJointWeights) {
                    there += blend.shares[k] * double(blend.of[k][i]);
                    continue;
                }
                // By joint, in whatever order the corner names them.
                const std::size_t joints = columns_[c - 1].begin;
                for (std::size_t j = 0; j < 4; ++j)
                    if (blend.of[k][joints + j] == old[joints + i - column.begin])
                        there += blend.shares[k] * double(blend.of[k][column.begin + j]);
            }
            sum += (double(old[i]) - there) * (double(old[i]) - there);
        }
        const bool is_length =
            column.semantic == Semantic::kTexcoord || column.semantic == Semantic::kMorphOffset;
        const double unit = column.weight * (is_length ? scale : extent);
        total += unit * unit * sum;
    }
    return total;
}

PointMesh points_of(const Mesh& mesh, std::span<const std::uint32_t> part_of) {
    const auto key = [&](std::uint32_t v) {
        // Adding 0 turns -0 into 0.
        const Float3& p = mesh.positions[v];
        return std::tuple(std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
                          std::bit_cast<std::uint32_t>(p.z + 0.0f), part_of.empty() ? 0u : part_of[v]);
    };
    std::vector<std::uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto ka = key(a), kb = key(b);
        return ka != kb ? ka < kb : a < b;
    });
    // Points are numbered by the first of their vertices.
    std::vector<std::uint32_t> first(mesh.positions.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    std::vector<std::uint32_t> point(mesh.positions.size());
    PointMesh out;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (first[v] == v) {
            point[v] = std::uint32_t(out.mesh.positions.size());
            out.mesh.positions.push_back(mesh.positions[v]);
            if (!part_of.empty()) out.part_of.push_back(part_of[v]);
            if (!mesh.weights.empty()) out.mesh.weights.push_back(mesh.weights[v]);
        } else {
            point[v] = point[first[v]];
            if (!mesh.weights.empty())
                out.mesh.weights[point[v]] = std::max(out.mesh.weights[point[v]], mesh.weights[v]);
        }
    }
    std::vector<bool> used(mesh.positions.size(), false);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& c = mesh.triangles[t];
        const Triangle p{point[c[0]], point[c[1]], point[c[2]]};
        if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) {
            ++out.degenerate;
            continue;
        }
        out.mesh.triangles.push_back(p);
        out.corners.push_back(c);
        if (!mesh.groups.empty()) out.groups.push_back(mesh.groups[t]);
        for (const std::uint32_t v : c) used[v] = true;
    }
    out.unused = std::uint64_t(std::count(used.begin(), used.end(), false));
    return out;
}

void WedgeStar::gather(const StarMesh& mesh, const EdgeStar& star, std::uint32_t stays) {
    parent = stays;
    const std::uint32_t child = star.u + star.v - parent;
    pairs.clear();
    moved.clear();
    transferred.clear();
    const auto wedges_of = [&](std::uint32_t v, std::vector<std::uint32_t>& out) {
        for (const std::uint32_t t : mesh.star(v)) {
            const Triangle& c = mesh.triangle(t);
            const std::uint32_t wedge = mesh.corners(t)[c[0] == v ? 0 : c[1] == v ? 1 : 2];
            if (std::find(out.begin(), out.end(), wedge) == out.end()) out.push_back(wedge);
        }
    };
    wedges_of(parent, moved);
    wedges_of(child, transferred);
    for (const std::uint32_t t : star.opposite_triangles) {
        const Triangle& c = mesh.triangle(t);
        WedgePair pair{};
        for (std::size_t k = 0; k < 3; ++k) {
            if (c[k] == child) pair.child = mesh.corners(t)[k];
            if (c[k] == parent) pair.parent = mesh.corners(t)[k];
        }
        const auto same = std::find_if(pairs.begin(), pairs.end(), [&](const WedgePair& p) {
            return p.child == pair.child && p.parent == pair.parent;
        });
        if (same == pairs.end()) pairs.push_back(pair);
    }
    // Two partners are none.
    std::vector<std::uint32_t> torn;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (pairs[i].child == pairs[j].child) torn.push_back(pairs[i].child);
    const auto is_torn = [&](std::uint32_t w) {
        return std::find(torn.begin(), torn.end(), w) != torn.end();
    };
    std::erase_if(pairs, [&](const WedgePair& p) { return is_torn(p.child); });
    std::erase_if(transferred, [&](std::uint32_t w) {
        return std::any_of(pairs.begin(), pairs.end(), [&](const WedgePair& p) { return p.child == w; });
    });
}

}  // namespace vsplit::bake
