// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <functional>

#include "draco_file.hpp"
#include "figures.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

namespace vsplit::bench {
namespace {

double median_cpu_seconds(const std::function<void()>& work) {
    std::array<double, 3> seconds{};
    for (double& s : seconds) {
        const std::clock_t start = std::clock();
        work();
        s = double(std::clock() - start) / CLOCKS_PER_SEC;
    }
    std::sort(seconds.begin(), seconds.end());
    return seconds[1];
}

}  // namespace

Result<std::vector<Speeds>> measure_speeds(const std::string& path) {
    const auto mesh = load_model(path);
    if (!mesh) return mesh.error();
    std::vector<Speeds> all;
    for (const bake::Placement placement : kPlacements) {
        bake::CollapseOptions options;
        options.placement = placement;
        options.calibrate = options.put_off_outliers =
            false;  // Other errors do not change what coding costs.
        const auto record = bake::collapse(*mesh, options);
        if (!record) return record.error();
        const Mesh full = cut(record->mesh, record->mesh.splits.size());
        Speeds s{std::filesystem::path(path).stem().string(), profile_name(placement), full.positions.size(),
                 full.triangles.size()};
        Result<std::vector<std::byte>> file = std::vector<std::byte>{};
        s.encode = median_cpu_seconds([&] { file = write_progressive_mesh(record->mesh); });
        if (!file) return file.error();
        Status read = Ok{};
        s.decode = median_cpu_seconds([&] {
            const auto back = read_progressive_mesh(*file);
            if (!back) read = back.error();
        });
        if (!read.ok()) return read.error();
        std::vector<char> draco;
        std::size_t vertices = 0;
        s.draco_encode = median_cpu_seconds([&] { draco = encode_draco(full, 14, 10); });
        s.draco_decode = median_cpu_seconds([&] { vertices = decode_draco(draco); });
        if (vertices == 0) return Error{ErrorCode::kUnsupported, "Draco failed", Error::kNowhere, 0};
        all.push_back(s);
    }
    return all;
}

}  // namespace vsplit::bench
