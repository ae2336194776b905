// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "mark_flags.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "vsplit/bake/files.hpp"

namespace vsplit::app {
namespace {

/// What is painted and not marked by regions.
constexpr const char* kPainted = "painted";

struct RegionWeight {
    std::string name;
    std::optional<double> weight;
};

std::optional<RegionWeight> parse_region(const std::string& text) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0) return std::nullopt;
    RegionWeight region{text.substr(0, equals), std::nullopt};
    const std::string value = text.substr(equals + 1);
    if (value == "auto") return region;
    double weight = 0;
    const auto [last, problem] = std::from_chars(value.data(), value.data() + value.size(), weight);
    if (problem != std::errc() || last != value.data() + value.size() || !(weight >= 0)) return std::nullopt;
    region.weight = weight;
    return region;
}

/// The region of what weighs more than 1.
bake::Marks painted(const Mesh& mesh) {
    bake::Marks marks = bake::no_marks(mesh.positions.size());
    bake::Region region;
    region.name = kPainted;
    for (std::size_t v = 0; v < mesh.weights.size(); ++v) marks.region[v] = mesh.weights[v] > 1;
    marks.regions.push_back(region);
    return marks;
}

}  // namespace

void MarkFlags::add_to(CLI::App& command) {
    const char* group = "Regions";
    command
        .add_option(
            "--marks", marks,
            "Marked regions: a text file of regions and of each vertex's region, as the studio saves it")
        ->type_name("FILE")
        ->group(group);
    command
        .add_option(
            "--region", regions,
            "NAME=WEIGHT: a region's weight, a number, inf, or auto; may be repeated. Without --marks, "
            "what --weights paints above 1 is region 'painted'")
        ->type_name("NAME=WEIGHT")
        ->allow_extra_args(false)
        ->group(group);
    command
        .add_flag(
            "--auto-weights", automatic,
            "All regions get the automatic weight, from the mesh's own range of errors (docs/studio.md)")
        ->group(group);
    command
        .add_option(
            "--keep", keeps,
            "REGION=95%@40%: search the weight that keeps 95 % of the region's vertices where 40 % of "
            "the triangles are left; may be repeated")
        ->type_name("REGION=SHARE@RATIO")
        ->allow_extra_args(false)
        ->group(group);
}

std::optional<std::string> MarkFlags::fault() const {
    for (const std::string& keep : keeps)
        if (!bake::parse_keep(keep)) return "--keep wants REGION=SHARE@RATIO, as head=95%@40%, not " + keep;
    for (const std::string& region : regions)
        if (!parse_region(region))
            return "--region wants NAME=WEIGHT, a number of 0 or more, inf or auto, not " + region;
    return std::nullopt;
}

Result<MarkReport> apply_marks(const MarkFlags& flags, const std::string& input, Mesh& mesh,
                               std::span<const std::uint32_t> vertex_of, std::size_t file_vertices,
                               const bake::CollapseOptions& options, const bake::Progress& progress,
                               int& exit) {
    const auto failed = [&](const std::string& file, const Error& error) {
        exit = fail_input(file, error);
        return error;
    };
    const auto refuse = [&](std::string message) {
        return failed(input, {ErrorCode::kArgument, std::move(message), Error::kNowhere, 0});
    };
    bake::Marks marks;
    if (flags.marks.empty()) {
        marks = painted(mesh);
    } else {
        auto text = bake::read_file(flags.marks);
        if (!text) return failed(flags.marks, text.error());
        auto of_file = bake::parse_marks(*text, file_vertices);
        if (!of_file) return failed(flags.marks, of_file.error());
        marks = bake::marks_of_mesh(*of_file, vertex_of, mesh.positions.size());
    }
    MarkReport report;
    for (bake::Region& region : marks.regions)
        if (flags.automatic || flags.marks.empty()) region.weight.reset();
    for (const std::string& text : flags.regions) {
        const RegionWeight wanted = *parse_region(text);
        const auto it = std::find_if(marks.regions.begin(), marks.regions.end(),
                                     [&](const bake::Region& region) { return region.name == wanted.name; });
        if (it == marks.regions.end()) return refuse("there is no region " + wanted.name);
        it->weight = wanted.weight;
    }
    for (std::size_t r = 0; r < marks.regions.size(); ++r) {
        MarkReport::Line line;
        line.name = marks.regions[r].name;
        line.automatic = !marks.regions[r].weight;
        line.vertices = std::size_t(std::count(marks.region.begin(), marks.region.end(), r + 1));
        report.regions.push_back(line);
    }
    if (flags.marks.empty() && report.regions[0].vertices == 0)
        return refuse("nothing is painted: --auto-weights, --region and --keep want --marks or --weights");
    std::vector<bake::Keep> wishes;
    for (const std::string& text : flags.keeps) wishes.push_back(*bake::parse_keep(text));
    if (!wishes.empty()) {
        auto found = bake::find_weights(mesh, marks, wishes, options, progress);
        if (!found) return failed(input, found.error());
        for (std::size_t i = 0; i < wishes.size(); ++i)
            for (MarkReport::Line& line : report.regions)
                if (line.name == wishes[i].region) {
                    line.automatic = false;
                    line.searched = true;
                    line.share = (*found)[i].share;
                    line.ratio = wishes[i].ratio;
                    line.bakes = (*found)[i].bakes;
                }
    }
    report.automatic = bake::automatic_weights(bake::edge_errors(mesh));
    const double factor = report.automatic.factor();
    for (std::size_t r = 0; r < marks.regions.size(); ++r)
        report.regions[r].weight = marks.regions[r].weight.value_or(factor);
    mesh.weights = bake::weights_of(marks, factor);
    return report;
}

Json MarkReport::json() const {
    Json list = Json::array();
    for (const Line& line : regions) {
        Json one = {{"name", line.name}, {"vertices", line.vertices}};
        // JSON has no infinity.
        if (std::isinf(line.weight))
            one["weight"] = "inf";
        else
            one["weight"] = line.weight;
        one["automatic"] = line.automatic;
        if (line.searched)
            one["kept"] = {{"share", line.share}, {"ratio", line.ratio}, {"bakes", line.bakes}};
        list.push_back(one);
    }
    return {{"regions", list},
            {"automatic",
             {{"smallest_error", automatic.errors.smallest},
              {"median_error", automatic.errors.median},
              {"largest_error", automatic.errors.largest},
              {"initial_weight", automatic.initial},
              {"mark_weight", automatic.mark}}}};
}

std::vector<std::string> MarkReport::describe() const {
    std::vector<std::string> lines;
    for (const Line& line : regions) {
        std::string text =
            fmt::format("region {}: {} vertices, weight {}{}", line.name, with_commas(line.vertices),
                        short_number(line.weight), line.automatic ? " (automatic)" : "");
        if (line.searched)
            text += fmt::format(
                ", which keeps {:.1f} % at {:.1f} % of the triangles ({} records made to find it)",
                100 * line.share, 100 * line.ratio, line.bakes);
        lines.push_back(text);
    }
    return lines;
}

}  // namespace vsplit::app
