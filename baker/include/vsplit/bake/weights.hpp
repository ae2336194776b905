// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What matters, said by regions: marks on a mesh, the weights that they mean, and the weights that keep what
// a person asks for. The automatic rule is that of Research on Optimization Technology of Three Dimensional
// Model, section IV.B.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vsplit/bake/collapse.hpp"
#include "vsplit/bake/progress.hpp"
#include "vsplit/mesh.hpp"
#include "vsplit/progressive_mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

/// The smallest, median and largest error E(u) + E(v) of the edges of the mesh as it is, by cost `paper`, in
/// the object's units. Zeros for a mesh without an edge that may collapse. `mesh` must be sound.
struct EdgeErrors {
    double smallest = 0, median = 0, largest = 0;
};
EdgeErrors edge_errors(const Mesh& mesh);

/// The paper's automatic settings: the initial weight is the mean of the smallest and the largest error, the
/// mark weight the mean of that and the largest. Both are errors, lengths. docs/studio.md tells what that
/// leaves open, and how factor() reads it.
struct AutomaticWeights {
    EdgeErrors errors;
    double initial = 0, mark = 0;  ///< In the object's units, as the errors are.
    /// The mark's weight where 1 is what the rest weighs, as Mesh::weights has it: it makes of a median error
    /// the mark weight. From 1 to 1e6.
    double factor() const;
};
AutomaticWeights automatic_weights(const EdgeErrors& errors);

/// One of the things that matter.
struct Region {
    std::string name;                 ///< Without blanks or '='; different for each.
    std::optional<double> weight;     ///< >= 0, may be infinite; nothing: the automatic one.
    std::uint32_t colour = 0xE6550D;  ///< 0xRRGGBB.
    friend bool operator==(const Region&, const Region&) = default;
};

/// Which region each vertex belongs to, and how much.
struct Marks {
    static constexpr std::size_t kMaxRegions = 255;

    std::vector<Region> regions;       ///< Number r below is regions[r - 1].
    std::vector<std::uint8_t> region;  ///< One per vertex; 0: none.
    std::vector<float> strength;       ///< One per vertex, 0 to 1: the weight is raised to this power.
    friend bool operator==(const Marks&, const Marks&) = default;
};

/// Nothing is marked, no region yet.
Marks no_marks(std::size_t vertices);

/// The text of marks (docs/cli.md): "region NAME WEIGHT|auto [#RRGGBB]" lines, then a line a vertex: the
/// region's number, and a strength if it is not 1. Hostile bytes are safe; errors carry the line.
Result<Marks> parse_marks(std::span<const std::byte> bytes, std::size_t count);
std::vector<std::byte> encode_marks(const Marks& marks);
/// One weight a line, as parse_weights reads them.
std::vector<std::byte> encode_weights(std::span<const float> weights);

/// Weights as Mesh::weights has them; `automatic` is the factor for regions without a weight of their own.
std::vector<float> weights_of(const Marks& marks, double automatic);

/// Marks as a file lists its vertices, for a mesh that was welded and renumbered on reading (MeshFile's
/// `vertex_of`, which may be empty). Of vertices that became one, the stronger mark counts.
Marks marks_of_mesh(const Marks& file_marks, std::span<const std::uint32_t> vertex_of, std::size_t vertices);
/// The way back, for `file_vertices` of a file.
Marks marks_of_file(const Marks& marks, std::span<const std::uint32_t> vertex_of, std::size_t file_vertices);

/// A number between 0 and 1 from "0.4" or "40%".
std::optional<double> parse_share(std::string_view text);

/// "Keep `share` of the region's vertices where the model has `ratio` of its triangles."
struct Keep {
    std::string region;
    double share = 0, ratio = 0;  ///< 0 to 1.
};
/// "REGION=95%@40%"; nothing if it is not that.
std::optional<Keep> parse_keep(std::string_view text);

/// For each vertex of the full mesh of `record`, the vertex of `input` that it is, by group and place. Where
/// several vertices of one group are at one place, they are taken in the order of the input.
std::vector<std::uint32_t> record_origins(const Mesh& input, const ProgressiveMesh& record);

/// How many of the record's vertices that are in region `number` are there at `level`.
std::size_t region_vertices_at(const ProgressiveMesh& record, std::span<const std::uint32_t> origins,
                               const Marks& marks, std::size_t number, std::size_t level);

struct KeepResult {
    double weight = 1;                 ///< Infinite where no finite one keeps enough.
    double share = 0;                  ///< What that weight keeps.
    std::uint32_t level_vertices = 0;  ///< Of the whole level, with that weight.
    std::size_t bakes = 0;             ///< Records made to find it.
};

/// The weights that keep what is asked, within 1 % (or a vertex, where that is more): each region's weight is
/// searched by recording the sequence and counting, others staying as they are; with several, in turns. Sets
/// them in `marks`. Errors: kArgument for a region that is not there or is empty, or a share that no weight
/// reaches (the message says how far one gets); what collapse() returns.
Result<std::vector<KeepResult>> find_weights(const Mesh& mesh, Marks& marks, std::span<const Keep> wishes,
                                             const CollapseOptions& options = {},
                                             const Progress& progress = {});

}  // namespace vsplit::bake
