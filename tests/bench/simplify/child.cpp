// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "child.hpp"

#include <malloc.h>
#include <oneapi/tbb/global_control.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <vector>

namespace vsplit::bench {
namespace {

double cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::uint64_t resident_bytes() {
    std::uint64_t total = 0, resident = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(file, "%lu %lu", &total, &resident) != 2) resident = 0;
        std::fclose(file);
    }
    return resident * std::uint64_t(sysconf(_SC_PAGESIZE));
}

Error failure(std::string message) {
    return {ErrorCode::kUnsupported, std::move(message), Error::kNowhere, 0};
}

/// In the child: the answer, or why there is none, as CBOR.
std::vector<std::uint8_t> answer(const std::function<Result<Json>()>& work) {
    Json json;
    try {
        auto result = work();
        json = result ? Json{{"answer", *result}} : Json{{"error", result.error().message}};
    } catch (const std::exception& error) {
        json = {{"error", std::string("threw: ") + error.what()}};
    } catch (...) {
        json = {{"error", "threw something that is no exception"}};
    }
    return Json::to_cbor(json);
}

}  // namespace

Meter::Meter() : cpu_(cpu_seconds()), wall_(std::chrono::steady_clock::now()), resident_(resident_bytes()) {}

Usage Meter::stop() const {
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return {cpu_seconds() - cpu_, wall, std::uint64_t(usage.ru_maxrss) * 1024, resident_};
}

Result<Json> in_child(const std::function<Result<Json>()>& work, double limit_seconds) {
    // Threads do not survive a fork, and TBB would not start them again: the child begins without any.
    tbb::task_scheduler_handle scheduler{tbb::attach{}};
    if (!tbb::finalize(scheduler, std::nothrow)) return failure("TBB's threads did not end");
    std::fflush(nullptr);
    malloc_trim(0);  // What this process freed is not the child's.
    int ends[2];
    if (pipe(ends) != 0) return failure(std::string("no pipe: ") + std::strerror(errno));
    const pid_t child = fork();
    if (child < 0) {
        close(ends[0]);
        close(ends[1]);
        return failure(std::string("no process: ") + std::strerror(errno));
    }
    if (child == 0) {
        close(ends[0]);
        const std::vector<std::uint8_t> bytes = answer(work);
        for (std::size_t done = 0; done < bytes.size();) {
            const ssize_t n = write(ends[1], bytes.data() + done, bytes.size() - done);
            if (n < 0 && errno != EINTR) break;
            if (n > 0) done += std::size_t(n);
        }
        _exit(0);  // No destructors: threads of the library may be waiting for work.
    }
    close(ends[1]);
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(limit_seconds);
    std::vector<std::uint8_t> bytes;
    bool late = false;
    for (;;) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(until - std::chrono::steady_clock::now())
                .count();
        pollfd ready{ends[0], POLLIN, 0};
        const int n = left > 0 ? poll(&ready, 1, int(left)) : 0;
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) {
            late = true;
            kill(child, SIGKILL);
            break;
        }
        std::uint8_t chunk[65536];
        const ssize_t got = read(ends[0], chunk, sizeof(chunk));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        bytes.insert(bytes.end(), chunk, chunk + got);
    }
    close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (late) return failure("stopped after " + std::to_string(int(limit_seconds)) + " s");
    if (WIFSIGNALED(status)) return failure("crashed (signal " + std::to_string(WTERMSIG(status)) + ")");
    Json json = Json::from_cbor(bytes, true, false);
    if (!json.is_object())
        return failure("ended without an answer (exit " + std::to_string(WEXITSTATUS(status)) + ")");
    if (json.contains("error")) return failure(json["error"].get<std::string>());
    return std::move(json["answer"]);
}

}  // namespace vsplit::bench
