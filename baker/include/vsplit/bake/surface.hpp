// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A surface from points: Power Crust (Amenta, Choi, Kolluri, "The power crust", 2001), as published and
// modified.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vsplit/bake/progress.hpp"
#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

enum class CrustMethod : std::uint8_t {
    kModified,  ///< Labels on Delaunay cells; the surface goes through the samples. Fast.
                ///< docs/reconstruction.md tells how.
    kClassic,   ///< As published: the faces of the poles' power diagram between inside and outside.
};

/// What can be written out for ParaView, as VTK XML with appended binary data. A set of flags.
enum CrustDump : unsigned {
    kDumpVoronoi = 1,  ///< "voronoi.vtp": Voronoi vertices (radius, label) and the edges between them.
    kDumpPoles = 2,    ///< "poles.vtp": poles with radius, label and sample.
    kDumpPower = 4,    ///< "power.vtu": the regular triangulation of the poles, with labels at its points.
    kDumpLabels = 8,   ///< "labels.vtu": Delaunay cells with their label (modified only).
};

struct ReconstructOptions {
    CrustMethod method = CrustMethod::kModified;
    bool open = false;   ///< The samples cover a sheet with a boundary (a terrain), not a closed surface.
                         ///< Modified only.
    bool refine = true;  ///< Add vertices on creases and curves between the samples (modified only).
    bool smooth = true;  ///< Move vertices of a noisy surface onto their neighbours' quadric; a clean one is
                         ///< left alone (modified only).
    bool medial_axis = false;
    unsigned dumps = 0;  ///< Of CrustDump; each is handed to `sink`.
    /// Receives each dump's file name and bytes. Called from the thread that called reconstruct().
    std::function<void(std::string_view name, std::span<const std::byte> bytes)> sink;
    /// Taken off all positions: the mesh's Mesh::origin. Coordinates far from 0 (map projections) keep their
    /// digits so; see local_origin() in meshes.hpp.
    std::array<double, 3> origin{};
    double open_reach = 6;  ///< With `open`: rim triangles longer than this many spacings are trimmed off.
    /// 0: all, except for the triangulation itself, which runs on more than one only if told how many. The
    /// result does not depend on it.
    int threads = 0;
};

struct CrustStage {
    std::string name;
    double cpu_seconds = 0, wall_seconds = 0;
    std::uint64_t peak_bytes = 0;  ///< Of the process so far, as the operating system tells it.
};

struct CrustReport {
    std::uint64_t points_in = 0, duplicates = 0;
    std::uint64_t cells = 0, poles = 0,
                  poles_hidden = 0;   ///< Hidden: without a cell of their own in the power diagram.
    std::uint64_t cells_flipped = 0;  ///< Labels changed because the surface touched itself.
    std::uint64_t vertices_split = 0, edges_split = 0;  ///< Where sheets touch and were drawn apart.
    std::uint64_t crease_points = 0, corner_points = 0, curve_points = 0;
    std::uint64_t edges_collapsed = 0, edges_flipped = 0, slivers_left = 0;
    std::uint64_t components_dropped = 0, triangles_dropped = 0, triangles_trimmed = 0;
    std::uint64_t handle_cells = 0;    ///< Labels changed because they made a handle too narrow to be meant.
    std::uint64_t samples_unused = 0;  ///< Not a vertex of the surface (before refinement).
    double roughness = 0;              ///< Noise left, in edge lengths; smoothed if above 0.12.
    bool smoothed = false;
    std::uint64_t vertices = 0, triangles = 0, components = 0, boundary_loops = 0;
    std::int64_t genus = 0;  ///< Sum over the components.
    bool watertight = false;
    std::vector<CrustStage> stages;
};

/// The poles on the inner side, and the simplices of their regular triangulation: the power shape.
struct MedialAxis {
    std::vector<std::array<double, 3>> centres;
    std::vector<double> radii;
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct Reconstruction {
    Mesh mesh;  ///< Oriented 2-manifold, normals outward; closed unless `open`.
    CrustReport report;
    MedialAxis medial_axis;  ///< Empty unless asked for. In the coordinates of the samples.
};

/// Reconstructs the surface that `positions` sample. Best cleaned first (points.hpp). Duplicates are merged.
/// Errors: kArgument (not finite; fewer than four different points; points in one plane without `open`; no
/// surface found; options that exclude each other), kLimit (more than 100 million points, or not enough
/// memory), kCancelled.
Result<Reconstruction> reconstruct(std::span<const std::array<double, 3>> positions,
                                   const ReconstructOptions& options = {}, const Progress& progress = {});

/// A medial axis as VTK XML (.vtp): poles with radii, edges and triangles of the power shape.
std::vector<std::byte> encode_medial_axis(const MedialAxis& axis);

}  // namespace vsplit::bake
