// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// The stages of a reconstruction in their order. docs/reconstruction.md explains them.
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <memory>
#include <new>
#include <numeric>

#include "points/frame.hpp"
#include "points/tetrahedra.hpp"
#include "surface/boundary.hpp"
#include "surface/classic.hpp"
#include "surface/dumps.hpp"
#include "surface/handles.hpp"
#include "surface/labels.hpp"
#include "surface/refine.hpp"
#include "surface/sheet.hpp"
#include "surface/smooth.hpp"
#include "surface/tidy.hpp"
#include "vsplit/bake/surface.hpp"

namespace vsplit::bake {
namespace {

constexpr std::size_t kMostPoints = 100'000'000;
/// Below, the threads of CGAL's concurrent triangulation cost more than they bring.
constexpr std::size_t kWorthThreads = 100'000;
/// Clean samples of a detailed model (armadillo, 5,000 samples) leave 0.085; 0.5 % noise after smoothing the
/// points 0.15.
constexpr double kRough = 0.12;
/// Half the side of the box around the samples, in half sides of their own box: as in the published program.
constexpr double kBox = 5;
/// Quality below which a triangle is a sliver.
constexpr double kSliver = 0.02;

Error argument(const char* what) {
    return {ErrorCode::kArgument, what, Error::kNowhere, 0};
}

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Names the stages, times them and asks the caller whether to go on.
class Stages {
  public:
    Stages(CrustReport& report, const Progress& progress) : report_(report), progress_(progress) {}
    /// Ends the stage before. False if the caller wants to stop.
    bool begin(const char* name, double done) {
        end();
        name_ = name;
        return !progress_ || progress_(name, done);
    }
    void end() {
        const double cpu = cpu_seconds();
        const auto wall = std::chrono::steady_clock::now();
        if (name_) {
            rusage usage{};
            getrusage(RUSAGE_SELF, &usage);
            report_.stages.push_back({name_, cpu - cpu_, std::chrono::duration<double>(wall - wall_).count(),
                                      static_cast<std::uint64_t>(usage.ru_maxrss) * 1024});
        }
        name_ = nullptr;
        cpu_ = cpu;
        wall_ = wall;
    }

  private:
    CrustReport& report_;
    const Progress& progress_;
    const char* name_ = nullptr;
    double cpu_ = 0;
    std::chrono::steady_clock::time_point wall_;
};

/// Euler's count of a manifold, component by component only in sum.
void survey(const Crust& crust, CrustReport& report) {
    const std::vector<std::uint32_t> opposite = pair_edges(crust);
    std::vector<std::uint32_t> root(crust.points.size());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](std::uint32_t v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    std::uint64_t boundary = 0, components = 0;
    std::vector<std::uint32_t> next(crust.points.size(), kNoEdge);
    for (std::uint32_t h = 0; h < opposite.size(); ++h) {
        root[find(edge_from(crust, h))] = find(edge_to(crust, h));
        if (opposite[h] != kNoEdge) continue;
        ++boundary;
        next[edge_from(crust, h)] = edge_to(crust, h);
    }
    for (std::uint32_t v = 0; v < root.size(); ++v) components += find(v) == v;
    std::uint64_t loops = 0;
    for (std::uint32_t v = 0; v < next.size(); ++v) {
        if (next[v] == kNoEdge) continue;
        ++loops;
        for (std::uint32_t w = v; next[w] != kNoEdge;) w = std::exchange(next[w], kNoEdge);
    }
    report.vertices = crust.points.size();
    report.triangles = crust.triangles.size();
    report.components = components;
    report.boundary_loops = loops;
    report.watertight = boundary == 0 && !crust.triangles.empty();
    const auto edges = static_cast<std::int64_t>((3 * crust.triangles.size() + boundary) / 2);
    const std::int64_t euler =
        static_cast<std::int64_t>(report.vertices) - edges + static_cast<std::int64_t>(report.triangles);
    report.genus = (2 * static_cast<std::int64_t>(components) - static_cast<std::int64_t>(loops) - euler) / 2;
}

/// Median edge length.
double spacing(const Crust& crust) {
    std::vector<double> edges;
    edges.reserve(crust.triangles.size());
    for (const Triangle& t : crust.triangles)
        edges.push_back(length(crust.points[t[1]] - crust.points[t[0]]));
    if (edges.empty()) return 0;
    const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
    std::nth_element(edges.begin(), middle, edges.end());
    return *middle;
}

class Reconstructor {
  public:
    Reconstructor(const ReconstructOptions& options, const Progress& progress)
        : options_(options), progress_(progress), stages_(out_.report, progress_) {}

    Result<Reconstruction> run(std::span<const std::array<double, 3>> positions) {
        CrustReport& report = out_.report;
        report.points_in = positions.size();
        if (!stages_.begin("prepare", 0)) return stopped();
        const Frame frame(positions);
        const UniquePoints samples = unique_points(frame.into(positions));
        const std::size_t count = samples.points.size();
        report.duplicates = positions.size() - count;
        if (count < 4) return argument("fewer than four different points");

        if (!stages_.begin("delaunay", 0.02)) return stopped();
        Tetrahedra tetrahedra = tetrahedralise(boxed(samples.points), count, threads_for(count));
        report.cells = tetrahedra.cells.size();
        if (!stages_.begin("poles", 0.35)) return stopped();
        const Balls balls = circumscribe(tetrahedra);
        const Poles poles = find_poles(tetrahedra, balls);

        Crust crust;
        if (options_.method == CrustMethod::kClassic) {
            if (!stages_.begin("power diagram", 0.4)) return stopped();
            const PoleBalls pole_balls = gather_poles(tetrahedra, balls, poles);
            const PowerDiagram diagram = regular_triangulation(pole_balls.centres, pole_balls.weights);
            if (!stages_.begin("labels", 0.8)) return stopped();
            const std::vector<std::uint8_t> inner = label_poles(tetrahedra, pole_balls, diagram);
            if (!stages_.begin("surface", 0.9)) return stopped();
            crust = power_faces(tetrahedra, pole_balls, diagram, inner);
            count_poles(pole_balls, &diagram);
            dump(frame, samples, tetrahedra, balls, pole_balls, &diagram, inner, nullptr);
        } else {
            if (!stages_.begin("labels", 0.45)) return stopped();
            std::vector<std::uint8_t> inside = label_cells(tetrahedra, balls, poles, options_.open);
            if (!stages_.begin("surface", 0.6)) return stopped();
            BoundaryReport boundary;
            untangle(tetrahedra, inside, boundary);
            crust = extract_boundary(tetrahedra, inside, boundary);
            survey(crust, report);
            // Drawing sheets apart may leave a handle of its own; a second look finds most of these.
            for (int round = 0; round < 2 && report.genus > 0; ++round) {
                if (!stages_.begin("handles", 0.65)) return stopped();
                // A sheet has no handles; a closed surface has those that balls of a few spacings fit
                // through.
                const double smallest =
                    options_.open ? std::numeric_limits<double>::infinity() : 3 * spacing(crust);
                const std::size_t changed = remove_handles(tetrahedra, balls, inside, 0, smallest) +
                                            remove_handles(tetrahedra, balls, inside, 1, smallest);
                if (changed == 0) break;
                report.handle_cells += changed;
                boundary.vertices_split = boundary.edges_split = 0;
                untangle(tetrahedra, inside, boundary);
                crust = extract_boundary(tetrahedra, inside, boundary);
                survey(crust, report);
            }
            report.cells_flipped = boundary.cells_flipped;
            report.vertices_split = boundary.vertices_split;
            report.edges_split = boundary.edges_split;
            count_unused(tetrahedra, inside);
            if (options_.medial_axis || options_.dumps != 0) {
                if (!stages_.begin("power diagram", 0.65)) return stopped();
                const PoleBalls pole_balls = gather_poles(tetrahedra, balls, poles);
                std::vector<std::uint8_t> inner;
                for (const std::uint32_t cell : pole_balls.cell) inner.push_back(inside[cell]);
                PowerDiagram diagram;
                const bool wanted = options_.medial_axis || (options_.dumps & kDumpPower);
                if (wanted) diagram = regular_triangulation(pole_balls.centres, pole_balls.weights);
                count_poles(pole_balls, wanted ? &diagram : nullptr);
                dump(frame, samples, tetrahedra, balls, pole_balls, &diagram, inner, &inside);
            } else {
                report.poles = count_of_poles(poles, tetrahedra.cells.size());
            }
        }
        tetrahedra = {};
        return finish(std::move(crust), frame);
    }

  private:
    Error stopped() const {
        return {ErrorCode::kCancelled, "stopped while reconstructing", Error::kNowhere, 0};
    }

    /// CGAL's concurrent triangulation is quicker by the clock on an idle machine, but its threads spin where
    /// they wait: it costs up to seven times the CPU time on a busy one. So it is used only by who asks for
    /// threads.
    int threads_for(std::size_t count) const { return count >= kWorthThreads ? options_.threads : 1; }

    /// The samples and the corners of a box so large that it does not bend what is near them.
    static std::vector<Vec3> boxed(std::vector<Vec3> points) {
        double half = 0;
        for (const Vec3& p : points) half = std::max({half, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        half *= kBox;
        for (int k = 0; k < 8; ++k)
            points.push_back({k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half});
        return points;
    }

    static std::uint64_t count_of_poles(const Poles& poles, std::size_t cells) {
        std::vector<std::uint8_t> is_pole(cells, 0);
        for (const auto* list : {&poles.first, &poles.second})
            for (const std::uint32_t c : *list)
                if (c != kNoCell) is_pole[c] = 1;
        return static_cast<std::uint64_t>(std::count(is_pole.begin(), is_pole.end(), 1));
    }

    void count_poles(const PoleBalls& poles, const PowerDiagram* diagram) {
        out_.report.poles = poles.cell.size();
        if (!diagram) return;
        std::vector<std::uint8_t> seen(poles.cell.size(), 0);
        for (const Corners& c : diagram->cells)
            for (const std::uint32_t p : c) seen[p] = 1;
        out_.report.poles_hidden = static_cast<std::uint64_t>(std::count(seen.begin(), seen.end(), 0));
    }

    void count_unused(const Tetrahedra& tetrahedra, const std::vector<std::uint8_t>& inside) {
        std::vector<std::uint8_t> sides(tetrahedra.points.size(), 0);
        for (std::size_t c = 0; c < inside.size(); ++c)
            for (const std::uint32_t v : tetrahedra.cells[c]) sides[v] |= inside[c] ? 1 : 2;
        for (std::size_t s = 0; s < tetrahedra.samples; ++s) out_.report.samples_unused += sides[s] != 3;
    }

    void dump(const Frame& frame, const UniquePoints& samples, const Tetrahedra& tetrahedra,
              const Balls& balls, const PoleBalls& poles, const PowerDiagram* diagram,
              const std::vector<std::uint8_t>& inner, const std::vector<std::uint8_t>* inside) {
        if (options_.medial_axis) out_.medial_axis = power_shape(frame, poles, *diagram, inner);
        if (!options_.sink) return;
        if (options_.dumps & kDumpVoronoi)
            options_.sink("voronoi.vtp", dump_voronoi(frame, tetrahedra, balls, inside));
        if (options_.dumps & kDumpPoles) options_.sink("poles.vtp", dump_poles(frame, poles, inner, samples));
        if (options_.dumps & kDumpPower)
            options_.sink("power.vtu", dump_power(frame, poles, *diagram, inner));
        if (options_.dumps & kDumpLabels && inside)
            options_.sink("labels.vtu", dump_labels(frame, tetrahedra, *inside));
    }

    Result<Reconstruction> finish(Crust crust, const Frame& frame) {
        CrustReport& report = out_.report;
        TidyReport tidy;
        const bool classic = options_.method == CrustMethod::kClassic;
        if (options_.open) {
            if (!stages_.begin("trim", 0.7)) return stopped();
            report.triangles_trimmed = trim_rim(crust, options_.open_reach);
            drop_small_components(crust, crust.triangles.size() / 100, tidy);
        } else {
            // A phantom is small in itself and next to nothing beside the whole.
            drop_small_components(crust, std::clamp<std::size_t>(crust.triangles.size() / 1000, 40, 200),
                                  tidy);
        }
        if (!classic && options_.smooth) {
            if (!stages_.begin("smooth", 0.75)) return stopped();
            report.roughness = roughness(crust);
            report.smoothed = report.roughness > kRough;
            if (report.smoothed) smooth(crust);
        }
        if (!classic && options_.refine) {
            if (!stages_.begin("refine", 0.8)) return stopped();
            const RefineReport refined = refine(crust);
            report.crease_points = refined.crease_points;
            report.corner_points = refined.corner_points;
            report.curve_points = refined.curve_points;
        }
        if (!stages_.begin("tidy", 0.9)) return stopped();
        // Repairs see the coordinates as they will be stored: rounding may bring vertices together.
        const Vec3 origin{options_.origin[0], options_.origin[1], options_.origin[2]};
        const Vec3 shift = frame.origin - origin;
        for (Vec3& p : crust.points) {
            const Vec3 q = p * (1 / frame.scale) + shift;
            p = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                return argument("the coordinates are too large for single precision");
        }
        repair_slivers(crust, kSliver, tidy);
        if (crust.triangles.empty())
            return argument(
                options_.open ? "no surface found"
                              : "no surface found: the points enclose no volume (an open scan? see `open`)");
        survey(crust, report);
        report.edges_collapsed = tidy.edges_collapsed;
        report.edges_flipped = tidy.edges_flipped;
        report.slivers_left = tidy.slivers_left;
        report.components_dropped = tidy.components_dropped;
        report.triangles_dropped = tidy.triangles_dropped;
        out_.mesh.positions.reserve(crust.points.size());
        for (const Vec3& p : crust.points)
            out_.mesh.positions.push_back(
                {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        out_.mesh.triangles = std::move(crust.triangles);
        out_.mesh.origin = options_.origin;
        stages_.end();
        if (progress_ && !progress_("done", 1)) return stopped();
        return std::move(out_);
    }

    const ReconstructOptions& options_;
    const Progress& progress_;
    Reconstruction out_;
    Stages stages_;
};

}  // namespace

Result<Reconstruction> reconstruct(std::span<const std::array<double, 3>> positions,
                                   const ReconstructOptions& options, const Progress& progress) {
    if (options.threads < 0) return argument("the number of threads is negative");
    if (options.open && options.method == CrustMethod::kClassic)
        return argument("the classic form makes closed surfaces only");
    if (options.open && !(options.open_reach > 1))
        return argument("an open surface reaches over at least one spacing");
    if (positions.size() > kMostPoints)
        return Error{ErrorCode::kLimit, "more than 100 million points", Error::kNowhere, 0};
    for (const auto& p : positions)
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
            return argument("a position is not finite");
    try {
        std::unique_ptr<tbb::global_control> limit;
        if (options.threads > 0)
            limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                          options.threads);
        return Reconstructor(options, progress).run(positions);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::kLimit, "not enough memory to reconstruct the surface", Error::kNowhere, 0};
    }
}

}  // namespace vsplit::bake
