// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <thread>

#include "command.hpp"
#include "serve/assets.hpp"
#include "serve/file_server.hpp"

namespace vsplit::app {
namespace {

struct ServeCommand {
    Common common;
    std::string folder = ".", host = "127.0.0.1", origin = "*";
    int port = 8000;
    int run() const;
};

/// Stops the server at SIGINT or SIGTERM, gently at first, at once when told again. Signals must be blocked
/// in every thread, so it is made before the server makes any.
class SignalWatch {
  public:
    SignalWatch() {
        sigemptyset(&signals_);
        sigaddset(&signals_, SIGINT);
        sigaddset(&signals_, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &signals_, &before_);
    }
    void start(FileServer& server) {
        thread_ = std::thread([this, &server] {
            int signal = 0;
            sigwait(&signals_, &signal);
            if (over_) return;
            std::thread gently([&] { server.stop_gently(std::chrono::seconds(5)); });
            sigwait(&signals_, &signal);
            if (!over_) server.stop_hard();
            gently.join();
        });
    }
    ~SignalWatch() {
        over_ = true;
        if (thread_.joinable()) {
            pthread_kill(thread_.native_handle(), SIGTERM);
            thread_.join();
        }
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }

  private:
    sigset_t signals_, before_;
    std::atomic<bool> over_{false};
    std::thread thread_;
};

int ServeCommand::run() const {
    auto opened = Folder::open(folder);
    if (!opened)
        return fail_input(folder,
                          {ErrorCode::kIo, std::string("cannot open the folder: ") + std::strerror(errno),
                           Error::kNowhere, 0});
    ServerOptions options;
    options.allowed_origin = origin == "none" ? "" : origin;
    // Each connection is one file, and each answer another.
    if (rlimit files{}; getrlimit(RLIMIT_NOFILE, &files) == 0) {
        files.rlim_cur = files.rlim_max;
        setrlimit(RLIMIT_NOFILE, &files);
    }
    SignalWatch watch;
    FileServer server(std::move(*opened), options);
    const int bound = port == 0 ? server.bind_to_any_port(host) : server.bind_to_port(host, port) ? port : -1;
    if (bound < 0 || !server.queue_connections()) {
        fmt::print(stderr, "vsplit: cannot listen on {} port {}: {}\n", host, port,
                   errno != 0 ? std::strerror(errno) : "no such address");
        return kFailed;
    }
    const std::string shown = host.find(':') == host.npos ? host : "[" + host + "]";
    const std::string url = fmt::format("http://{}:{}/", shown, bound);
    const bool viewer = !viewer_assets().empty();
    if (common.json)
        print_json({{"url", url}, {"host", host}, {"port", bound}, {"folder", folder}, {"viewer", viewer}});
    say(common, fmt::format("{} is served at {}{}  (Ctrl-C ends it)", folder, url,
                            viewer ? "" : ", without the viewer (./run web builds it)"));
    if (!common.quiet && !common.json && host != "127.0.0.1" && host != "::1" && host != "localhost")
        say(common, "Everybody who can reach this machine at that address can read the folder.");
    std::fflush(stdout);
    watch.start(server);
    return server.listen_after_bind() ? kDone : kFailed;
}

}  // namespace

void add_serve(CLI::App& app, int& exit) {
    auto command = std::make_shared<ServeCommand>();
    CLI::App* sub = app.add_subcommand(
        "serve",
        "Serve a folder of models over HTTP, with ranges, a page that lists them, and the web viewer");
    sub->footer("Example:\n  vsplit serve models --port 8000");
    sub->add_option("folder", command->folder,
                    "The folder; nothing outside of it, behind a symbolic link or "
                    "with a name that begins with a dot is given")
        ->capture_default_str()
        ->type_name("DIR");
    sub->add_option("--port", command->port, "0 for any that is free")
        ->capture_default_str()
        ->check(CLI::Range(0, 65535));
    sub->add_option("--host", command->host, "The address to listen on; 0.0.0.0 for all of this machine's")
        ->capture_default_str();
    sub->add_option("--cors", command->origin,
                    "Pages of which origin may read: * for any, none, or one origin")
        ->capture_default_str();
    command->common.add_to(*sub);
    sub->callback([command, &exit] { exit = command->run(); });
}

}  // namespace vsplit::app
