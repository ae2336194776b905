// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "machine.hpp"

#include <unistd.h>

#include <ctime>
#include <fstream>
#include <thread>

namespace vsplit::bench {
namespace {

/// What follows the separator on the first line that starts with `key`.
std::string value_in(const char* path, const std::string& key, char separator) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (line.rfind(key, 0) != 0) continue;
        const std::size_t at = line.find(separator);
        if (at == std::string::npos) continue;
        const std::size_t begin = line.find_first_not_of(" \t\"", at + 1),
                          end = line.find_last_not_of(" \t\"");
        return begin == std::string::npos ? "" : line.substr(begin, end - begin + 1);
    }
    return "unknown";
}

/// First line of a command's output.
std::string output_of(const std::string& command) {
    std::string text;
    if (std::FILE* pipe = popen(command.c_str(), "r")) {
        char line[256];
        if (std::fgets(line, sizeof(line), pipe)) text = line;
        pclose(pipe);
    }
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    return text;
}

}  // namespace

Machine describe_machine() {
    Machine machine;
    machine.cpu = value_in("/proc/cpuinfo", "model name", ':');
    machine.system = value_in("/etc/os-release", "PRETTY_NAME", '=');
#if defined(__clang__)
    machine.compiler = "clang " __clang_version__;
#else
    machine.compiler = "g++ " __VERSION__;
#endif
    machine.compiler += ", " VSPLIT_BENCH_BUILD;
    const std::time_t now = std::time(nullptr);
    char date[32];
    std::strftime(date, sizeof(date), "%Y-%m-%d", std::gmtime(&now));
    machine.date = date;
    const std::string git = "git -C '" VSPLIT_BENCH_SOURCE "' ";
    machine.commit = output_of(git + "rev-parse --short=10 HEAD 2>/dev/null");
    if (machine.commit.empty()) machine.commit = "unknown";
    // What benchmarks write does not count.
    if (!output_of(git + "status --porcelain --untracked-files=no -- . ':!docs/benchmarks.md' "
                         "':!docs/*-bench.md' ':!docs/format-rd-*.svg' 2>/dev/null")
             .empty())
        machine.commit += " with changes";
    machine.cores = std::thread::hardware_concurrency();
    machine.memory_gib = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE)) / (1 << 30);
    return machine;
}

}  // namespace vsplit::bench
