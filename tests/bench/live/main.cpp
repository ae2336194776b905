// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// LiveBuffers on one thread: splits a second, jumps, memory, and decoding, beside what is asked of them. The
// splits come as the file has them: written, decoded block by block, appended.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "gltf/normals.hpp"
#include "machine.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/live_buffers.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;

namespace {

constexpr int kRuns = 5;
constexpr std::size_t kCall = 10'000;  // splits between two looks at the dirty ranges
constexpr int kJumps = 200;

struct Kind {
    const char* name;
    bake::Placement placement;
    bool normals;
};
constexpr Kind kKinds[] = {{"endpoint", bake::Placement::kEndpoint, false},
                           {"endpoint, normals", bake::Placement::kEndpoint, true},
                           {"optimal, normals", bake::Placement::kOptimal, true}};

struct Figures {
    std::size_t triangles = 0, splits = 0;
    double refine = 0, coarsen = 0;        // M splits/s
    double jump_mean = 0, jump_worst = 0;  // ms
    double memory = 0;                     // over the indexed triangle list
    double decode = 0;                     // M vertices/s
    double append = 0;                     // M vertices/s
    double corners = 0;                    // changed per split
};

double cpu_seconds() {
    return double(std::clock()) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// Feeds the file's blocks one by one; the seconds that it took, and those of them in LiveBuffers.
Result<double> feed(std::span<const std::byte> file, LiveBuffers& live, double& appending) {
    const double start = cpu_seconds();
    auto decoder = BlockDecoder::begin(file);
    if (!decoder) return decoder.error();
    const FileInfo& info = decoder->info();
    live.begin(decoder->mesh(), info.vertices, info.triangles, info.splits, info.corner_changes, info.moves,
               info.lossless ? PlaceGrid{} : PlaceGrid{info.lattice_origin, info.lattice_step});
    for (const BlockInfo& block : info.blocks) {
        const Status status = decoder->decode(file.subspan(block.offset, block.bytes));
        if (!status) return status.error();
        const double decoded = cpu_seconds();
        live.append(decoder->mesh());
        appending += cpu_seconds() - decoded;
    }
    return cpu_seconds() - start;
}

/// The live buffers against LiveMesh at some levels: a bench of something wrong is worth nothing.
bool right(LiveBuffers& live, std::span<const std::byte> file) {
    auto mesh = read_progressive_mesh(file);
    if (!mesh) return false;
    LiveMesh judge(std::move(*mesh));
    for (const std::size_t level :
         {judge.max_level(), judge.max_level() / 3, judge.max_level() / 2, std::size_t{0}}) {
        judge.go_to(level);
        live.jump(level);
        if (!std::ranges::equal(live.triangles(), judge.triangles()) ||
            !std::ranges::equal(live.positions(), judge.positions()))
            return false;
        for (std::size_t i = 0; i < live.attribute_count(); ++i)
            if (!std::equal(live.attribute(i).begin(), live.attribute(i).end(),
                            judge.state().attributes[i].values.begin()))
                return false;
    }
    return true;
}

Result<std::vector<std::byte>> bake_file(const Mesh& mesh, const Kind& kind) {
    bake::CollapseOptions options;
    options.placement = kind.placement;
    options.calibrate = false;  // errors are of no concern here
    const auto record = bake::collapse(mesh, options);
    if (!record) return record.error();
    return write_progressive_mesh(record->mesh);
}

Result<Figures> measure(std::span<const std::byte> file) {
    Figures f;
    LiveBuffers live;
    std::vector<double> decode;
    double appending = 0;
    const auto info = read_info(file);
    if (!info) return info.error();
    const double corners = info->corner_changes;
    for (int run = 0; run < 3; ++run) {
        const auto seconds = feed(file, live, appending);
        if (!seconds) return seconds.error();
        decode.push_back(*seconds);
    }
    if (!right(live, file)) return Error{ErrorCode::kMalformed, "LiveBuffers and LiveMesh differ"};
    const std::size_t splits = live.available();
    f.splits = splits;
    f.corners = corners / double(splits);

    std::vector<double> refine, coarsen;
    std::uint64_t seen = 0;
    for (int run = 0; run < kRuns; ++run) {
        const double start = cpu_seconds();
        while (live.level() < splits) live.refine(kCall), seen += live.take_dirty().triangles_end;
        const double middle = cpu_seconds();
        while (live.level() > 0) live.coarsen(kCall), seen += live.take_dirty().triangles_end;
        refine.push_back(middle - start);
        coarsen.push_back(cpu_seconds() - middle);
    }
    std::mt19937_64 random(1);
    for (int i = 0; i < kJumps; ++i) {
        const std::size_t level = random() % (splits + 1);
        const double start = cpu_seconds();
        live.jump(level);
        seen += live.take_dirty().triangles_end;
        const double ms = 1e3 * (cpu_seconds() - start);
        f.jump_mean += ms / kJumps;
        f.jump_worst = std::max(f.jump_worst, ms);
    }
    if (seen == 0) return Error{ErrorCode::kMalformed, "nothing was ever dirty"};
    live.jump(splits);
    f.triangles = live.triangle_count();
    std::size_t plain = live.positions().size_bytes() + live.triangles().size_bytes();
    for (std::size_t i = 0; i < live.attribute_count(); ++i) plain += live.attribute(i).size_bytes();
    f.refine = 1e-6 * double(splits) / median(refine);
    f.coarsen = 1e-6 * double(splits) / median(coarsen);
    f.memory = double(live.memory()) / double(plain);
    f.append = 1e-6 * 3 * double(live.vertex_count()) / appending;
    f.decode = 1e-6 * double(live.vertex_count()) / median(decode);
    return f;
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::string> files;
    std::string markdown, keep, library;
    CLI::App app("Speed and memory of the live buffers, on one thread.", "vsplit_bench_live");
    app.add_option("file", files,
                   "Meshes, or .pmesh files as they are (default: nefertiti and igea-1m of the corpus)");
    app.add_option("--markdown", markdown, "Write the page to this file too");
    app.add_option("--keep", keep, "Folder for what was baked, to measure it again without baking");
    app.add_option("--library", library, "The shared library without Draco, stripped, to report its size");
    CLI11_PARSE(app, argc, argv);
    const std::string corpus = VSPLIT_CORPUS;
    if (files.empty()) files = {corpus + "/meshes/nefertiti.obj", corpus + "/meshes/igea-1m.ply"};

    std::string rows, command = "vsplit_bench_live";
    bool failed = false;
    const auto report = [&](const std::string& name, const std::string& kind, const Result<Figures>& f) {
        if (!f) {
            fmt::print(stderr, "{}, {}: {}\n", name, kind, f.error().describe());
            failed = true;
            return;
        }
        rows += fmt::format(
            "| {} | {} | {} | {} | {:.2f} | {:.0f} | {:.0f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.1f} |\n",
            name, kind, f->triangles, f->splits, f->corners, f->refine, f->coarsen, f->jump_mean,
            f->jump_worst, f->memory, f->decode, f->append);
    };
    for (const std::string& path : files) {
        const std::string name = path.substr(path.rfind('/') + 1);
        const std::string extension = name.substr(std::min(name.rfind('.'), name.size()));
        command += " " + name;
        const auto bytes = bake::read_file(path);
        if (bytes && extension == ".pmesh") {
            report(name, "as baked", measure(*bytes));
            continue;
        }
        const auto input =
            bytes ? bake::parse_mesh(*bytes, extension) : Result<bake::MeshFile>(bytes.error());
        if (!input) {
            fmt::print(stderr, "{}: {}\n", path, input.error().describe());
            return 3;
        }
        for (const Kind& kind : kKinds) {
            Mesh mesh = input->mesh;
            if (kind.normals) {
                Attribute normals{"NORMAL", Semantic::kNormal, 3, {}};
                for (const Float3& n : bake::smooth_normals(mesh))
                    normals.values.insert(normals.values.end(), {n.x, n.y, n.z});
                mesh.attributes = {std::move(normals)};
            }
            const auto file = bake_file(mesh, kind);
            report(name, kind.name, file ? measure(*file) : Result<Figures>(file.error()));
            if (!file || keep.empty()) continue;
            const std::string kept = keep + "/" + name + "." + kind.name + ".pmesh";
            const Status written = bake::write_file(kept, *file, true);
            if (!written) fmt::print(stderr, "{}: {}\n", kept, written.error().describe());
        }
    }
    std::string size;
    if (!library.empty()) {
        const auto bytes = bake::read_file(library);
        if (!bytes) {
            fmt::print(stderr, "{}: {}\n", library, bytes.error().describe());
            return 3;
        }
        size = fmt::format(
            "\nThe shared library, built as tests/consumer/no_draco builds it (Release, no Draco, no "
            "exceptions, "
            "no RTTI) and stripped: {} bytes, {:.0f} KiB; bar 500, goal 200.\n",
            bytes->size(), double(bytes->size()) / 1024);
    }
    const bench::Machine machine = bench::describe_machine();
    const std::string page = fmt::format(
        "# The live buffers, measured\n\n"
        "Written by `./run bench live` ({}; {}, {}; {}, commit {}). One thread, processor time.\n\n"
        "Splits come from a written file (14 bits) by BlockDecoder. Refine and coarsen: medians of {} runs "
        "over "
        "all levels, in calls of {} splits, each with its dirty ranges taken. Jump: {} random levels, each "
        "from the one before. Memory: LiveBuffers::memory() over 12 bytes a vertex, 12 a triangle and the "
        "attributes. Decode: checksum, decoding, the rules and append(), median of 3. Append: that part "
        "alone.\n\n"
        "| mesh | record | triangles | splits | corners a split | refine, M splits/s | coarsen, M splits/s | "
        "jump, mean ms | "
        "jump, worst ms | memory | decode, M vertices/s | append, M vertices/s |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n"
        "| bar (goal) | endpoint | | | | 40 (100) | 40 (100) | 5 (1) at 1 M triangles | 5 (1) at 1 M "
        "triangles | "
        "1.7 (1.5) | 0.8 (2) | |\n"
        "| bar (goal) | optimal, normals | | | | 15 (40) | 15 (40) | 5 (1) at 1 M triangles | 5 (1) at 1 M "
        "triangles | 1.7 (1.5) | 0.8 (2) | |\n{}{}",
        command, machine.cpu, machine.compiler, machine.date, machine.commit, kRuns, kCall, kJumps, rows,
        size);
    fmt::print("{}", page);
    if (!markdown.empty()) {
        const Status written = bake::write_file(markdown, std::as_bytes(std::span(page)), true);
        if (!written) {
            fmt::print(stderr, "{}\n", written.error().describe());
            return 4;
        }
    }
    return failed ? 1 : 0;
}
