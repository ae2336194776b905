// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What `vsplit serve` answers: files of one folder with ranges, its listing, and the viewer.
#pragma once

#include <httplib.h>

#include "connection.hpp"
#include "folder.hpp"

namespace vsplit::app {

struct ServerOptions {
    std::string allowed_origin = "*";  ///< Pages of which other origin may read; empty for none.
    std::size_t connections = 256;     ///< Served at once; others wait.
    ConnectionLimits limits;
};

/// Bind and listen as of httplib::Server. Read-only: GET, HEAD and OPTIONS.
class FileServer final : public httplib::Server {
  public:
    FileServer(Folder folder, ServerOptions options);

    /// Once it is bound: many connections may come at once. httplib lets five wait; others try again a second
    /// later.
    bool queue_connections();
    /// From another thread: no more requests; responses that are on their way have `grace`, then are cut.
    void stop_gently(std::chrono::milliseconds grace);
    /// From another thread: now.
    void stop_hard();

  private:
    bool process_and_close_socket(socket_t socket) override;
    void answer(const httplib::Request& request, httplib::Response& response) const;
    void answer_file(const httplib::Request& request, httplib::Response& response, OpenFile file,
                     const std::string& path) const;
    void answer_viewer(const httplib::Request& request, httplib::Response& response,
                       const std::string& name) const;
    void add_cors(httplib::Response& response) const;

    Folder folder_;
    ServerOptions options_;
    Stopping stopping_{0};
    std::atomic<int> busy_{0};
    socket_t listening_ = INVALID_SOCKET;
};

}  // namespace vsplit::app
