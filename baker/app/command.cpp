// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "command.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <ctime>
#include <filesystem>

#include "vsplit/bake/files.hpp"

namespace vsplit::app {
namespace {

int fail(const std::string& file, const Error& error, int code) {
    fmt::print(stderr, "vsplit: {}: {} [{}]\n", file, error.describe(), error_code_name(error.code));
    return code;
}

double now_seconds() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace

void Common::add_to(CLI::App& command) {
    command.add_flag("--json", json, "Print a machine-readable report to stdout");
    command.add_flag("-q,--quiet", quiet, "Print nothing but errors");
    command
        .add_option("--threads", threads, "Threads to use, 0 for all; the result is the same for any number")
        ->check(CLI::Range(0, 1024));
}

void Output::add_to(CLI::App& command, const char* what, bool required) {
    auto* option = command.add_option("-o,--output", path, what)->type_name("FILE");
    if (required) option->required();
    command.add_flag("-f,--force", force, "Overwrite the output if it exists");
}

int fail_input(const std::string& file, const Error& error) {
    return fail(file, error,
                error.code == ErrorCode::kArgument    ? kUsage
                : error.code == ErrorCode::kCancelled ? kFailed
                                                      : kBadInput);
}
int fail_output(const std::string& file, const Error& error) {
    return fail(file, error, kBadOutput);
}
int fail_usage(const std::string& message) {
    fmt::print(stderr, "vsplit: {}\n", message);
    return kUsage;
}

int check_output(const Output& output) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (!output.force && fs::is_regular_file(output.path, ignored))
        return fail_output(output.path, {ErrorCode::kExists, "exists already; pass --force to overwrite it",
                                         Error::kNowhere, 0});
    const fs::path folder = fs::path(output.path).parent_path();
    if (!folder.empty() && !fs::is_directory(folder, ignored))
        return fail_output(output.path,
                           {ErrorCode::kIo, "there is no folder " + folder.string(), Error::kNowhere, 0});
    return kDone;
}

int write_output(const Output& output, std::span<const std::byte> bytes) {
    const Status written = bake::write_file(output.path, bytes, output.force);
    return written ? kDone : fail_output(output.path, written.error());
}

void say(const Common& common, const std::string& text) {
    if (!common.quiet && !common.json) fmt::print("{}\n", text);
}
void print_json(const Json& json) {
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

ProgressBar::ProgressBar(const Common& common) : shown_(!common.quiet && isatty(STDERR_FILENO)) {}
ProgressBar::~ProgressBar() {
    clear();
}

bake::Progress ProgressBar::callback() {
    if (!shown_) return {};
    return [this](std::string_view stage, double done) {
        draw(stage, done);
        return true;
    };
}

void ProgressBar::draw(std::string_view stage, double done) {
    const double now = now_seconds();
    if (now - last_ < 0.05) return;
    last_ = now;
    winsize size{};
    const int columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
    const int width = std::clamp(columns - 30, 10, 50);
    const int full = static_cast<int>(std::clamp(done, 0.0, 1.0) * width);
    fmt::print(stderr, "\r\033[K{:<14} [{:#<{}}{:.<{}}] {:3.0f} %", stage, "", full, "", width - full,
               100 * std::clamp(done, 0.0, 1.0));
    std::fflush(stderr);
    dirty_ = true;
}

void ProgressBar::clear() {
    if (dirty_) fmt::print(stderr, "\r\033[K");
    dirty_ = false;
}

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

std::string with_commas(std::uint64_t number) {
    std::string digits = std::to_string(number);
    for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
    return digits;
}

CLI::Validator percents() {
    return CLI::Validator(
        [](std::string& text) -> std::string {
            if (text.empty() || text.back() != '%') return {};
            double percent = 0;
            const char* const end = text.data() + text.size() - 1;
            const auto [stop, fault] = std::from_chars(text.data(), end, percent);
            if (fault != std::errc{} || stop != end) return "'" + text + "' is no percentage";
            text = fmt::format("{}", percent / 100);
            return {};
        },
        "", "percents");
}

std::string short_number(double value) {
    return fmt::format("{:.3g}", value);
}

}  // namespace vsplit::app
