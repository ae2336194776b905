// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <span>

#include "command.hpp"
#include "model.hpp"

namespace vsplit::app {
namespace {

struct InfoCommand {
    Common common;
    std::string input;
    bool annotate = false;
    int run() const;
    /// A record that is not sound makes it bad input.
    int show_manyfold(const bake::ManyfoldFile& file) const;
};

/// A line a field: offset, bytes, type, value, meaning, as in formats/spec/pmesh-1.md.
class Annotation {
  public:
    explicit Annotation(std::span<const std::byte> bytes) : bytes_(bytes) {
        fmt::print("{:>10} {:>8}  {:<5}  {:<24}  {}\n", "offset", "bytes", "type", "value", "meaning");
    }
    template <class T>
    void field(const char* type, const std::string& meaning) {
        T value;
        std::memcpy(&value, bytes_.data() + at_, sizeof(T));
        line(sizeof(T), type, fmt::format("{}", value), meaning);
    }
    void u8(const std::string& meaning) { field<std::uint8_t>("u8", meaning); }
    void u16(const std::string& meaning) { field<std::uint16_t>("u16", meaning); }
    void u32(const std::string& meaning) { field<std::uint32_t>("u32", meaning); }
    void f32(const std::string& meaning) { field<float>("f32", meaning); }
    void f64(const std::string& meaning) { field<double>("f64", meaning); }
    void checksum(const std::string& meaning) {
        std::uint32_t value;
        std::memcpy(&value, bytes_.data() + at_, sizeof(value));
        line(4, "u32", fmt::format("{:08x}", value), "checksum of " + meaning);
    }
    /// Of seven bits a byte.
    void number(const std::string& meaning) {
        std::uint64_t value = 0, size = 0;
        do {
            value |= std::uint64_t{next_byte(size) & 127} << (7 * size);
        } while (next_byte(size++) & 128);
        line(size, "num", fmt::format("{}", value), meaning);
    }
    void text(std::size_t size, const std::string& meaning) {
        std::string value;
        for (std::size_t i = 0; i < size; ++i) {
            const char c = static_cast<char>(bytes_[at_ + i]);
            value += c >= ' ' && c < 127 ? std::string(1, c)
                                         : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
        }
        line(size, "text", value, meaning);
    }
    void part(std::uint64_t size, const std::string& meaning) { line(size, "bytes", "", meaning); }
    std::uint64_t at() const { return at_; }
    std::uint32_t next_byte(std::size_t ahead) const { return std::uint32_t(bytes_[at_ + ahead]); }
    std::uint32_t next_u16() const { return next_byte(0) | next_byte(1) << 8; }

  private:
    void line(std::uint64_t size, const char* type, const std::string& value, const std::string& meaning) {
        fmt::print("{:>10} {:>8}  {:<5}  {:<24}  {}\n", at_, size, type, value, meaning);
        at_ += size;
    }
    std::span<const std::byte> bytes_;
    std::uint64_t at_ = 0;
};

/// `info` is what read_info() said of these bytes, so every field is there.
void annotate_file(std::span<const std::byte> bytes, const FileInfo& info) {
    Annotation a(bytes);
    a.text(8, "magic");
    a.u32("version");
    a.u32("flags: 1 painted weights, 2 lossless");
    a.u32("vertices of the base mesh");
    a.u32("triangles of the base mesh");
    for (const char* what : {"least x", "least y", "least z", "greatest x", "greatest y", "greatest z"})
        a.f32(what);
    a.u32("bytes of the details");
    a.u32("bytes of the base mesh");
    a.u32("bytes of the base mesh that are Draco's");
    a.u32("bytes of the table");
    a.f32("geometric error of the base mesh");
    a.u32("largest group");
    a.u32("bits of the lattice, 0 if lossless");
    for (const char* what : {"lattice origin x", "lattice origin y", "lattice origin z", "lattice step"})
        a.f64(what);
    for (const char* what : {"the details", "the base mesh", "the table", "the header"}) a.checksum(what);
    const std::uint32_t kinds = a.next_byte(0);
    a.u8("what follows: weights of prediction of kinds 0 to 2, origin");
    for (std::uint32_t kind = 0; kind < 3; ++kind)
        if (kinds >> kind & 1) a.part(42, fmt::format("weights of prediction, kind {}", kind));
    for (const char* what : {"origin x", "origin y", "origin z"})
        if (kinds >> 3 & 1) a.f64(what);
    a.u16("attributes");
    for (const AttributeInfo& attribute : info.attributes) {
        const std::uint32_t components = a.next_byte(1), coding = a.next_byte(2);
        a.u8(attribute.name + ": semantic");
        a.u8(attribute.name + ": components");
        a.u8(attribute.name + ": coding");
        a.u8(attribute.name + ": bits");
        for (std::uint32_t c = 0; coding == 1 && c < components; ++c) {
            a.f64(fmt::format("{}: origin of component {}", attribute.name, c));
            a.f64(fmt::format("{}: step of component {}", attribute.name, c));
        }
        const std::uint32_t length = a.next_u16();
        a.u16(attribute.name + ": bytes of its name");
        a.text(length, attribute.name + ": name");
    }
    a.part(info.base_draco_bytes, "base mesh: Draco");
    a.part(info.base_bytes - info.base_draco_bytes, "base mesh: stream");
    a.number("table: blocks");
    for (std::size_t i = 0; i < info.blocks.size(); ++i) a.checksum(fmt::format("block {}", i));
    a.part(info.data_offset - a.at(), "table: stream");
    for (std::size_t i = 0; i < info.blocks.size(); ++i) {
        const BlockInfo& block = info.blocks[i];
        a.part(block.bytes,
               fmt::format("block {}: after it {} splits, {} vertices, {} triangles, error {}", i,
                           block.splits_end, block.vertices_end, block.triangles_end, block.error));
    }
}

Json to_json(const FileInfo& info) {
    Json blocks = Json::array();
    for (const BlockInfo& b : info.blocks)
        blocks.push_back({{"offset", b.offset},
                          {"bytes", b.bytes},
                          {"checksum", fmt::format("{:08x}", b.checksum)},
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
            {"origin", info.origin},
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

int InfoCommand::show_manyfold(const bake::ManyfoldFile& file) const {
    const ProgressiveMesh& mesh = file.mesh;
    const double error = error_at(mesh, 0);
    if (common.json && !common.quiet)
        print_json(
            {{"extension", "MANYFOLD_mesh_progressive"},
             {"records", file.records},
             {"sound", file.read},
             {"fault", file.fault},
             {"vertices", mesh.positions.size()},
             {"triangles", mesh.triangles.size()},
             {"base",
              {{"vertices", mesh.base_vertices}, {"triangles", mesh.base_triangles}, {"error", error}}}});
    say(common,
        fmt::format("{}: glTF with MANYFOLD_mesh_progressive, {} records", input, with_commas(file.records)));
    say(common, fmt::format("  {} triangles, {} vertices, from a base of {} triangles (error at most {})",
                            with_commas(mesh.triangles.size()), with_commas(mesh.positions.size()),
                            with_commas(mesh.base_triangles), short_number(error)));
    const auto note = manyfold_note(file);
    if (!note) return kDone;
    return fail_input(input, {ErrorCode::kMalformed, *note, Error::kNowhere, 0});
}

int InfoCommand::run() const {
    int exit = kDone;
    const auto file = read_stream_file(input, exit);
    if (!file) return exit;
    if (!file->carried && is_gltf(file->bytes, extension_of(input))) {
        const auto manyfold = load_manyfold(input, file->bytes, exit);
        if (!manyfold) return exit;
        if (*manyfold) return show_manyfold(**manyfold);
    }
    const auto bytes = file->stream();
    Limits limits;
    limits.max_bytes = std::uint64_t{1} << 36;
    auto info = read_info(bytes, limits);
    if (!info) return fail_input(input, info.error());
    if (bytes.size() != info->file_bytes)
        return fail_input(
            input,
            {bytes.size() < info->file_bytes ? ErrorCode::kTruncated : ErrorCode::kMalformed,
             fmt::format("the file has {} bytes, its table announces {}", bytes.size(), info->file_bytes),
             std::min<std::uint64_t>(bytes.size(), info->file_bytes), 0});
    if (common.quiet) return kDone;
    if (annotate) {
        annotate_file(bytes, *info);
        return kDone;
    }
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
    if (info->origin != std::array<double, 3>{})
        say(common, fmt::format("  origin ({}, {}, {}): add it for the source's coordinates", info->origin[0],
                                info->origin[1], info->origin[2]));
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
    CLI::App* sub = app.add_subcommand(
        "info",
        "Say what a .pmesh, or the progressive GLB around one, holds, from its header and table alone");
    sub->footer("Example:\n  vsplit info bunny.pmesh --json");
    sub->add_option("input", command->input, "The .pmesh or progressive GLB")->required()->type_name("FILE");
    sub->add_flag("--annotate", command->annotate, "Print every field: offset, bytes, type, value, meaning");
    command->common.add_to(*sub);
    sub->callback([command, &exit] { exit = command->run(); });
}

}  // namespace vsplit::app
