// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Many streams on many threads, and one stream whose blocks others decode. Says most when it is built with
// -fsanitize=thread (preset tsan).
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <mutex>
#include <optional>
#include <random>
#include <thread>

#include "decorated.hpp"
#include "vsplit/geomorph.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/stream.hpp"
#include "vsplit/vsplit.h"
#include "vsplit/write.hpp"

using namespace vsplit;

namespace {

constexpr int kThreads = 8;

const std::vector<std::byte>& file() {
    static const std::vector<std::byte> bytes = [] {
        WriteOptions options;
        options.block_bytes = 1024;
        auto written = write_progressive_mesh(
            test::decorated(test::naive_record(test::make_sphere(40, 30), 5), 3), options);
        return *std::move(written);
    }();
    return bytes;
}

const ProgressiveMesh& whole() {
    static const ProgressiveMesh mesh = *read_progressive_mesh(file());
    return mesh;
}

bool is_level(const LiveBuffers& live) {
    const Mesh level = cut(whole(), live.level());
    bool same = std::equal(level.positions.begin(), level.positions.end(), live.positions().begin(),
                           live.positions().end()) &&
                std::equal(level.triangles.begin(), level.triangles.end(), live.triangles().begin(),
                           live.triangles().end());
    for (std::size_t i = 0; i < level.attributes.size(); ++i)
        same = same && std::equal(level.attributes[i].values.begin(), level.attributes[i].values.end(),
                                  live.attribute(i).begin(), live.attribute(i).end());
    return same;
}

/// Threads that run jobs as they come.
class Workers {
  public:
    explicit Workers(int count) {
        for (int i = 0; i < count; ++i) threads_.emplace_back([this] { work(); });
    }
    ~Workers() {
        {
            const std::lock_guard lock(mutex_);
            over_ = true;
        }
        come_.notify_all();
        for (std::thread& thread : threads_) thread.join();
    }
    void add(std::size_t stream, DecodeJob job) {
        {
            const std::lock_guard lock(mutex_);
            todo_.emplace_back(stream, std::move(job));
        }
        come_.notify_one();
    }
    std::vector<std::pair<std::size_t, DecodeJob>> take_done() {
        const std::lock_guard lock(mutex_);
        return std::exchange(done_, {});
    }

  private:
    void work() {
        for (;;) {
            std::unique_lock lock(mutex_);
            come_.wait(lock, [this] { return over_ || !todo_.empty(); });
            if (todo_.empty()) return;
            auto [stream, job] = std::move(todo_.front());
            todo_.pop_front();
            lock.unlock();
            job.run();
            lock.lock();
            done_.emplace_back(stream, std::move(job));
        }
    }
    std::mutex mutex_;
    std::condition_variable come_;
    bool over_ = false;
    std::deque<std::pair<std::size_t, DecodeJob>> todo_;
    std::vector<std::pair<std::size_t, DecodeJob>> done_;
    std::vector<std::thread> threads_;
};

}  // namespace

TEST_CASE("threads: streams are independent, uniform and selective ones") {
    whole();
    std::atomic<int> right = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < kThreads; ++i)
        threads.emplace_back([&, i] {
            std::mt19937 random{std::uint32_t(i)};
            Stream stream;
            bool good = stream.set_selective(i % 2 == 1).ok();
            CameraView view;
            for (int frame = 0; frame < 2000 && !stream.complete(); ++frame) {
                for (const ByteRange& range : stream.wants(3000))
                    good = stream
                               .feed(range.offset, std::span(file()).subspan(
                                                       std::size_t(range.offset),
                                                       std::min(std::size_t(range.size),
                                                                file().size() - std::size_t(range.offset))))
                               .ok() &&
                           good;
                view.camera.eye = {0, 0, float(random() % 100) / 10};
                if (frame % 2) stream.set_view(view);
                good = stream.update({.max_splits = 1 + random() % 200, .max_blocks = 2}).ok() && good;
                if (frame % 2) stream.clear_view();
            }
            good = stream.set_selective(false).ok() && stream.update().ok() && good;
            Geomorph morph(stream.buffers());
            stream.set_target(Target::ratio(double(i) / kThreads));
            good = stream.update().ok() && good;
            morph.turn(stream.buffers());
            morph.blend(0.5);
            right += good && stream.complete() && is_level(stream.buffers());
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(right == kThreads);
}

TEST_CASE("threads: workers decode the blocks of several streams that one thread draws") {
    whole();
    std::vector<Stream> streams;
    for (int i = 0; i < kThreads; ++i) {
        streams.emplace_back();
        REQUIRE(streams.back().set_selective(i % 3 == 2).ok());
        REQUIRE(streams.back().feed(0, file()).ok());
    }
    {
        Workers workers(3);
        std::size_t complete = 0;
        while (complete < streams.size()) {
            for (std::size_t i = 0; i < streams.size(); ++i)
                if (auto job = streams[i].take_job()) workers.add(i, *std::move(job));
            // Meanwhile what is there is refined.
            for (Stream& stream : streams) REQUIRE(stream.update({.max_splits = 50}).ok());
            for (auto& [i, job] : workers.take_done()) REQUIRE(streams[i].finish_job(std::move(job)).ok());
            complete = std::size_t(
                std::count_if(streams.begin(), streams.end(), [](const Stream& s) { return s.complete(); }));
        }
    }
    for (Stream& stream : streams) {
        REQUIRE(stream.set_selective(false).ok());
        stream.jump_to_target();
        CHECK(is_level(stream.buffers()));
    }
}

TEST_CASE("threads: jobs in C") {
    vsplit_stream* const stream = vsplit_stream_new(nullptr);
    REQUIRE(stream);
    CHECK(vsplit_stream_take_job(stream) == nullptr);
    REQUIRE(vsplit_stream_feed(stream, 0, file().data(), file().size()) == VSPLIT_OK);
    while (!vsplit_stream_complete(stream)) {
        vsplit_job* const job = vsplit_stream_take_job(stream);
        REQUIRE(job);
        CHECK(vsplit_stream_take_job(stream) == nullptr);
        std::thread worker([job] { vsplit_job_run(job); });
        CHECK(vsplit_stream_update(stream, 10, 1, nullptr) == VSPLIT_OK);
        worker.join();
        REQUIRE(vsplit_stream_finish_job(stream, job) == VSPLIT_OK);
    }
    vsplit_stream_jump(stream);
    CHECK(vsplit_stream_triangle_count(stream) == whole().triangles.size());
    vsplit_stream_free(stream);

    // A job outlives its stream.
    vsplit_stream* const gone = vsplit_stream_new(nullptr);
    REQUIRE(vsplit_stream_feed(gone, 0, file().data(), file().size()) == VSPLIT_OK);
    vsplit_job* const job = vsplit_stream_take_job(gone);
    REQUIRE(job);
    vsplit_stream_free(gone);
    vsplit_job_run(job);
    vsplit_job_free(job);
}
