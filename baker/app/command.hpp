// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What all subcommands share: options, messages, exit codes.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vsplit/bake/progress.hpp"
#include "vsplit/progressive_mesh.hpp"
#include "vsplit/read.hpp"
#include "vsplit/result.hpp"

namespace vsplit::app {

/// Exit codes, stable (docs/cli.md).
enum Exit : int {
    kDone = 0,
    kFailed = 1,     ///< A check did not pass (verify), or the work was interrupted.
    kUsage = 2,      ///< The command line is wrong.
    kBadInput = 3,   ///< An input cannot be opened, or is not what it should be.
    kBadOutput = 4,  ///< An output exists (and no --force), or cannot be written.
};

/// Ordered, so that output keeps the order in which it is said.
using Json = nlohmann::ordered_json;

/// Options of every subcommand.
struct Common {
    bool json = false;
    bool quiet = false;
    int threads = 0;
    void add_to(CLI::App& command);
};
/// And of those that write a file.
struct Output {
    std::string path;
    bool force = false;
    void add_to(CLI::App& command, const char* what, bool required = true);
};

/// One line on stderr, "vsplit: FILE: message", and its exit code: kBadInput, or kUsage for kArgument.
int fail_input(const std::string& file, const Error& error);
/// The same with kBadOutput.
int fail_output(const std::string& file, const Error& error);
int fail_usage(const std::string& message);

/// Refuses early what write_output() would refuse late: an existing file without --force, a folder that is
/// not there.
int check_output(const Output& output);
int write_output(const Output& output, std::span<const std::byte> bytes);

/// Writes to stdout unless --quiet; with --json only print_json() speaks.
void say(const Common& common, const std::string& text);
void print_json(const Json& json);

/// A bar on stderr, if that is a terminal and nobody asked for silence; it clears itself.
class ProgressBar {
  public:
    explicit ProgressBar(const Common& common);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    /// To hand to a stage.
    bake::Progress callback();

  private:
    void draw(std::string_view stage, double done);
    void clear();
    bool shown_ = false;
    bool dirty_ = false;
    double last_ = 0;
};

/// ".ply", lower case, of "Dir/Name.PLY".
std::string extension_of(const std::string& path);
/// "1,234,567".
std::string with_commas(std::uint64_t number);
/// Three significant digits, no exponent where it can be helped.
std::string short_number(double value);

/// Lets a ratio be said as "7.3%", too: what stands before the sign is divided by 100. Goes before a range
/// check.
CLI::Validator percents();

/// Each registers one subcommand whose callback sets `exit`.
void add_bake(CLI::App& app, int& exit);
void add_reconstruct(CLI::App& app, int& exit);
void add_info(CLI::App& app, int& exit);
void add_extract(CLI::App& app, int& exit);
void add_lods(CLI::App& app, int& exit);
void add_verify(CLI::App& app, int& exit);
void add_sample(CLI::App& app, int& exit);
void add_serve(CLI::App& app, int& exit);
void add_studio(CLI::App& app, int& exit);  // viewer/desktop/app
void add_render(CLI::App& app, int& exit);  // only with VSPLIT_VIEWER

}  // namespace vsplit::app
