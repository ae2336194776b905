// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>

#include "command.hpp"
#include "vsplit/bake/files.hpp"

namespace vsplit::app {
namespace {

struct InfoCommand {
    Common common;
    std::string input;
    int run() const;
};

Json to_json(const FileInfo& info) {
    Json blocks = Json::array();
    for (const BlockInfo& b : info.blocks)
        blocks.push_back({{"offset", b.offset},
                          {"bytes", b.bytes},
                          {"checksum", fmt::format("{:016x}", b.checksum)},
                          {"splits", b.splits_end},
                          {"vertices", b.vertices_end},
                          {"triangles", b.triangles_end},
                          {"error", b.error}});
    Json attributes = Json::array();
    for (const AttributeInfo& a : info.attributes)
        attributes.push_back({{"name", a.name}, {"components", a.components}, {"exact", a.exact}});
    const auto point = [](const Float3& p) { return Json::array({p.x, p.y, p.z}); };
    return {{"version", info.version},
            {"bytes", info.file_bytes},
            {"vertices", info.vertices},
            {"triangles", info.triangles},
            {"splits", info.splits},
            {"weights", info.has_weights},
            {"lossless", info.lossless},
            {"position_bits", info.position_bits},
            {"position_step", info.position_step},
            {"attributes", attributes},
            {"bounds", {{"min", point(info.bounds_min)}, {"max", point(info.bounds_max)}}},
            {"base",
             {{"offset", info.base_offset},
              {"bytes", info.base_bytes},
              {"vertices", info.base_vertices},
              {"triangles", info.base_triangles},
              {"error", info.base_error}}},
            {"blocks", blocks}};
}

int InfoCommand::run() const {
    auto bytes = bake::read_file(input);
    if (!bytes) return fail_input(input, bytes.error());
    Limits limits;
    limits.max_bytes = std::uint64_t{1} << 36;
    auto info = read_info(*bytes, limits);
    if (!info) return fail_input(input, info.error());
    if (bytes->size() != info->file_bytes)
        return fail_input(
            input,
            {bytes->size() < info->file_bytes ? ErrorCode::kTruncated : ErrorCode::kMalformed,
             fmt::format("the file has {} bytes, its header announces {}", bytes->size(), info->file_bytes),
             std::min<std::uint64_t>(bytes->size(), info->file_bytes), 0});
    if (common.quiet) return kDone;
    if (common.json) {
        print_json(to_json(*info));
        return kDone;
    }
    say(common,
        fmt::format("{}: .pmesh version {}, {} bytes", input, info->version, with_commas(info->file_bytes)));
    say(common, fmt::format("  {} triangles, {} vertices, {} splits{}", with_commas(info->triangles),
                            with_commas(info->vertices), with_commas(info->splits),
                            info->has_weights ? ", painted weights" : ""));
    say(common, info->lossless ? std::string("  lossless")
                               : fmt::format("  places on a lattice of {} bits, step {}", info->position_bits,
                                             short_number(info->position_step)));
    for (const AttributeInfo& a : info->attributes)
        say(common,
            fmt::format("  attribute {}: {} components{}", a.name, a.components, a.exact ? ", exact" : ""));
    say(common, fmt::format("  bounds ({}, {}, {}) to ({}, {}, {})", info->bounds_min.x, info->bounds_min.y,
                            info->bounds_min.z, info->bounds_max.x, info->bounds_max.y, info->bounds_max.z));
    say(common, fmt::format("  {:>5}  {:>11} {:>9}  {:>11} {:>11}  {:>9}", "block", "offset", "bytes",
                            "vertices", "triangles", "error after"));
    say(common,
        fmt::format("  {:>5}  {:>11} {:>9}  {:>11} {:>11}  {:>9}", "base", with_commas(info->base_offset),
                    with_commas(info->base_bytes), with_commas(info->base_vertices),
                    with_commas(info->base_triangles), short_number(double(info->base_error))));
    for (std::size_t i = 0; i < info->blocks.size(); ++i) {
        const BlockInfo& b = info->blocks[i];
        say(common, fmt::format("  {:>5}  {:>11} {:>9}  {:>11} {:>11}  {:>9}", i, with_commas(b.offset),
                                with_commas(b.bytes), with_commas(b.vertices_end),
                                with_commas(b.triangles_end), short_number(double(b.error))));
    }
    return kDone;
}

}  // namespace

void add_info(CLI::App& app, int& exit) {
    auto command = std::make_shared<InfoCommand>();
    CLI::App* sub = app.add_subcommand("info", "Say what a .pmesh holds, from its header and table alone");
    sub->footer("Example:\n  vsplit info bunny.pmesh --json");
    sub->add_option("input", command->input, "The .pmesh")->required()->type_name("FILE");
    command->common.add_to(*sub);
    sub->callback([command, &exit] { exit = command->run(); });
}

}  // namespace vsplit::app
