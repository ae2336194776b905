// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// One connection of `vsplit serve`, with a limit on all that the other side can make the server wait for or
// keep.
#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>

namespace vsplit::app {

struct ConnectionLimits {
    std::size_t request_bytes = 16 * 1024;           ///< Of a request line and all its headers.
    std::chrono::milliseconds request_time{10'000};  ///< From its first byte to its last.
    std::chrono::milliseconds idle_time{5'000};      ///< Between requests.
    std::chrono::milliseconds stall_time{30'000};    ///< That the other side may take no byte.
    std::uint64_t slowest = 256;  ///< Bytes a second of a response, on average, once it took stall_time.
    std::size_t requests = 1000;  ///< Of one connection.
    int crowd = 64;               ///< With more connections than that, all of the times above are
    int crowded_share = 10;       ///< divided by this, so that those who wait come to their turn.
};

/// Set by the one who stops the server: 1 lets responses that are on their way come to their end, 2 does not.
using Stopping = std::atomic<int>;

/// httplib's stream over a socket, which it does not own.
class Connection final : public httplib::Stream {
  public:
    /// `busy` counts the connections that are being served.
    Connection(socket_t socket, const ConnectionLimits& limits, const Stopping& stopping,
               const std::atomic<int>& busy);

    /// Waits for a request to begin: false if none does, or the server stops.
    bool wait_for_request();

    bool is_readable() const override;
    bool is_writable() const override;
    ssize_t read(char* bytes, std::size_t size) override;
    ssize_t write(const char* bytes, std::size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    socket_t socket() const override { return socket_; }

    /// True if the request was cut off by a limit of its size.
    bool too_large() const { return too_large_; }
    /// No request is to follow the one that is being answered.
    void give_up() { given_up_ = true; }
    bool given_up() const { return given_up_; }

  private:
    using Clock = std::chrono::steady_clock;
    /// Whether the socket is ready within `patience` of `since`; looks in between whether the server stops or
    /// is crowded.
    bool wait(short event, Clock::time_point since, std::chrono::milliseconds patience, int stop_at) const;
    std::chrono::milliseconds now_patient(std::chrono::milliseconds patience) const {
        return busy_ > limits_.crowd ? patience / limits_.crowded_share : patience;
    }

    socket_t socket_;
    const ConnectionLimits& limits_;
    const Stopping& stopping_;
    const std::atomic<int>& busy_;
    std::size_t received_ = 0;
    std::uint64_t sent_ = 0;
    bool too_large_ = false, given_up_ = false;
    Clock::time_point request_began_, response_began_;
    // httplib reads headers byte by byte.
    char buffer_[4096];
    std::size_t begin_ = 0, end_ = 0;
};

}  // namespace vsplit::app
