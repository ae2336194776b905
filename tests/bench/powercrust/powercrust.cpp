// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reconstruction times as markdown: the paper's Table I, the ratio to CGAL's Delaunay triangulation, scaling,
// and the corpus. Each measurement runs in a child process of its own, so that peak memory is its own and the
// heap is fresh.
//
// bench_powercrust [--quick] [CORPUS]     times are CPU seconds, the median of three runs; peak is the
// process's.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "vsplit/bake/files.hpp"
#include "vsplit/bake/points.hpp"
#include "vsplit/bake/samples.hpp"
#include "vsplit/bake/surface.hpp"

using namespace vsplit;
using namespace vsplit::bake;

std::size_t triangulate_alone(std::span<const std::array<double, 3>> positions);

namespace {

using Positions = std::vector<std::array<double, 3>>;

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Measured {
    double delaunay = 0, clean = 0, modified = 0, classic = 0, peak_mb = 0, triangles = 0, genus = 0,
           components = 0;
};

enum Work : unsigned { kDelaunay = 1, kClean = 2, kModified = 4, kClassic = 8 };

Measured measure_here(const Positions& given, unsigned work) {
    Measured m;
    Positions positions = given;
    double start = cpu_seconds();
    const auto lap = [&] {
        const double now = cpu_seconds(), d = now - start;
        start = now;
        return d;
    };
    const auto peak = [&] {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return static_cast<double>(usage.ru_maxrss) / 1024;
    };
    if (work & kClean) {
        PointCloud cloud;
        cloud.positions = positions;
        lap();
        auto cleaned = clean_points(std::move(cloud));
        m.clean = lap();
        if (cleaned.ok()) positions = std::move(cleaned->cloud.positions);
    }
    if (work & (kModified | kClassic)) {
        ReconstructOptions options;
        options.method = work & kClassic ? CrustMethod::kClassic : CrustMethod::kModified;
        lap();
        const auto r = reconstruct(positions, options);
        (work & kClassic ? m.classic : m.modified) = lap();
        if (!r.ok()) {
            std::fprintf(stderr, "%s\n", r.error().describe().c_str());
            return m;
        }
        m.triangles = static_cast<double>(r->report.triangles);
        m.genus = static_cast<double>(r->report.genus);
        m.components = static_cast<double>(r->report.components);
        m.peak_mb = peak();
    }
    if (work & kDelaunay) {
        lap();
        const std::size_t cells = triangulate_alone(positions);
        m.delaunay = lap();
        if (cells == 0) std::fprintf(stderr, "no cells\n");
    }
    return m;
}

Measured measure(const Positions& positions, unsigned work) {
    int ends[2];
    Measured m;
    if (pipe(ends) != 0) return m;
    const pid_t child = fork();
    if (child == 0) {
        m = measure_here(positions, work);
        const bool sent = write(ends[1], &m, sizeof m) == sizeof m;
        _exit(sent ? 0 : 1);
    }
    close(ends[1]);
    if (child < 0 || read(ends[0], &m, sizeof m) != sizeof m) m = {};
    close(ends[0]);
    if (child > 0) waitpid(child, nullptr, 0);
    return m;
}

/// Median of three by `key`, all figures of that run.
Measured median(const Positions& positions, unsigned work, double Measured::*key) {
    std::vector<Measured> runs;
    for (int i = 0; i < 3; ++i) runs.push_back(measure(positions, work));
    std::sort(runs.begin(), runs.end(),
              [&](const Measured& a, const Measured& b) { return a.*key < b.*key; });
    return runs[1];
}

Positions sample(Sample which, std::size_t count) {
    Positions positions;
    for (const Float3& p : make_sample_points(which, count)) positions.push_back({p.x, p.y, p.z});
    return positions;
}

void table_one() {
    std::printf(
        "### Table I: classic against modified, CPU seconds\n\n| cloud | points | classic | modified | ratio "
        "| paper's ratio |\n"
        "| --- | --- | --- | --- | --- | --- |\n");
    const auto row = [](const char* name, Sample which, std::size_t count, double paper) {
        const Positions points = sample(which, count);
        const Measured classic = median(points, kClassic, &Measured::classic),
                       modified = median(points, kModified, &Measured::modified);
        std::printf("| %s | %zu | %.3f | %.3f | **%.2f** | %.2f |\n", name, count, classic.classic,
                    modified.modified, modified.modified / classic.classic, paper);
        std::fflush(stdout);
    };
    row("whale", Sample::kWhale, 5000, 3.52 / 6.03);
    row("ocean", Sample::kOcean, 20000, 10.27 / 15.36);
}

void scaling(bool quick) {
    std::printf(
        "\n### Scaling: samples of the whale\n\n| points | CGAL Delaunay s | clean s | modified s | modified "
        "/ Delaunay | peak MB | triangles |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n");
    for (const std::size_t count : {5000, 20000, 100000, 500000, 1000000}) {
        if (quick && count > 100000) break;
        const Positions points = sample(Sample::kWhale, count);
        const unsigned work = kDelaunay | kClean | kModified;
        const Measured m = median(points, work, &Measured::modified);
        std::printf("| %zu | %.3f | %.3f | %.3f | **%.2f** | %.0f | %.0f |\n", count, m.delaunay, m.clean,
                    m.modified, m.modified / m.delaunay, m.peak_mb, m.triangles);
        std::fflush(stdout);
    }
}

void corpus(const std::string& folder) {
    std::printf(
        "\n### Corpus, default options\n\n| cloud | points | CGAL Delaunay s | clean s | modified s | "
        "modified / Delaunay | classic s | triangles | genus | components |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (const char* name :
         {"armadillo-5k", "armadillo-20k", "armadillo-100k", "rocker-arm-20k", "fandisk-20k", "armadillo-n02",
          "armadillo-n05", "armadillo-out5", "ocean", "distcap"}) {
        const auto bytes = read_file(folder + "/points/" + name + ".xyz");
        if (!bytes.ok()) {
            std::fprintf(stderr, "%s: %s\n", name, bytes.error().describe().c_str());
            continue;
        }
        const auto file = parse_points(*bytes, ".xyz");
        if (!file.ok()) continue;
        const Positions& points = file->cloud.positions;
        const Measured m = median(points, kDelaunay | kClean | kModified, &Measured::modified);
        const Measured c = measure(points, kClean | kClassic);
        std::printf("| %s | %zu | %.3f | %.3f | %.3f | **%.2f** | %.3f | %.0f | %.0f | %.0f |\n", name,
                    points.size(), m.delaunay, m.clean, m.modified, m.modified / m.delaunay, c.classic,
                    m.triangles, m.genus, m.components);
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    bool quick = false;
    std::string folder;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--quick") == 0)
            quick = true;
        else
            folder = argv[i];
    }
    table_one();
    scaling(quick);
    if (!folder.empty()) corpus(folder);
}
