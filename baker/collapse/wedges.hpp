// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Meshes with attributes: points, which collapse, and the renderer's vertices that share a point (wedges, as
// Hoppe 1996 calls the corners of equal attributes around a vertex).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "edge_star.hpp"
#include "poser.hpp"
#include "star_mesh.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/mesh.hpp"

namespace vsplit::bake {

/// What the wedges carry: all attributes of one after each other.
class WedgeValues {
  public:
    WedgeValues(const Mesh& mesh, const AttributeWeights& weights, const PoseSets& poses);

    /// All values of a wedge: those of attributes, and then where each pose puts it.
    std::uint32_t stride() const { return stride_; }
    /// Those of attributes.
    std::uint32_t plain() const { return plain_; }
    /// Poses of a wedge; their places begin at plain(), three values each.
    std::size_t poses_of(std::uint32_t wedge) const { return poser_.count_of(wedge); }
    std::size_t most_poses() const { return poser_.count(); }
    /// Makes a row's posed places anew, for a wedge whose place or attributes are new.
    void repose(std::uint32_t wedge, const Float3& place, std::span<float> row) const {
        if (stride_ > plain_) poser_.pose(wedge, place, row.first(plain_), row.subspan(plain_));
    }
    static Double3 posed(std::span<const float> row, std::size_t begin) {
        return {double(row[begin]), double(row[begin + 1]), double(row[begin + 2])};
    }
    std::span<float> of(std::uint32_t wedge) {
        return {values_.data() + std::size_t{stride_} * wedge, stride_};
    }
    std::span<const float> of(std::uint32_t wedge) const {
        return {values_.data() + std::size_t{stride_} * wedge, stride_};
    }
    /// Three values and their shares, which sum to 1.
    struct Blend {
        std::array<std::span<const float>, 3> of;
        std::array<double, 3> shares;
    };
    /// Into `out`: unit vectors stay so; of joints, the strongest of all stay. A share of 1 copies the bits.
    void mix(const Blend& blend, std::span<float> out) const;
    /// Copies what is linear, that is all but joints, their weights and handedness; unit vectors stay so.
    void take_linear(std::span<const float> from, std::span<float> out) const;
    /// What moves a vertex: joints, their weights, morph offsets.
    bool moves_alike(std::span<const float> a, std::span<const float> b) const;
    void copy_motion(std::span<const float> from, std::span<float> to) const;
    /// How far `old` is from a blend, as a squared length: see AttributeWeights. `extent` is the size of the
    /// triangles around, working units, of which one object unit makes `scale`.
    double apart2(std::span<const float> old, const Blend& blend, double extent, double scale) const;

    /// An attribute's begin within a wedge's values.
    struct Column {
        Semantic semantic;
        std::uint32_t begin, components;
        double weight;  ///< Times the difference: a length (texture coordinates, offsets), or a share of the
                        ///< extent.
    };
    const std::vector<Column>& columns() const { return columns_; }

    /// Vertices of the input, for which a wedge now stands: at most kSamples, those that it shows worst.
    static constexpr std::size_t kSamples = 6;
    std::span<const std::uint32_t> samples(std::uint32_t wedge) const {
        return {samples_[wedge].data(), sample_counts_[wedge]};
    }
    void set_samples(std::uint32_t wedge, std::span<const std::uint32_t> samples);
    /// What the input has there.
    const Float3& sample_place(std::uint32_t sample) const { return places_[sample]; }
    std::span<const float> sample_values(std::uint32_t sample) const {
        return {originals_.data() + std::size_t{stride_} * sample, stride_};
    }

  private:
    void mix_joints(const Blend& blend, std::span<float> out) const;

    std::vector<Column> columns_;
    std::uint32_t stride_ = 0, plain_ = 0;
    Poser poser_;
    std::vector<float> values_, originals_;
    std::vector<Float3> places_;
    std::vector<std::array<std::uint32_t, kSamples>> samples_;
    std::vector<std::uint8_t> sample_counts_;
};

/// A mesh of points, and the wedges at its corners.
struct PointMesh {
    Mesh mesh;                           ///< Positions and weights of points; triangles over them.
    std::vector<Triangle> corners;       ///< Parallel to its triangles: the wedges, vertices of the input.
    std::vector<std::uint32_t> groups;   ///< Parallel to its triangles; empty if the input has none.
    std::vector<std::uint32_t> part_of;  ///< Of each point; empty if the input has no parts.
    std::uint64_t degenerate = 0;        ///< Triangles of the input with two corners at one point: left out.
    std::uint64_t unused = 0;            ///< Vertices of the input that no triangle left uses.
};

/// Wedges with bitwise equal positions (0 and -0 being equal) and the same part share a point, whose weight
/// is the largest of theirs. `part_of`: empty, or one per vertex.
PointMesh points_of(const Mesh& mesh, std::span<const std::uint32_t> part_of);

/// The wedges of an edge that is about to collapse.
struct WedgeStar {
    std::vector<WedgePair> pairs;            ///< Those that become one.
    std::vector<std::uint32_t> moved;        ///< All wedges of the vertex that stays.
    std::vector<std::uint32_t> transferred;  ///< Wedges of the one that goes without a partner: they go over
                                             ///< as they are.
    std::uint32_t parent = 0;                ///< Which end stays.

    /// Partners are named by the edge's own triangles. A wedge that goes and has two (a seam ends there) is
    /// transferred; a wedge that stays may have several.
    void gather(const StarMesh& mesh, const EdgeStar& star, std::uint32_t parent);
};

}  // namespace vsplit::bake
