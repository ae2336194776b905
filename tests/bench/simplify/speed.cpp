// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "speed.hpp"

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>

#include "vsplit/bake/collapse.hpp"

namespace vsplit::bench {
namespace {

constexpr double kLimitSeconds = 600;

struct Sample {
    Usage usage;
    double collapses = 0, triangles = 0;
    std::string fingerprint;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Sample, usage, collapses, triangles, fingerprint)

/// FNV-1a over words of eight bytes: to tell two records apart, not to protect them.
class Fingerprint {
  public:
    template <class T>
    void add(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);
        mix(values.size());
        std::uint32_t word;
        const auto* bytes = reinterpret_cast<const char*>(values.data());
        for (std::size_t i = 0; i < values.size() * sizeof(T); i += sizeof(word)) {
            std::memcpy(&word, bytes + i, sizeof(word));
            mix(word);
        }
    }
    std::string text() const {
        char hex[17];
        std::snprintf(hex, sizeof(hex), "%016lx", state_);
        return hex;
    }

  private:
    void mix(std::uint64_t word) { state_ = (state_ ^ word) * 0x100000001B3ull; }
    std::uint64_t state_ = 0xCBF29CE484222325ull;
};

std::string fingerprint(const ProgressiveMesh& mesh) {
    Fingerprint print;
    print.add(std::vector<std::uint32_t>{mesh.base_vertices, mesh.base_triangles});
    print.add(mesh.positions);
    print.add(mesh.weights);
    print.add(mesh.parents);
    print.add(mesh.triangles);
    print.add(mesh.splits);
    print.add(mesh.corner_changes);
    print.add(mesh.moves);
    return print.text();
}

/// One thing to time: fills one Timing over the rounds.
class Lane {
  public:
    explicit Lane(Timing& timing) : timing_(timing) {}

    void run(const std::function<Result<Json>()>& work) {
        if (!timing_.reason.empty()) return;
        const auto answer = in_child(work, kLimitSeconds);
        if (answer)
            samples_.push_back(answer->get<Sample>());
        else
            timing_.reason = answer.error().message;
    }

    ~Lane() {
        if (samples_.empty()) {
            if (timing_.reason.empty()) timing_.reason = "not run";
            return;
        }
        const auto sorted = [&](auto member) {
            std::vector<double> values;
            for (const Sample& s : samples_) values.push_back(double(member(s)));
            std::sort(values.begin(), values.end());
            return values;
        };
        const auto cpu = sorted([](const Sample& s) { return s.usage.cpu_seconds; });
        const auto wall = sorted([](const Sample& s) { return s.usage.wall_seconds; });
        const auto peak = sorted([](const Sample& s) { return s.usage.peak_bytes; });
        const auto start = sorted([](const Sample& s) { return s.usage.start_bytes; });
        const auto median = [](const std::vector<double>& values) {
            const std::size_t half = values.size() / 2;
            return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
        };
        timing_.runs = int(samples_.size());
        timing_.cpu_seconds = median(cpu);
        timing_.cpu_least = cpu.front();
        timing_.cpu_most = cpu.back();
        timing_.wall_seconds = median(wall);
        timing_.wall_least = wall.front();
        timing_.peak_bytes = median(peak);
        timing_.start_bytes = median(start);
        timing_.collapses = samples_.front().collapses;
        timing_.triangles = samples_.front().triangles;
        timing_.fingerprint = samples_.front().fingerprint;
        for (const Sample& s : samples_)
            if (s.fingerprint != timing_.fingerprint) timing_.fingerprint = "differs";
    }

  private:
    Timing& timing_;
    std::vector<Sample> samples_;
};

/// The record alone, or with what comes after it: outliers put off, errors measured.
Result<Json> record(const Mesh& mesh, std::size_t threads, bool finished) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    bake::CollapseOptions options;
    options.put_off_outliers = options.calibrate = finished;
    Sample sample;
    const Meter meter;
    const auto result = bake::collapse(mesh, options);
    sample.usage = meter.stop();
    if (!result) return result.error();
    sample.collapses = double(result->mesh.positions.size() - result->mesh.base_vertices);
    sample.triangles = result->mesh.base_triangles;
    sample.fingerprint = fingerprint(result->mesh);
    return Json(sample);
}

Result<Json> to_one_percent(const Peer& peer, const Mesh& mesh) {
    if (!peer.missing.empty()) return Error{ErrorCode::kUnsupported, "missing", Error::kNowhere, 0};
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    const std::array<std::size_t, 1> targets{mesh.triangles.size() / 100};
    Sample sample;
    const Meter meter;
    const auto result = peer.simplify(mesh, targets);
    sample.usage = meter.stop();
    if (!result) return result.error();
    sample.collapses = double(mesh.positions.size()) - double(result->front().positions.size());
    sample.triangles = double(result->front().triangles.size());
    return Json(sample);
}

}  // namespace

Speed measure_speed(const Model& model, const std::vector<Peer>& peers, bool quick) {
    Speed speed;
    speed.model = model.name;
    auto mesh = model.load();
    if (!mesh) {
        speed.reason = mesh.error().describe();
        return speed;
    }
    speed.triangles = mesh->triangles.size();
    const auto peer = [&](const char* name) -> const Peer& {
        return *std::find_if(peers.begin(), peers.end(), [&](const Peer& p) { return p.name == name; });
    };
    const int rounds = quick ? 3 : 5;
    {
        Lane one(speed.record), two(speed.record_two_threads), calibrated(speed.record_calibrated),
            fast(speed.meshoptimizer), half_edges(speed.openmesh);
        for (int round = 0; round < rounds; ++round) {
            std::fprintf(stderr, "%s: speed, round %d of %d\n", model.name.c_str(), round + 1, rounds);
            one.run([&] { return record(*mesh, 1, false); });
            fast.run([&] { return to_one_percent(peer("meshoptimizer"), *mesh); });
            two.run([&] { return record(*mesh, 2, false); });
            if (round == 0) calibrated.run([&] { return record(*mesh, 1, true); });
            if (round == 0) half_edges.run([&] { return to_one_percent(peer("OpenMesh"), *mesh); });
        }
    }
    Mesh fine = subdivide(*mesh, 0.05f);
    speed.fine_triangles = fine.triangles.size();
    {
        Lane again(speed.record_again), larger(speed.record_fine);
        for (int round = 0; round < 2; ++round) {
            std::fprintf(stderr, "%s: four times as large, round %d of 2\n", model.name.c_str(), round + 1);
            again.run([&] { return record(*mesh, 1, false); });
            larger.run([&] { return record(fine, 1, false); });
        }
    }
    return speed;
}

}  // namespace vsplit::bench
