// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "peer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace vsplit::bench {
namespace {

/// Attributes of all vertices, row by row, and which of the four weights each has.
struct Rows {
    std::vector<std::uint32_t> kinds;
    std::vector<float> values;
};

/// How many joints' weights the peer may look at (it takes up to 32 attributes).
constexpr std::size_t kJoints = 16;

Rows rows_of(const Primitive& p) {
    Rows out;
    const std::size_t vertices = p.positions.size();
    // A column for each of the joints that count most.
    std::vector<std::pair<double, std::uint32_t>> totals;
    for (std::size_t i = 0; i < p.joints.size(); ++i)
        for (std::size_t k = 0; k < 8; ++k) {
            if (!(p.weights[i][k] > 0)) continue;
            while (totals.size() <= p.joints[i][k]) totals.emplace_back(0.0, std::uint32_t(totals.size()));
            totals[p.joints[i][k]].first -= double(p.weights[i][k]);
        }
    std::sort(totals.begin(), totals.end());
    totals.resize(std::min(totals.size(), kJoints));
    out.kinds.insert(out.kinds.end(), p.normals.empty() ? 0 : 3, 0);
    out.kinds.insert(out.kinds.end(), p.uvs.empty() ? 0 : 2, 1);
    out.kinds.insert(out.kinds.end(), p.colors.empty() ? 0 : 4, 2);
    out.kinds.insert(out.kinds.end(), totals.size(), 3);
    for (std::size_t i = 0; i < vertices; ++i) {
        if (!p.normals.empty()) out.values.insert(out.values.end(), p.normals[i].begin(), p.normals[i].end());
        if (!p.uvs.empty()) out.values.insert(out.values.end(), p.uvs[i].begin(), p.uvs[i].end());
        if (!p.colors.empty()) out.values.insert(out.values.end(), p.colors[i].begin(), p.colors[i].end());
        for (const auto& [total, joint] : totals) {
            float weight = 0;
            for (std::size_t k = 0; k < 8; ++k)
                if (p.joints[i][k] == joint) weight += p.weights[i][k];
            out.values.push_back(weight);
        }
    }
    return out;
}

}  // namespace

std::vector<Scene> simplify_by_peer(const Scene& scene, const std::vector<double>& ratios,
                                    const PeerSettings& settings, const std::string& folder) {
    const std::string in = folder + "/peer.in", out = folder + "/peer.out";
    std::vector<std::size_t> widths;
    {
        std::ofstream file(in, std::ios::binary);
        const auto put = [&](const auto* values, std::size_t count) {
            static_assert(sizeof *values == 4);
            file.write(reinterpret_cast<const char*>(values), std::streamsize(4 * count));
        };
        const auto word = [&](std::size_t value) {
            const auto w = std::uint32_t(value);
            put(&w, 1);
        };
        const float weights[] = {settings.normal, settings.texcoord, settings.color, settings.joints};
        put(weights, 4);
        word(settings.moves);
        word(ratios.size());
        for (const double r : ratios) {
            const auto f = float(r);
            put(&f, 1);
        }
        word(scene.primitives.size());
        for (const Primitive& p : scene.primitives) {
            const Rows rows = rows_of(p);
            widths.push_back(rows.kinds.size());
            word(p.positions.size());
            word(p.indices.size());
            word(rows.kinds.size());
            put(rows.kinds.data(), rows.kinds.size());
            put(p.positions.empty() ? nullptr : p.positions[0].data(), 3 * p.positions.size());
            put(rows.values.data(), rows.values.size());
            put(p.indices.data(), p.indices.size());
        }
        if (!file.flush()) throw std::runtime_error("cannot write " + in);
    }
    const std::string command = "node '" VSPLIT_BENCH_SOURCE "/peer.mjs' '" + in + "' '" + out + "'";
    if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
    std::ifstream file(out, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    std::size_t at = 0;
    const auto take = [&](void* to, std::size_t count) {
        if (bytes.size() - at < 4 * count) throw std::runtime_error(out + " is too short");
        if (count > 0) std::memcpy(to, bytes.data() + at, 4 * count);
        at += 4 * count;
    };
    std::vector<Scene> levels(ratios.size(), scene);
    for (std::size_t n = 0; n < scene.primitives.size(); ++n)
        for (Scene& level : levels) {
            Primitive& p = level.primitives[n];
            std::uint32_t count = 0;
            take(&count, 1);
            p.indices.resize(count);
            take(p.indices.data(), count);
            if (!settings.moves) continue;
            take(p.positions.empty() ? nullptr : p.positions[0].data(), 3 * p.positions.size());
            std::vector<float> values(widths[n] * p.positions.size());
            take(values.data(), values.size());
            for (std::size_t i = 0; i < p.positions.size(); ++i) {
                const float* row = values.data() + widths[n] * i;
                if (!p.normals.empty())
                    row = std::copy_n(row, 3, p.normals[i].begin()) - p.normals[i].begin() + row;
                if (!p.uvs.empty()) row = std::copy_n(row, 2, p.uvs[i].begin()) - p.uvs[i].begin() + row;
                if (!p.colors.empty()) std::copy_n(row, 4, p.colors[i].begin());
            }
        }
    return levels;
}

}  // namespace vsplit::bench
