// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Point clouds: read, measured, cleaned.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vsplit/bake/progress.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

/// Samples of a surface, in the object's own units. Owns its arrays.
struct PointCloud {
    std::vector<std::array<double, 3>> positions;      ///< Finite.
    std::vector<std::array<float, 3>> normals;         ///< Empty, or one per point; as the file has them.
    std::vector<std::array<std::uint8_t, 3>> colours;  ///< Empty, or one per point: red, green, blue.
};

/// What a reader met on the way.
struct PointReport {
    std::string format;           ///< "PCD 0.7 (binary_compressed)", for people.
    std::uint64_t points_in = 0;  ///< As the file lists them.
    std::uint64_t points_dropped_non_finite = 0;
    std::uint64_t lines_skipped = 0;  ///< Text: comments, blank lines, a count line, a line of column names.
    std::uint64_t columns_ignored = 0;  ///< Columns or properties beyond position, normal and colour.
};

struct PointFile {
    PointCloud cloud;
    PointReport report;
};

struct PointReadOptions {
    std::uint64_t max_points = 100'000'000;  ///< More are an error (kLimit).
};

/// Reads .ply and .pcd (told by content) and text: .xyz .txt .pts .asc .csv, one point a line, coordinates
/// first, separated by blanks, tabs, commas or semicolons; # and // start comments; a first line with a
/// single whole number is a count. Of further columns three in [-1, 1] with a fraction are a normal, three
/// whole numbers in [0, 255] a colour (after an intensity, as .pts has it, too), the rest is ignored. Hostile
/// bytes are safe. Errors carry the line (text) or offset.
Result<PointFile> parse_points(std::span<const std::byte> bytes, std::string_view extension,
                               const PointReadOptions& options = {});

enum class Thin : std::uint8_t {
    kNone,
    kGrid,  ///< One point, nearest to the mean, of each cell of a grid.
    kWlop,  ///< CGAL's weighted locally optimal projection: fewer, evenly spread, denoised points. Slow.
};

enum class Smooth : std::uint8_t {
    kAuto,  ///< kJet if the noise measured asks for it, else kNone.
    kNone,
    kJet,        ///< Each point onto a quadric fitted to its neighbours. Rounds sharp edges off.
    kBilateral,  ///< Keeps sharp edges; wants normals, estimates them where the cloud has none.
};

struct CleanOptions {
    bool duplicates = true;     ///< Drop points whose position was met before.
    double outlier_factor = 3;  ///< Drop a point whose third neighbour is this many times farther than is
                                ///< usual around it; 0: keep.
    Thin thin = Thin::kNone;
    double grid_cell = 0;     ///< Side of a grid cell; 0: twice the spacing.
    double wlop_share = 0.5;  ///< Of the points, how many kWlop keeps.
    Smooth smooth = Smooth::kAuto;
    int smooth_neighbours = 0;  ///< 0: by the noise measured.
    int threads = 0;            ///< 0: all. The result does not depend on it.
};

/// What the cloud is like. Zeros for fewer than 16 points.
struct CloudMeasure {
    double spacing = 0;  ///< Median distance to the third neighbour, over sqrt(3): the side of a sample's
                         ///< share of surface.
    double noise =
        0;  ///< Median, over some samples, of the deviation from a quadric fitted to 24 neighbours.
};

struct CleanReport {
    std::uint64_t points_in = 0, duplicates = 0, outliers = 0, thinned = 0, points_out = 0;
    CloudMeasure measure;            ///< After duplicates and outliers.
    int smooth_neighbours = 0;       ///< 0: not smoothed.
    double mean_move = 0;            ///< By smoothing.
    std::vector<std::string> steps;  ///< What was done and why, one sentence each.
};

struct CleanedCloud {
    PointCloud cloud;  ///< In the order of the input.
    CleanReport report;
};

/// Makes a cloud fit for reconstruction. The defaults measure first and touch a clean cloud not at all.
/// Errors: kArgument for options out of range, kCancelled.
Result<CleanedCloud> clean_points(PointCloud cloud, const CleanOptions& options = {},
                                  const Progress& progress = {});

/// Spacing and noise of a cloud, as clean_points measures them.
CloudMeasure measure_points(std::span<const std::array<double, 3>> positions);

/// The Voronoi tessellation, sample by sample.
struct VoronoiCells {
    std::vector<double> volumes;  ///< Infinity for samples on the convex hull, whose cells are unbounded.
    std::vector<double>
        densities;  ///< Points per volume: 1 / volume (of duplicates: their number); 0 on the hull.
    std::vector<std::uint32_t> neighbour_starts{
        0};  ///< Neighbours of sample i: neighbours[starts[i] .. starts[i + 1]).
    std::vector<std::uint32_t>
        neighbours;  ///< Ascending. Duplicates of a position share its cell and its list.
};

/// Cell volume, density and immediate neighbours of each sample. Errors: kArgument if all points lie in one
/// plane, kLimit.
Result<VoronoiCells> voronoi_cells(std::span<const std::array<double, 3>> positions, int threads = 0,
                                   const Progress& progress = {});

}  // namespace vsplit::bake
