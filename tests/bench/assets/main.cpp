// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// bench assets: how a level looks against the full scene, ours and meshoptimizer's, each at the same number
// of triangles, in the same renderer.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "peer.hpp"
#include "raster.hpp"

namespace vsplit::bench {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::vector<std::string> files;
    std::vector<double> ratios{0.5, 0.25, 0.1};
    std::string command, markdown, pictures;
    std::string flags;
    int views = 24, size = 640;
    double time = 0.4;
    bool all_peers = false, moves = false;
};

/// How a level differs from the full scene, means over all views.
struct Difference {
    std::size_t triangles = 0;
    double color = 0;     ///< Mean absolute, of the whole picture, times 255.
    double rms = 0;       ///< Root of the mean square of the same.
    double texcoord = 0;  ///< Of pixels where both show the same material; each at most kFar.
    double normal = 0;    ///< Degrees, of the same pixels.
};
constexpr double kFar = 0.1;

Difference compare(const View& full, const View& level) {
    Difference out;
    const int half = full.size / 2;
    std::size_t both = 0;
    const auto mean = [&](const View& view, int x, int y, std::size_t k) {
        double sum = 0;
        for (const int dy : {0, 1})
            for (const int dx : {0, 1})
                sum += double(view.colors[std::size_t((2 * y + dy) * view.size + 2 * x + dx)][k]) / 4;
        return sum;
    };
    for (int y = 0; y < half; ++y)
        for (int x = 0; x < half; ++x)
            for (std::size_t k = 0; k < 3; ++k) {
                const double d = std::abs(mean(full, x, y, k) - mean(level, x, y, k));
                out.color += d;
                out.rms += d * d;
            }
    out.color *= 255.0 / (3.0 * half * half);
    out.rms *= 255.0 * 255.0 / (3.0 * half * half);
    for (std::size_t i = 0; i < full.colors.size(); ++i) {
        if (full.materials[i] == -2 || full.materials[i] != level.materials[i]) continue;
        ++both;
        const double du = double(full.uvs[i][0]) - double(level.uvs[i][0]),
                     dv = double(full.uvs[i][1]) - double(level.uvs[i][1]);
        out.texcoord += std::min(kFar, std::hypot(du, dv));
        double cosine = 0;
        for (std::size_t k = 0; k < 3; ++k)
            cosine += double(full.normals[i][k]) * double(level.normals[i][k]);
        out.normal += std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
    }
    if (both > 0) {
        out.texcoord /= double(both);
        out.normal /= double(both);
    }
    return out;
}

/// A scene's full pictures, against which its levels are held.
class Judge {
  public:
    Judge(const Scene& scene, const Options& options)
        : options_(options), views_(std::size_t(options.views)) {
        const Soup soup = pose(scene);
        around_ = bounds_of(soup);
        tbb::parallel_for(0, options.views, [&](int i) {
            views_[std::size_t(i)] = render(scene, soup, around_, i, options.views, options.size);
        });
    }
    Difference look(const Scene& level, std::vector<View>* kept = nullptr) const {
        const Soup soup = pose(level);
        std::vector<Difference> parts(views_.size());
        if (kept) kept->resize(views_.size());
        tbb::parallel_for(0, options_.views, [&](int i) {
            View view = render(level, soup, around_, i, options_.views, options_.size);
            parts[std::size_t(i)] = compare(views_[std::size_t(i)], view);
            if (kept) (*kept)[std::size_t(i)] = std::move(view);
        });
        Difference sum;
        const double n = options_.views;
        for (const Difference& d : parts) {
            sum.color += d.color / n;
            sum.rms += d.rms / n;
            sum.texcoord += d.texcoord / n;
            sum.normal += d.normal / n;
        }
        sum.rms = std::sqrt(sum.rms);
        sum.triangles = level.triangles();
        return sum;
    }
    const std::vector<View>& views() const { return views_; }

  private:
    const Options& options_;
    Sphere around_;
    std::vector<View> views_;
};

/// Ours, through the command as a user has it: one GLB a level.
std::vector<Scene> our_levels(const std::string& file, const Options& options, const std::string& folder) {
    std::string ratios;
    for (const double r : options.ratios) ratios += fmt::format("{}{}", ratios.empty() ? "" : ",", r);
    const std::string stem = folder + "/ours";
    const std::string command = fmt::format("'{}' lods '{}' --separate --ratios {} {} -q -f -o '{}.glb'",
                                            options.command, file, ratios, options.flags, stem);
    if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
    std::vector<Scene> levels;
    for (std::size_t i = 0; i < options.ratios.size(); ++i)
        levels.push_back(load_scene(fmt::format("{}-lod{}.glb", stem, i), options.time));
    return levels;
}

struct Row {
    std::string model;
    double ratio;
    Difference ours, theirs;
    std::string settings;
};

double mean_ratio(const std::vector<Row>& rows, double Difference::*what) {
    double sum = 0;
    std::size_t n = 0;
    for (const Row& row : rows) {
        if (!(row.theirs.*what > 0) || !(row.ours.*what > 0)) continue;
        sum += std::log(row.ours.*what / (row.theirs.*what));
        ++n;
    }
    return n > 0 ? std::exp(sum / double(n)) : 1;
}

std::string table(const std::vector<Row>& rows) {
    std::string out =
        "| scene | ratio | triangles, ours / theirs | difference, ours / theirs | RMS | texture | normals | "
        "their weights |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const Row& r : rows)
        out += fmt::format(
            "| {} | {} % | {} / {} | {:.3f} / {:.3f} = {:.2f} | {:.2f} | {:.4f} / {:.4f} | {:.2f} / {:.2f} | "
            "{} |\n",
            r.model, 100 * r.ratio, r.ours.triangles, r.theirs.triangles, r.ours.color, r.theirs.color,
            r.ours.color / r.theirs.color, r.ours.rms / r.theirs.rms, r.ours.texcoord, r.theirs.texcoord,
            r.ours.normal, r.theirs.normal, r.settings);
    out += fmt::format(
        "| **geometric mean of ours over theirs** | | | **{:.3f}** | **{:.3f}** | **{:.3f}** | **{:.3f}** | "
        "|\n",
        mean_ratio(rows, &Difference::color), mean_ratio(rows, &Difference::rms),
        mean_ratio(rows, &Difference::texcoord), mean_ratio(rows, &Difference::normal));
    return out;
}

int run(const Options& options) {
    const std::string folder = fs::temp_directory_path() / fmt::format("vsplit-bench-assets-{}", ::getpid());
    fs::create_directories(folder);
    std::vector<PeerSettings> peers{{"0.5, 0.5", 0.5f, 0.5f, 0.5f, 0.5f, options.moves}};
    if (options.all_peers) {
        peers.push_back({"0.5, 0", 0.5f, 0, 0.5f, 0.5f, options.moves});
        peers.push_back({"1, 1", 1, 1, 1, 1, options.moves});
        peers.push_back({"0.2, 2", 0.2f, 2, 1, 1, options.moves});
    }
    std::vector<Row> rows;
    for (const std::string& file : options.files) {
        const std::string name = fs::path(file).stem();
        const Scene scene = load_scene(file, options.time);
        const Judge judge(scene, options);
        const std::vector<Scene> ours = our_levels(file, options, folder);
        std::vector<std::vector<Scene>> theirs;
        for (const PeerSettings& settings : peers)
            theirs.push_back(simplify_by_peer(scene, options.ratios, settings, folder));
        for (std::size_t i = 0; i < options.ratios.size(); ++i) {
            std::vector<View> our_views, their_views;
            Row row{name, options.ratios[i], judge.look(ours[i], &our_views), {}, {}};
            for (std::size_t p = 0; p < peers.size(); ++p) {
                std::vector<View> views;
                const Difference d = judge.look(theirs[p][i], &views);
                if (p > 0 && d.color >= row.theirs.color) continue;
                row.theirs = d;
                row.settings = peers[p].name;
                their_views = std::move(views);
            }
            rows.push_back(row);
            fmt::print(
                "{:18} {:4} %: {:6} / {:6} triangles, difference {:6.3f} / {:6.3f} = {:.3f}, rms {:.3f}, "
                "texture {:.3f}, normals {:.3f}  ({})\n",
                name, 100 * row.ratio, row.ours.triangles, row.theirs.triangles, row.ours.color,
                row.theirs.color, row.ours.color / row.theirs.color, row.ours.rms / row.theirs.rms,
                row.theirs.texcoord > 0 ? row.ours.texcoord / row.theirs.texcoord : 1,
                row.ours.normal / row.theirs.normal, row.settings);
            std::fflush(stdout);
            if (!options.pictures.empty()) {
                const auto v = std::size_t(options.views / 3);
                write_pictures(fmt::format("{}/{}-{}.ppm", options.pictures, name, 100 * row.ratio),
                               {&judge.views()[v], &our_views[v], &their_views[v], &judge.views()[2 * v],
                                &our_views[2 * v], &their_views[2 * v]});
            }
        }
    }
    fs::remove_all(folder);
    fmt::print("geometric means: difference {:.3f}, rms {:.3f}, texture {:.3f}, normals {:.3f}\n",
               mean_ratio(rows, &Difference::color), mean_ratio(rows, &Difference::rms),
               mean_ratio(rows, &Difference::texcoord), mean_ratio(rows, &Difference::normal));
    if (!options.markdown.empty()) {
        std::ofstream file(options.markdown);
        file << "# Levels as rendered, against meshoptimizer\n\n"
                "Written by `./run bench assets`; sources in `tests/bench/assets`. Each scene is cut to a "
                "ratio "
                "of its triangles, by `vsplit lods --separate` (the whole scene, one order) and by "
                "meshoptimizer's `"
             << (options.moves ? "simplifyWithUpdate" : "simplifyWithAttributes")
             << "` (npm, version in `tests/bench/assets/package.json`; each primitive, no flags). Both, and "
                "the "
                "full scene, are drawn by one software renderer, textured and lit, animated ones in "
                "mid-motion, "
             << fmt::format("from {} directions at {} x {} pixels.\n\n", options.views, options.size / 2,
                            options.size / 2)
             << "- Difference: mean of |level - full| over all pixels and channels, of 255. Less is better, "
                "here and below. The aim is 0.9 in the geometric mean. RMS: the same of squares.\n"
                "- Texture: how far texture coordinates are off, pixel by pixel where both show the same "
                "material, at most 0.1 each. Normals: the angle between them, degrees.\n"
                "- Their weights (normals and colours; texture coordinates"
             << (options.all_peers ? "): of four settings the one that does best on the case."
                                   : "): 0.5 for normals is what the library's own demo has; `--all-peers` "
                                     "takes the best of "
                                     "four settings, case by case, `--moves` lets them move vertices.")
             << "\n- Duck, CesiumMan and 2CylinderEngine are Khronos's samples; spot is Keenan Crane's cow; "
                "the "
                "others are made by `scenes.py`.\n\n"
             << table(rows);
    }
    return 0;
}

}  // namespace
}  // namespace vsplit::bench

int main(int argc, char** argv) {
    vsplit::bench::Options options;
    CLI::App app{"Levels of scenes with attributes against meshoptimizer's, as rendered"};
    app.add_option("files", options.files, "GLBs")->required()->check(CLI::ExistingFile);
    app.add_option("--command", options.command, "vsplit")->required();
    app.add_option("--ratios", options.ratios, "Triangles kept")->delimiter(',')->capture_default_str();
    app.add_option("--views", options.views)->capture_default_str();
    app.add_option("--size", options.size, "Pixels a side, before they are halved")->capture_default_str();
    app.add_option("--time", options.time, "Pose: share of the animation")->capture_default_str();
    app.add_option("--flags", options.flags, "More options for vsplit lods");
    app.add_flag("--all-peers", options.all_peers, "The best of several settings of the peer, case by case");
    app.add_flag("--moves", options.moves, "The peer may move vertices (simplifyWithUpdate)");
    app.add_option("--pictures", options.pictures, "A folder for pictures: full, ours, theirs; twice");
    app.add_option("--markdown", options.markdown, "Where the table goes");
    CLI11_PARSE(app, argc, argv);
    try {
        return vsplit::bench::run(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "bench assets: {}\n", error.what());
        return 1;
    }
}
