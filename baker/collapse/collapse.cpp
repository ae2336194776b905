// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/bake/collapse.hpp"

#include <algorithm>
#include <ctime>

#include "calibrate.hpp"
#include "collapser.hpp"
#include "measure.hpp"
#include "outliers.hpp"
#include "stitch.hpp"

namespace vsplit::bake {
namespace {

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// The record as a pose has it. Its attributes say nothing more.
ProgressiveMesh in_pose(const ProgressiveMesh& mesh, const PosedRecord& pose) {
    ProgressiveMesh out = mesh;
    out.attributes.clear();
    out.moved_values.clear();
    out.positions = pose.positions;
    for (std::size_t i = 0; i < out.moves.size(); ++i) out.moves[i].position = pose.moves[i];
    return out;
}

/// One more split, the last, opens the input's triangles that have two corners at one point, with vertices
/// that only they have. Nothing of them is ever seen, so the error before it is none.
void bring_back(ProgressiveMesh& mesh, const Mesh& input, std::vector<std::uint32_t> births) {
    for (std::size_t t = 0; t < input.triangles.size(); ++t) {
        Triangle corners = input.triangles[t];
        const Float3 &a = input.positions[corners[0]], &b = input.positions[corners[1]],
                     &c = input.positions[corners[2]];
        if (!(a == b) && !(b == c) && !(c == a)) continue;
        for (std::uint32_t& v : corners) {
            std::uint32_t& birth = births[v];
            if (birth == kNoVertex) {
                birth = std::uint32_t(mesh.positions.size());
                mesh.positions.push_back(input.positions[v]);
                mesh.parents.push_back(kNoVertex);
                if (!mesh.weights.empty()) mesh.weights.push_back(input.weights[v]);
                for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
                    const Attribute& from = input.attributes[i];
                    const auto begin = from.values.begin() + std::ptrdiff_t(std::size_t{v} * from.components);
                    mesh.attributes[i].values.insert(mesh.attributes[i].values.end(), begin,
                                                     begin + std::ptrdiff_t(from.components));
                }
            }
            v = birth;
        }
        mesh.triangles.push_back(corners);
        if (!input.groups.empty()) mesh.groups.push_back(input.groups[t]);
    }
    mesh.splits.push_back({std::uint32_t(mesh.positions.size()), std::uint32_t(mesh.triangles.size()),
                           std::uint32_t(mesh.corner_changes.size()), std::uint32_t(mesh.moves.size()), 0});
}

/// Numbers of vertices after splits were put into another order; `ends` are the splits before it.
void renumber(std::vector<std::uint32_t>& births, std::uint32_t base, const std::vector<Split>& ends,
              const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> now(ends.empty() ? base : ends.back().vertices_end);
    for (std::uint32_t v = 0; v < base; ++v) now[v] = v;
    std::uint32_t next = base;
    for (const std::uint32_t split : order)
        for (std::uint32_t v = split == 0 ? base : ends[split - 1].vertices_end; v < ends[split].vertices_end;
             ++v)
            now[v] = next++;
    for (std::uint32_t& birth : births)
        if (birth != kNoVertex) birth = now[birth];
}

/// Raises the errors to what deviations beyond them, of splits coarsest first, tell.
void raise_errors(ProgressiveMesh& mesh, const std::vector<float>& posed,
                  const std::vector<std::uint32_t>& order) {
    float most = 0;
    for (std::size_t i = mesh.splits.size(); i-- > 0;) {
        most = std::max(most, posed[order.empty() ? i : order[i]]);
        mesh.splits[i].error = std::max(mesh.splits[i].error, most);
    }
}

}  // namespace

Result<CollapseResult> collapse(const Mesh& mesh, const CollapseOptions& options, const Progress& progress) {
    const auto refuse = [](std::string message) {
        return Error{ErrorCode::kArgument, std::move(message), Error::kNowhere, 0};
    };
    if (const char* fault = mesh_fault(mesh)) return refuse(std::string("unsound mesh: ") + fault);
    if (mesh.triangles.size() > (std::size_t{1} << 30) || mesh.positions.size() > (std::size_t{1} << 30))
        return Error{ErrorCode::kLimit, "more than 2^30 triangles or vertices", Error::kNowhere, 0};
    const auto within = [](double value, double least, double most) {
        return value >= least && value <= most;
    };
    if (!within(options.boundary_weight, 0, 1e6)) return refuse("boundary_weight must be 0 to 1e6");
    if (!within(options.volume_weight, 0, 1e6)) return refuse("volume_weight must be 0 to 1e6");
    if (!within(options.regularisation, 1e-12, 1)) return refuse("regularisation must be 1e-12 to 1");
    if (!within(options.deviation_limit, 0, 1e9)) return refuse("deviation_limit must be 0 to 1e9");
    if (!within(options.lock_features_degrees, 0, 180))
        return refuse("lock_features_degrees must be 0 to 180");
    if (!within(options.min_normal_cosine, -1, 1)) return refuse("min_normal_cosine must be -1 to 1");
    if (!within(options.min_quality, 0, 1)) return refuse("min_quality must be 0 to 1");
    if (!within(options.stitch, 0, 0.01)) return refuse("stitch must be 0 to 0.01");
    const Error cancelled{ErrorCode::kCancelled, "cancelled", Error::kNowhere, 0};
    if (!options.part_of.empty() && options.part_of.size() != mesh.positions.size())
        return refuse("part_of must have one number per vertex");
    if (!options.poses.empty() && !options.poses.set_of.empty() &&
        options.poses.set_of.size() != mesh.positions.size())
        return refuse("poses.set_of must have one number per vertex");
    for (const std::uint32_t set : options.poses.set_of)
        if (set != PoseSets::kNone && set >= options.poses.sets.size())
            return refuse("poses.set_of names a set that is not there");
    CollapseResult result;
    WedgeExtras extras;
    double start = cpu_seconds();
    TriangleCopies copies;
    const auto record = [&](Collapser&& collapser) {
        if (!collapser.run(progress)) return false;
        result.mesh = collapser.finish(result.report, extras);
        copies = collapser.take_copies();
        return true;
    };
    const bool plain = mesh.attributes.empty() && mesh.groups.empty();
    std::vector<Stitch> stitched;
    {
        PointMesh points;
        const double share = options.lock_boundary ? 0 : options.stitch;
        if (!plain) {
            points = points_of(mesh, options.part_of);
        } else if (share > 0 && may_have_boundary(mesh)) {
            points.mesh = mesh;
            points.corners = mesh.triangles;
        }
        if (share > 0) stitched = stitch_borders(points, share);
        if (plain && stitched.empty()) points = {};
        extras.wants_births = !stitched.empty();
        Mesh met;  // the input as it is stitched
        if (!stitched.empty() && !plain) {
            met = mesh;
            for (const Stitch& s : stitched) met.positions[s.vertex] = mesh.positions[s.other];
        }
        const bool recorded = plain ? record(Collapser(stitched.empty() ? mesh : points.mesh, options))
                                    : record(Collapser(points, stitched.empty() ? mesh : met, options));
        if (!recorded) return cancelled;
        if (plain) {
            result.report.unused_vertices -= stitched.size();
        } else {
            result.report.unused_vertices = points.unused;
            result.report.degenerate_triangles = points.degenerate;
        }
    }
    result.mesh.origin = mesh.origin;
    result.report.collapse_cpu_seconds = cpu_seconds() - start;
    start = cpu_seconds();
    const bool put_off = options.put_off_outliers && options.cost != Cost::kPaper;
    if (put_off || options.calibrate) {
        std::vector<float> deviations = measure_collapses(result.mesh, progress);
        if (deviations.size() != result.mesh.splits.size()) return cancelled;
        std::vector<float> in_poses(extras.posed.empty() ? 0 : deviations.size(), 0.0f);
        for (PosedRecord& pose : extras.posed) {
            const std::vector<float> own = measure_collapses(in_pose(result.mesh, pose), progress);
            if (own.size() != deviations.size()) return cancelled;
            for (std::size_t i = 0; i < own.size(); ++i) in_poses[i] = std::max(in_poses[i], own[i]);
            pose = {};
        }
        for (std::size_t i = 0; i < in_poses.size(); ++i)
            deviations[i] = std::max(deviations[i], in_poses[i]);
        std::vector<std::uint32_t> order;
        if (put_off) {
            const std::vector<Split> before =
                extras.births.empty() ? std::vector<Split>() : result.mesh.splits;
            order = put_off_outliers(result.mesh, deviations, options.placement == Placement::kEndpoint);
            if (!before.empty()) renumber(extras.births, result.mesh.base_vertices, before, order);
        }
        if (options.calibrate && !bound_errors(result.mesh, deviations, progress)) return cancelled;
        // Where whole levels were measured it was in the bind pose.
        if (options.calibrate && !in_poses.empty()) raise_errors(result.mesh, in_poses, order);
    }
    if (copies.any()) copies.expand(result.mesh);
    unstitch(result.mesh, mesh, stitched, extras.births, !plain);
    result.report.duplicate_triangles = copies.count();
    result.report.stitched_vertices = stitched.size();
    if (result.report.degenerate_triangles > 0) bring_back(result.mesh, mesh, extras.births);
    result.report.calibrate_cpu_seconds = cpu_seconds() - start;
    return result;
}

}  // namespace vsplit::bake
