// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// How far levels of animated scenes are from the full scene at moments of the animation, as `lods --poses N`
// makes them: root mean square and largest distance, both ways, between samples of one and triangles of the
// other.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "scene.hpp"

namespace vsplit::bench {
namespace {

namespace fs = std::filesystem;
using Point = std::array<double, 3>;

Point operator-(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point along(const Point& a, const Point& d, double t) {
    return {a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]};
}
double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Surface {
    std::vector<std::array<Point, 3>> triangles;
    explicit Surface(const Soup& soup) {
        for (std::size_t c = 0; c + 2 < soup.corners.size(); c += 3) {
            std::array<Point, 3> t;
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t i = 0; i < 3; ++i) t[k][i] = double(soup.corners[c + k].position[i]);
            triangles.push_back(t);
        }
    }

    std::vector<Point> samples(std::size_t count) const {
        std::vector<double> sums;
        double sum = 0;
        for (const auto& t : triangles) {
            const Point n = cross(t[1] - t[0], t[2] - t[0]);
            sums.push_back(sum += std::sqrt(dot(n, n)));
        }
        std::mt19937_64 random(7);
        const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
        std::vector<Point> out;
        while (out.size() < count) {
            const auto at = std::lower_bound(sums.begin(), sums.end(), unit() * sum) - sums.begin();
            const auto& t = triangles[std::min(std::size_t(at), triangles.size() - 1)];
            double u = unit(), v = unit();
            if (u + v > 1) u = 1 - u, v = 1 - v;
            out.push_back(along(along(t[0], t[1] - t[0], u), t[2] - t[0], v));
        }
        return out;
    }

    double distance2(const Point& p) const {
        double least = 1e300;
        for (const auto& t : triangles) {
            const Point ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0], n = cross(ab, ac);
            const double bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac), pb = dot(ap, ab),
                         pc = dot(ap, ac), determinant = bb * cc - bc * bc, x = cc * pb - bc * pc,
                         y = bb * pc - bc * pb;
            if (determinant > 0 && x >= 0 && y >= 0 && x + y <= determinant) {
                const double h = dot(n, ap);
                least = std::min(least, h * h / dot(n, n));
                continue;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                const Point d = t[(k + 1) % 3] - t[k], w = p - t[k];
                const double dd = dot(d, d), s = dd > 0 ? std::clamp(dot(w, d) / dd, 0.0, 1.0) : 0;
                const Point rest = p - along(t[k], d, s);
                least = std::min(least, dot(rest, rest));
            }
        }
        return least;
    }
};

struct Apart {
    double mean2 = 0, most2 = 0;
};

Apart apart(const Surface& a, const Surface& b, std::size_t count) {
    Apart out;
    for (const auto* from : {&a, &b}) {
        const Surface& to = from == &a ? b : a;
        const std::vector<Point> points = from->samples(count);
        std::vector<double> distances(points.size());
        tbb::parallel_for(std::size_t{0}, points.size(),
                          [&](std::size_t i) { distances[i] = to.distance2(points[i]); });
        for (const double d : distances) {
            out.mean2 += d / double(2 * points.size());
            out.most2 = std::max(out.most2, d);
        }
    }
    return out;
}

int run(const std::string& command, const std::vector<std::string>& files, const std::vector<int>& poses,
        const std::vector<double>& ratios) {
    const std::string folder = fs::temp_directory_path() / fmt::format("vsplit-bench-poses-{}", ::getpid());
    fs::create_directories(folder);
    // Halfway between the moments that 8 poses look at, of one animation.
    constexpr double kTimes[] = {0.125, 0.375, 0.625, 0.875};
    std::string list;
    for (const double ratio : ratios) list += fmt::format("{}{}", list.empty() ? "" : ",", ratio);
    fmt::print("| scene | ratio | poses | RMS | largest |\n| --- | --- | --- | --- | --- |\n");
    for (const std::string& file : files)
        for (const int count : poses) {
            const std::string stem = folder + "/levels";
            const std::string line =
                fmt::format("'{}' lods '{}' --separate --ratios {} --poses {} -q -f -o '{}.glb'", command,
                            file, list, count, stem);
            if (std::system(line.c_str()) != 0) throw std::runtime_error("failed: " + line);
            for (std::size_t i = 0; i < ratios.size(); ++i) {
                double mean2 = 0, most2 = 0;
                for (const double time : kTimes) {
                    const Surface full(pose(load_scene(file, time)));
                    const Surface level(pose(load_scene(fmt::format("{}-lod{}.glb", stem, i), time)));
                    const Apart found = apart(full, level, 3000);
                    mean2 += found.mean2 / double(std::size(kTimes));
                    most2 = std::max(most2, found.most2);
                }
                fmt::print("| {} | {} % | {} | {:.5f} | {:.5f} |\n", fs::path(file).stem().string(),
                           100 * ratios[i], count, std::sqrt(mean2), std::sqrt(most2));
                std::fflush(stdout);
            }
        }
    fs::remove_all(folder);
    return 0;
}

}  // namespace
}  // namespace vsplit::bench

int main(int argc, char** argv) {
    CLI::App app{"Levels of animated scenes at moments of the animation, with poses sampled and without"};
    std::string command = "build/release/bin/vsplit";
    std::vector<std::string> files;
    std::vector<int> poses{0, 8};
    std::vector<double> ratios{0.25, 0.1};
    app.add_option("--command", command, "The vsplit command")->capture_default_str();
    app.add_option("--poses", poses, "What to give to --poses")->delimiter(',')->capture_default_str();
    app.add_option("--ratios", ratios, "Of triangles")->delimiter(',')->capture_default_str();
    app.add_option("scenes", files, "GLB")->required();
    CLI11_PARSE(app, argc, argv);
    try {
        return vsplit::bench::run(command, files, poses, ratios);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
