// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/bake/collapse.hpp"

#include <ctime>

#include "calibrate.hpp"
#include "collapser.hpp"
#include "measure.hpp"
#include "outliers.hpp"

namespace vsplit::bake {
namespace {

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
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
    const Error cancelled{ErrorCode::kCancelled, "cancelled", Error::kNowhere, 0};
    if (!options.part_of.empty() && options.part_of.size() != mesh.positions.size())
        return refuse("part_of must have one number per vertex");
    CollapseResult result;
    double start = cpu_seconds();
    TriangleCopies copies;
    const auto record = [&](Collapser&& collapser) {
        if (!collapser.run(progress)) return false;
        result.mesh = collapser.finish(result.report);
        copies = collapser.take_copies();
        return true;
    };
    if (mesh.attributes.empty() && mesh.groups.empty()) {
        if (!record(Collapser(mesh, options))) return cancelled;
    } else {
        const PointMesh points = points_of(mesh, options.part_of);
        if (!record(Collapser(points, mesh, options))) return cancelled;
        result.report.unused_vertices = points.unused;
        result.report.degenerate_triangles = points.degenerate;
    }
    result.mesh.origin = mesh.origin;
    result.report.collapse_cpu_seconds = cpu_seconds() - start;
    start = cpu_seconds();
    const bool put_off = options.put_off_outliers && options.cost != Cost::kPaper;
    if (put_off || options.calibrate) {
        std::vector<float> deviations = measure_collapses(result.mesh, progress);
        if (deviations.size() != result.mesh.splits.size()) return cancelled;
        if (put_off) put_off_outliers(result.mesh, deviations, options.placement == Placement::kEndpoint);
        if (options.calibrate && !bound_errors(result.mesh, deviations, progress)) return cancelled;
    }
    if (copies.any()) copies.expand(result.mesh);
    result.report.duplicate_triangles = copies.count();
    result.report.calibrate_cpu_seconds = cpu_seconds() - start;
    return result;
}

}  // namespace vsplit::bake
