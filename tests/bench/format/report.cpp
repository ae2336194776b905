// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include "bar.hpp"
#include "draco_file.hpp"

namespace vsplit::bench {
namespace {

using Out = std::back_insert_iterator<std::string>;

/// A geometric mean, and the greatest with its name.
class Ratios {
  public:
    void add(double value, const std::string& name) {
        if (!(value > 0) || !std::isfinite(value)) return;
        logs_ += std::log(value);
        ++count_;
        if (value > worst_) worst_ = value, name_ = name;
    }
    bool any() const { return count_ > 0; }
    double mean() const {
        return count_ ? std::exp(logs_ / count_) : std::numeric_limits<double>::quiet_NaN();
    }
    double worst() const { return count_ ? worst_ : std::numeric_limits<double>::quiet_NaN(); }
    std::string told() const {
        return count_ ? fmt::format("{:.3f} (most {:.3f}: {})", mean(), worst_, name_) : "n/a";
    }

  private:
    double logs_ = 0, worst_ = 0;
    int count_ = 0;
    std::string name_;
};

std::string bits_name(int bits) {
    return bits ? fmt::format("{}", bits) : "lossless";
}

Ratios over_models(const Figures& f, const std::string& profile, int bits,
                   const std::function<double(const Size&)>& ratio) {
    Ratios ratios;
    for (const ModelSizes& m : f.sizes)
        for (const Profile& p : m.profiles)
            for (const Size& s : p.sizes)
                if (p.profile == profile && s.bits == bits) ratios.add(ratio(s), m.model);
    return ratios;
}

double over_draco(const Size& s) {
    return double(s.file) / double(s.draco_ten);
}
double over_chain(const Size& s) {
    return double(s.file) / double(s.chain);
}

void add_sizes(std::vector<SummaryRow>& rows, const Figures& f) {
    const auto whole = [&](const char* profile, int bits, const Limits& limits) {
        const Ratios r = over_models(f, profile, bits, over_draco);
        rows.push_back(
            row_of(fmt::format("whole `{}` file at {} bit over Draco cl 10, geometric mean", profile, bits),
                   r.mean(), r.told(), limits));
    };
    whole("stream", 14, {1.25, 1.00});
    whole("stream", 11, {1.35, 1.10});
    whole("quality", 14, {2.0, 1.4});
    for (const char* profile : {"stream", "quality"}) {
        Ratios each;
        int levels = 0, within = 0;
        for (const ModelSizes& m : f.sizes)
            for (const Profile& p : m.profiles)
                for (const Lod& lod : p.lods)
                    if (p.profile == profile) {
                        const double ratio = double(lod.reached) / double(lod.draco);
                        each.add(ratio, fmt::format("{}, {} triangles", m.model, lod.triangles));
                        ++levels;
                        within += ratio <= 2;
                    }
        rows.push_back(
            row_of(fmt::format("bytes to reach the error of each of {} halving LODs over that LOD's "
                               "own Draco file, `{}`: geometric mean; the worst is judged",
                               kChain, profile),
                   each.worst(), fmt::format("{}; {} of {} within the bar", each.told(), within, levels),
                   {2.0, 1.5}));
    }
    for (const char* profile : {"stream", "quality"}) {
        const Ratios r = over_models(f, profile, 14, over_chain);
        rows.push_back(
            row_of(fmt::format(
                       "whole `{}` file over the chain of {} Draco LODs: geometric mean; the worst is judged",
                       profile, kChain),
                   r.worst(), r.told(), {1.0, 0.6}));
    }
    for (const int bits : {8, 10}) {
        Ratios normals;
        for (const ModelSizes& m : f.sizes)
            for (const Profile& p : m.profiles)
                normals.add(8 * double(bits == 8 ? p.normals_8 : p.normals_10) / double(p.vertices), m.model);
        rows.push_back(row_of(
            fmt::format("{}-bit octahedral normals (smooth), `stream`: geometric mean; the worst is judged",
                        bits),
            normals.worst(), normals.any() ? normals.told() + " bits a vertex" : "n/a",
            {bits == 8 ? 7.0 : 10.0, 0, 1, "", false}));
    }
}

double encode_pace(const Speeds& s, double seconds) {
    return 1e6 * seconds / double(s.triangles);
}
double decode_pace(const Speeds& s, double seconds) {
    return 1e-6 * double(s.vertices) / seconds;
}

void add_speeds(std::vector<SummaryRow>& rows, const Figures& f) {
    for (const Speeds& s : f.speeds) {
        const double decode = decode_pace(s, s.decode), encode = encode_pace(s, s.encode);
        rows.push_back(row_of(
            fmt::format("decode, one thread, {}, `{}`", s.model, s.profile), decode,
            fmt::format("{:.2f} M vertices/s (Draco cl 10: {:.2f})", decode, decode_pace(s, s.draco_decode)),
            {1.0, 2.5, -1, " M"}));
        rows.push_back(row_of(fmt::format("encode after the record, {}, `{}`", s.model, s.profile), encode,
                              fmt::format("{:.2f} s per 1 M triangles (Draco cl 10: {:.2f})", encode,
                                          encode_pace(s, s.draco_encode)),
                              {3, 1, 1, " s"}));
    }
}

void write_machine(Out out, const char* what, const Machine& m) {
    if (m.date.empty()) return;
    fmt::format_to(out, "| {} | {}, commit {}: {}, {} cores, {:.0f} GiB; {}; {} |\n", what, m.date, m.commit,
                   m.cpu, m.cores, m.memory_gib, m.system, m.compiler);
}

void write_sizes(Out out, const Figures& f, const std::string& profile) {
    fmt::format_to(out,
                   "\n### {} profile\n\n| model | vertices | bits | `.pmesh` | Draco cl 10 | Draco cl 7 | "
                   "gltfpack -cc | 8 Draco LODs | over cl 10 | over the chain |\n"
                   "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
                   profile);
    for (const ModelSizes& m : f.sizes)
        for (const Profile& p : m.profiles) {
            if (p.profile != profile) continue;
            for (const Size& s : p.sizes) {
                const auto bits = [&](std::uint64_t bytes) {
                    return bytes ? fmt::format("{:.2f}", 8 * double(bytes) / double(p.vertices)) : "n/a";
                };
                fmt::format_to(out, "| {} | {} | {} | {} | {} | {} | {} | {} | {:.3f} | {:.3f} |\n", m.model,
                               p.vertices, bits_name(s.bits), bits(s.file), bits(s.draco_ten),
                               bits(s.draco_seven), bits(s.gltfpack), bits(s.chain), over_draco(s),
                               over_chain(s));
            }
        }
    for (const int bits : kBits)
        fmt::format_to(out, "| **geometric mean** | | {} | | | | | | {:.3f} | {:.3f} |\n", bits_name(bits),
                       over_models(f, profile, bits, over_draco).mean(),
                       over_models(f, profile, bits, over_chain).mean());
}

void write_lods(Out out, const Figures& f) {
    fmt::format_to(
        out,
        "\n## To the error of each level\n\nBytes of the 14-bit `.pmesh`, from its start, until its "
        "table promises the error that the level has in our record; the level's own file in Draco "
        "(cl 10, qp 14; what its own rounding adds to the error is not counted); the ratio. A table promises "
        "errors at the ends of blocks only, so up to a block, 48 KiB, less near the front, is in it.\n\n| "
        "model | profile |");
    for (int i = 0; i < kChain; ++i) fmt::format_to(out, " 1/{} |", 1 << i);
    fmt::format_to(out, "\n| --- | --- |");
    for (int i = 0; i < kChain; ++i) fmt::format_to(out, " --- |");
    fmt::format_to(out, "\n");
    for (const ModelSizes& m : f.sizes)
        for (const Profile& p : m.profiles) {
            fmt::format_to(out, "| {} | {} |", m.model, p.profile);
            for (const Lod& lod : p.lods)
                fmt::format_to(out, " {} / {} = {:.2f} |", lod.reached, lod.draco,
                               double(lod.reached) / double(lod.draco));
            fmt::format_to(out, "\n");
        }
}

void write_speeds(Out out, const Figures& f) {
    fmt::format_to(
        out,
        "\n## Speed\n\n14 bits, processor time of one thread, median of three; encoding begins with "
        "the collapse record. In brackets Draco, cl 10.\n\n| model | profile | triangles | vertices "
        "| encode, s per 1 M triangles | decode, M vertices/s |\n"
        "| --- | --- | --- | --- | --- | --- |\n");
    for (const Speeds& s : f.speeds)
        fmt::format_to(out, "| {} | {} | {} | {} | {:.2f} ({:.2f}) | {:.2f} ({:.2f}) |\n", s.model, s.profile,
                       s.triangles, s.vertices, encode_pace(s, s.encode), encode_pace(s, s.draco_encode),
                       decode_pace(s, s.decode), decode_pace(s, s.draco_decode));
}

}  // namespace

std::string to_markdown(const Figures& f, const std::vector<std::string>& plots) {
    std::string page;
    const Out out = std::back_inserter(page);
    fmt::format_to(out,
                   "# The file's size and speed\n\nWritten by `./run bench format`; do not edit. Other "
                   "models: `./run bench "
                   "format MODEL... --speed MODEL`.\n\n| | |\n| --- | --- |\n");
    write_machine(out, "sizes", f.sizes_on);
    write_machine(out, "speed", f.speeds_on);
    fmt::format_to(out, "| Draco | {}, its library, edgebreaker, positions only |\n", draco_version());
    fmt::format_to(out, "| gltfpack -cc | {} |\n", f.gltfpack);
    std::vector<SummaryRow> rows;
    if (!f.sizes.empty()) add_sizes(rows, f);
    add_speeds(rows, f);
    fmt::format_to(
        out,
        "\n## Against the bars\n\n| figure | measured | bar | goal | |\n| --- | --- | --- | --- | --- "
        "|\n");
    for (const SummaryRow& row : rows)
        fmt::format_to(out, "| {} | {} | {} | {} | {} |\n", row.figure, row.measured, row.bar, row.goal,
                       row.verdict);
    if (!f.sizes.empty()) {
        fmt::format_to(
            out,
            "\n## Bits a vertex of whole files\n\nPositions only. `.pmesh` holds every level, the "
            "others one; the chain is {} levels of halving counts, cut from the profile's own record, "
            "each in Draco at cl 10 and the same bits. gltfpack's file is a whole .glb, about 1 kB of "
            "it JSON.\n",
            kChain);
        for (const char* profile : {"stream", "quality"}) write_sizes(out, f, profile);
        write_lods(out, f);
        fmt::format_to(
            out,
            "\n## Rate and distortion\n\nThe error that the 14-bit file's table promises at the ends "
            "of base and blocks, against the bytes received until then, over the box's diagonal; "
            "Draco's levels are those of the quality record (cl 10, qp 14), each alone, and as a chain "
            "that is fetched from its coarsest level. Below half a step of the lattice, all errors "
            "count as that.\n\n");
        for (const std::string& plot : plots) fmt::format_to(out, "![Rate and distortion]({})\n\n", plot);
        page.pop_back();
    }
    if (!f.speeds.empty()) write_speeds(out, f);
    return page;
}

}  // namespace vsplit::bench
