// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// vsplit_bench_format: what .pmesh costs in bytes and time, against Draco, a chain of Draco levels, and
// gltfpack.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "figures.hpp"
#include "plot.hpp"
#include "report.hpp"
#include "vsplit/bake/files.hpp"

namespace {

using namespace vsplit::bench;

struct Options {
    std::vector<std::string> files, speed, only;
    std::string json, markdown, gltfpack;
};

bool write(const std::string& path, const std::string& text) {
    const auto status = vsplit::bake::write_file(path, std::as_bytes(std::span(text)), true);
    if (!status.ok()) fmt::print(stderr, "vsplit_bench_format: {}: {}\n", path, status.error().describe());
    return status.ok();
}

/// The figures of an earlier run, for the parts that this one leaves out.
bool recall(const std::string& path, Figures& figures) {
    if (!std::filesystem::exists(path)) return true;
    const auto bytes = vsplit::bake::read_file(path);
    if (!bytes) return false;
    try {
        const auto* text = reinterpret_cast<const char*>(bytes->data());
        figures = nlohmann::json::parse(text, text + bytes->size()).get<Figures>();
    } catch (const nlohmann::json::exception& error) {
        fmt::print(stderr, "vsplit_bench_format: {}: {}\n", path, error.what());
        return false;
    }
    return true;
}

/// Two models a picture, next to the page.
std::vector<std::string> write_plots(const Figures& figures, const std::filesystem::path& folder, bool& ok) {
    std::vector<std::string> names;
    const std::span<const ModelSizes> all(figures.sizes);
    for (std::size_t i = 0; i < all.size(); i += 2) {
        const auto models = all.subspan(i, std::min<std::size_t>(2, all.size() - i));
        std::string name = "format-rd";
        for (const ModelSizes& m : models) name += "-" + m.model;
        names.push_back(name + ".svg");
        ok = write((folder / names.back()).string(), plot_rate_distortion(models)) && ok;
    }
    return names;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("The file format's bytes and time against Draco's and gltfpack's.", "vsplit_bench_format");
    app.add_option("file", options.files, "Models to measure")->required()->check(CLI::ExistingFile);
    app.add_option("--speed", options.speed, "A model to measure speed on; may be repeated")
        ->check(CLI::ExistingFile);
    app.add_option("--only", options.only, "Parts to measure; may be repeated")
        ->check(CLI::IsMember({"size", "speed"}));
    app.add_option("--json", options.json,
                   "Write all figures to this file; what this run leaves out is taken from it");
    app.add_option("--markdown", options.markdown, "Write the page to this file, and plots next to it");
    app.add_option("--gltfpack", options.gltfpack, "The command gltfpack");
    CLI11_PARSE(app, argc, argv);
    const auto wants = [&](const char* part) {
        return options.only.empty() ||
               std::find(options.only.begin(), options.only.end(), part) != options.only.end();
    };

    Figures figures;
    if (!options.json.empty() && !options.only.empty() && !recall(options.json, figures)) return 4;
    bool ok = true;
    const auto failed = [&](const std::string& path, const vsplit::Error& error) {
        fmt::print(stderr, "vsplit_bench_format: {}: {}\n", path, error.describe());
        ok = false;
    };
    if (wants("size")) {
        figures.sizes_on = describe_machine();
        figures.sizes.clear();
        const std::string version =
            options.gltfpack.empty() ? std::string() : gltfpack_version(options.gltfpack);
        figures.gltfpack = version.empty() ? "**missing**: `npm install` has not brought it" : version;
        if (version.empty()) {
            fmt::print(stderr, "vsplit_bench_format: gltfpack does not run: left out\n");
            options.gltfpack.clear();
        }
        for (const std::string& file : options.files) {
            fmt::print(stderr, "{}: sizes\n", file);
            auto sizes = measure_sizes(file, options.gltfpack);
            if (sizes)
                figures.sizes.push_back(std::move(*sizes));
            else
                failed(file, sizes.error());
        }
    }
    if (wants("speed") && !options.speed.empty()) {
        figures.speeds_on = describe_machine();
        for (const std::string& file : options.speed) {
            fmt::print(stderr, "{}: speed\n", file);
            const auto speeds = measure_speeds(file);
            if (!speeds) {
                failed(file, speeds.error());
                continue;
            }
            // Models may be timed in different runs, each of them short.
            std::erase_if(figures.speeds, [&](const Speeds& s) { return s.model == speeds->front().model; });
            figures.speeds.insert(figures.speeds.end(), speeds->begin(), speeds->end());
        }
    }
    if (!options.json.empty()) ok = write(options.json, nlohmann::json(figures).dump(1) + "\n") && ok;
    std::vector<std::string> plots;
    if (!options.markdown.empty())
        plots = write_plots(figures, std::filesystem::path(options.markdown).parent_path(), ok);
    const std::string page = to_markdown(figures, plots);
    fmt::print("{}", page);
    if (!options.markdown.empty()) ok = write(options.markdown, page) && ok;
    return ok ? 0 : 1;
}
