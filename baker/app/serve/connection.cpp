// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "connection.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace vsplit::app {

Connection::Connection(socket_t socket, const ConnectionLimits& limits, const Stopping& stopping,
                       const std::atomic<int>& busy)
    : socket_(socket), limits_(limits), stopping_(stopping), busy_(busy), request_began_(Clock::now()) {}

bool Connection::wait(short event, Clock::time_point since, std::chrono::milliseconds patience,
                      int stop_at) const {
    while (stopping_ < stop_at) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
                              since + now_patient(patience) - Clock::now())
                              .count();
        if (left <= 0) return false;
        pollfd poll{socket_, event, 0};
        const int ready = ::poll(&poll, 1, static_cast<int>(std::min<long long>(left, 100)));
        if (ready > 0) return true;
        if (ready < 0 && errno != EINTR) return false;
    }
    return false;
}

bool Connection::wait_for_request() {
    if (begin_ == end_ && !wait(POLLIN, Clock::now(), limits_.idle_time, 1)) return false;
    received_ = 0;
    sent_ = 0;
    request_began_ = Clock::now();
    return true;
}

bool Connection::is_readable() const {
    return begin_ < end_ || wait(POLLIN, request_began_, limits_.request_time, 1);
}
bool Connection::is_writable() const {
    return wait(POLLOUT, Clock::now(), limits_.stall_time, 2);
}

ssize_t Connection::read(char* bytes, std::size_t size) {
    if (received_ >= limits_.request_bytes) {
        too_large_ = true;
        return -1;
    }
    size = std::min(size, limits_.request_bytes - received_);
    if (begin_ == end_) {
        if (!is_readable()) return -1;
        const ssize_t got = ::recv(socket_, buffer_, sizeof buffer_, 0);
        if (got <= 0) return got;
        begin_ = 0;
        end_ = static_cast<std::size_t>(got);
    }
    const std::size_t taken = std::min(size, end_ - begin_);
    std::memcpy(bytes, buffer_ + begin_, taken);
    begin_ += taken;
    received_ += taken;
    return static_cast<ssize_t>(taken);
}

ssize_t Connection::write(const char* bytes, std::size_t size) {
    if (sent_ == 0) response_began_ = Clock::now();
    const auto taken = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - response_began_);
    if (taken > now_patient(limits_.stall_time) &&
        sent_ < limits_.slowest * static_cast<std::uint64_t>(taken.count()) / 1000)
        return -1;
    if (!is_writable()) return -1;
    const ssize_t sent = ::send(socket_, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
    if (sent > 0) sent_ += static_cast<std::uint64_t>(sent);
    return sent;
}

// Nobody asks who is there.
void Connection::get_remote_ip_and_port(std::string&, int&) const {}
void Connection::get_local_ip_and_port(std::string&, int&) const {}

}  // namespace vsplit::app
