// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// vsplit_bench_simplify: vsplit's engine against its peers, same input, same ruler, same run.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "report.hpp"
#include "vsplit/bake/files.hpp"

namespace {

using namespace vsplit::bench;

struct Options {
    std::vector<std::string> files;
    std::string corpus = VSPLIT_CORPUS;
    std::string json, markdown, resume;
    std::vector<std::string> only, peers;
    std::size_t samples = 0;
    bool quick = false;
};

bool write(const std::string& path, const std::string& text) {
    const auto status = vsplit::bake::write_file(path, std::as_bytes(std::span(text)), true);
    if (!status) fmt::print(stderr, "vsplit_bench_simplify: {}: {}\n", path, status.error().describe());
    return status.ok();
}

std::string parts_of(const Report& report) {
    std::string parts;
    const auto add = [&](bool there, const char* part) {
        if (there) parts += (parts.empty() ? "" : ", ") + std::string(part);
    };
    add(!report.quality.empty(), "quality");
    add(report.speed.has_value(), "speed");
    add(!report.calibration.empty(), "calibration");
    add(!report.weights.empty(), "weights");
    return parts;
}

/// Takes the parts that an earlier run with --json has measured: on this machine, of these models, with as
/// many samples; the page then names that commit too. Says why not, if not.
std::string take_measured(const std::string& path, Report& report) {
    const auto bytes = vsplit::bake::read_file(path);
    if (!bytes) return bytes.error().describe();
    try {
        const Json json = Json::parse(bytes->begin(), bytes->end());
        const Machine machine = json.at("machine");
        if (machine.cpu != report.machine.cpu) return "of another machine";
        if (json.at("models") != report.models || json.at("samples") != report.samples)
            return "of other models or samples";
        json.at("quality").get_to(report.quality);
        json.at("calibration").get_to(report.calibration);
        if (json.contains("weights")) json["weights"].get_to(report.weights);
        if (json.contains("speed")) report.speed = json["speed"].get<Speed>();
        if (machine.commit != report.machine.commit)
            report.machine.commit += fmt::format("; {}: {}", machine.commit, parts_of(report));
    } catch (const Json::exception& error) {
        return error.what();
    }
    return {};
}

/// How to repeat it: the options that change figures, without this machine's folders.
std::string command_of(const Options& options) {
    std::string command = "./run bench simplify";
    if (options.quick) command += " --quick";
    if (options.samples) command += fmt::format(" --samples {}", options.samples);
    for (const std::string& part : options.only) command += " --only " + part;
    for (const std::string& peer : options.peers) command += fmt::format(" --peer '{}'", peer);
    for (const std::string& file : options.files) command += " " + file.substr(file.find_last_of('/') + 1);
    return command;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("vsplit's simplification against its peers: the same input, the same ruler, the same run.",
                 "vsplit_bench_simplify");
    app.add_option("file", options.files, "Models to measure; the last for speed too (default: the corpus)");
    app.add_option("--corpus", options.corpus, "Folder that has meshes/stanford-bunny.obj and the others")
        ->capture_default_str();
    app.add_option("--json", options.json, "Write all figures to this file");
    app.add_option("--markdown", options.markdown, "Write the page to this file too");
    app.add_option("--only", options.only, "Parts to measure; may be repeated")
        ->check(CLI::IsMember({"quality", "speed", "calibration", "weights"}));
    app.add_option("--resume", options.resume,
                   "Take the parts that a run with --json measured from that file, measure the others: the "
                   "machine need be quiet for speed alone")
        ->check(CLI::ExistingFile);
    app.add_option("--peer", options.peers, "Peers to run, by name, may be repeated (default: all)");
    app.add_option("--samples", options.samples, "Of the ruler, on each mesh (default: 100000; quick: 40000)")
        ->check(CLI::Range(1, 100'000'000));
    app.add_flag("--quick", options.quick, "Smaller models, fewer runs");
    CLI11_PARSE(app, argc, argv);

    const auto chosen = [&](const char* part) {
        return options.only.empty() ||
               std::find(options.only.begin(), options.only.end(), part) != options.only.end();
    };
    const ModelSet models = choose_models(options.files, options.corpus, options.quick);
    fmt::print(stderr, "models: {}\n", models.said);
    Report report;
    report.machine = describe_machine();
    report.command = command_of(options);
    report.models = models.said;
    report.samples = options.samples ? options.samples : options.quick ? 40'000 : 100'000;
    report.peers = all_peers();
    for (const std::string& name : options.peers)
        if (std::none_of(report.peers.begin(), report.peers.end(),
                         [&](const Peer& p) { return p.name == name; })) {
            fmt::print(stderr, "vsplit_bench_simplify: no peer is called {}\n", name);
            return 2;
        }
    for (Peer& peer : report.peers) {
        const bool named =
            options.peers.empty() || peer.name == "vsplit" ||
            std::find(options.peers.begin(), options.peers.end(), peer.name) != options.peers.end();
        if (!named && peer.missing.empty()) peer.missing = "left out on the command line";
        if (!peer.missing.empty()) fmt::print(stderr, "{}: {}\n", peer.name, peer.missing);
    }
    vsplit::ruler::RulerOptions ruler;
    ruler.samples = report.samples;
    if (!options.resume.empty())
        if (const std::string fault = take_measured(options.resume, report); !fault.empty()) {
            fmt::print(stderr, "vsplit_bench_simplify: {}: {}\n", options.resume, fault);
            return 4;
        }
    if (chosen("quality") && report.quality.empty())
        for (const Model& model : models.quality)
            report.quality.push_back(measure_quality(model, report.peers, ruler, options.quick));
    if (chosen("speed") && !report.speed)
        report.speed = measure_speed(models.speed, report.peers, options.quick);
    if (chosen("calibration") && report.calibration.empty())
        for (const Model& model : models.quality)
            report.calibration.push_back(measure_calibration(model, ruler));
    if (chosen("weights") && report.weights.empty())
        for (const Model& model : models.quality) report.weights.push_back(measure_weights(model, ruler));

    const std::string page = to_markdown(report);
    fmt::print("{}", page);
    bool written = options.markdown.empty() || write(options.markdown, page);
    if (!options.json.empty()) written = write(options.json, to_json(report).dump(1) + "\n") && written;
    if (!written) return 4;
    // A bench that measured nothing of ours has failed.
    const bool ours = std::all_of(report.quality.begin(), report.quality.end(), [](const ModelQuality& m) {
        return m.reason.empty() && m.runs.front().reason.empty();
    });
    return ours && (!report.speed || (report.speed->reason.empty() && report.speed->record.reason.empty()))
               ? 0
               : 1;
}
