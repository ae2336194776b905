// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "file_server.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <thread>

#include "../command.hpp"
#include "assets.hpp"
#include "listing.hpp"
#include "ranges.hpp"
#include "vsplit/version.hpp"

namespace vsplit::app {
namespace {

// The connection that this thread serves: httplib hands errors to a handler that is not told.
thread_local Connection* current_connection = nullptr;

const char* mime_type(const std::string& path) {
    static constexpr std::pair<std::string_view, const char*> kTypes[] = {
        {".bin", "application/octet-stream"},
        {".css", "text/css; charset=utf-8"},
        {".glb", "model/gltf-binary"},
        {".gltf", "model/gltf+json"},
        {".html", "text/html; charset=utf-8"},
        {".jpg", "image/jpeg"},
        {".jpeg", "image/jpeg"},
        {".js", "text/javascript; charset=utf-8"},
        {".json", "application/json"},
        {".ktx2", "image/ktx2"},
        {".map", "application/json"},
        {".md", "text/markdown; charset=utf-8"},
        {".mjs", "text/javascript; charset=utf-8"},
        {".obj", "model/obj"},
        {".pmesh", "application/vnd.vsplit.pmesh"},
        {".png", "image/png"},
        {".stl", "model/stl"},
        {".svg", "image/svg+xml"},
        {".txt", "text/plain; charset=utf-8"},
        {".wasm", "application/wasm"},
        {".webp", "image/webp"}};
    const std::string extension = extension_of(path);
    for (const auto& [name, type] : kTypes)
        if (name == extension) return type;
    return "application/octet-stream";
}

std::string http_date(std::time_t time) {
    std::tm parts{};
    gmtime_r(&time, &parts);
    char text[64];
    std::strftime(text, sizeof text, "%a, %d %b %Y %H:%M:%S GMT", &parts);
    return text;
}

/// Whether a list of entity tags names this one; weak tags are as good as strong ones here (RFC
/// 9110, 13.1.2).
bool names_tag(std::string_view list, std::string_view tag) {
    if (list == "*") return true;
    for (std::size_t at = list.find(tag); at != list.npos; at = list.find(tag, at + 1)) {
        const std::size_t end = at + tag.size();
        if (end == list.size() || list[end] == ',' || list[end] == ' ') return true;
    }
    return false;
}

void say_plainly(httplib::Response& response, int status, const std::string& text) {
    response.status = status;
    response.set_content(text + "\n", "text/plain; charset=utf-8");
}

/// A response's body in pieces: text that frames parts, and stretches of the file.
struct Body {
    struct Piece {
        std::string text;
        ByteRange range;
        bool of_file = false;
    };
    std::vector<Piece> pieces;
    Descriptor file;

    std::uint64_t bytes() const {
        std::uint64_t sum = 0;
        for (const Piece& p : pieces) sum += p.of_file ? p.range.bytes() : p.text.size();
        return sum;
    }
    /// All in one go: httplib gives up between calls when the server stops.
    bool send(httplib::DataSink& sink) const {
        for (const Piece& piece : pieces) {
            if (!piece.of_file) {
                if (!sink.write(piece.text.data(), piece.text.size())) return false;
                continue;
            }
            constexpr std::uint64_t kChunk = 64 * 1024;
            for (std::uint64_t at = piece.range.first; at <= piece.range.last;) {
                const std::string chunk =
                    read_at(file.get(), at, std::size_t(std::min(kChunk, piece.range.last - at + 1)));
                // Shorter by now than when its length was told: the connection ends, and the other side sees
                // it.
                if (chunk.empty() || !sink.write(chunk.data(), chunk.size())) return false;
                at += chunk.size();
            }
        }
        return true;
    }
};

void send_body(httplib::Response& response, std::shared_ptr<const Body> body, const std::string& type) {
    if (body->pieces.empty()) return response.set_content("", type);
    response.set_content_provider(
        std::size_t(body->bytes()), type,
        [body](std::size_t, std::size_t, httplib::DataSink& sink) { return body->send(sink); });
}

}  // namespace

const Asset* find_asset(std::string_view name) {
    const auto assets = viewer_assets();
    const auto found =
        std::find_if(assets.begin(), assets.end(), [&](const Asset& a) { return a.name == name; });
    return found == assets.end() ? nullptr : &*found;
}

FileServer::FileServer(Folder folder, ServerOptions options)
    : folder_(std::move(folder)), options_(std::move(options)) {
    new_task_queue = [this] { return new httplib::ThreadPool(options_.connections); };
    // Not SO_REUSEPORT, with which a second server would share the port and take every other request.
    set_socket_options([this](socket_t socket) {
        listening_ = socket;
        const int yes = 1;
        setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    set_tcp_nodelay(true);
    set_keep_alive_max_count(options_.limits.requests);
    set_payload_max_length(0);
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
        answer(request, response);
        return HandlerResponse::Handled;
    });
    set_error_handler(HandlerWithResponse([this](const httplib::Request& request,
                                                 httplib::Response& response) {
        if (response.status == 416 && !response.has_header("Content-Range") && request.has_header("Range")) {
            // httplib refuses ranges in other units and of bad syntax; they are to be ignored (RFC
            // 9110, 14.2). What it took of them would be cut out of our answer.
            const_cast<httplib::Request&>(request).ranges.clear();
            response.status = -1;
            answer(request, response);
            if (response.status == -1) response.status = 200;
        } else if (response.body.empty() && !response.content_provider_) {
            add_cors(response);
            if (current_connection) {
                // Where its next request would begin, nobody knows.
                current_connection->give_up();
                response.set_header("Connection", "close");
                if (current_connection->too_large()) response.status = 431;
            }
            say_plainly(response, response.status,
                        response.status == 431   ? "The request is too long."
                        : response.status == 414 ? "The address is too long."
                                                 : "The request makes no sense.");
        }
        return HandlerResponse::Handled;
    }));
}

bool FileServer::queue_connections() {
    return ::listen(listening_, SOMAXCONN) == 0;
}

void FileServer::stop_gently(std::chrono::milliseconds grace) {
    // Connections that come meanwhile are closed unheard. httplib itself is told at the end only: from then
    // on it begins no body, not even of a response whose headers are out.
    stopping_ = 1;
    for (auto left = grace; left.count() > 0 && busy_ > 0 && stopping_ == 1;
         left -= std::chrono::milliseconds(20))
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    stopping_ = 2;
    stop();
}
void FileServer::stop_hard() {
    stopping_ = 2;
}

bool FileServer::process_and_close_socket(socket_t socket) {
    ++busy_;
    Connection connection(socket, options_.limits, stopping_, busy_);
    current_connection = &connection;
    bool closed = false;
    for (std::size_t left = options_.limits.requests; left > 0 && !closed; --left) {
        if (!connection.wait_for_request()) break;
        const bool done = process_request(connection, left == 1, closed, [&](httplib::Request& request) {
            // Ranges are cut by us: httplib would cut them again.
            request.ranges.clear();
            // A body that nobody reads must not be taken for the next request.
            if (request.has_header("Transfer-Encoding") ||
                request.get_header_value("Content-Length", 0).size() > 0) {
                closed = true;
                request.headers.erase("Connection");
                request.set_header("Connection", "close");
            }
        });
        if (!done || connection.given_up()) break;
    }
    current_connection = nullptr;
    // Closing while bytes lie unread would reset the connection and may take our answer along.
    ::shutdown(socket, SHUT_WR);
    char rest[4096];
    timeval patience{0, 100 * 1000};
    setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    for (int i = 0; i < 16 && stopping_ == 0 && ::recv(socket, rest, sizeof rest, 0) > 0; ++i) {
    }
    ::close(socket);
    --busy_;
    return true;
}

void FileServer::add_cors(httplib::Response& response) const {
    response.set_header("X-Content-Type-Options", "nosniff");
    if (options_.allowed_origin.empty()) return;
    response.set_header("Access-Control-Allow-Origin", options_.allowed_origin);
    if (options_.allowed_origin != "*") response.set_header("Vary", "Origin");
    response.set_header("Access-Control-Expose-Headers",
                        "Accept-Ranges, Content-Length, Content-Range, ETag, Last-Modified");
    response.set_header("Cross-Origin-Resource-Policy", "cross-origin");
    response.set_header("Timing-Allow-Origin", options_.allowed_origin);
}

void FileServer::answer(const httplib::Request& request, httplib::Response& response) const {
    add_cors(response);
    if (request.method == "OPTIONS") {
        response.set_header("Allow", "GET, HEAD, OPTIONS");
        response.set_header("Access-Control-Allow-Methods", "GET, HEAD, OPTIONS");
        response.set_header("Access-Control-Allow-Headers",
                            "Range, If-Range, If-None-Match, If-Modified-Since");
        response.set_header("Access-Control-Max-Age", "86400");
        response.status = 204;
        return;
    }
    if (request.method != "GET" && request.method != "HEAD") {
        response.set_header("Allow", "GET, HEAD, OPTIONS");
        return say_plainly(response, 405, "This server only gives.");
    }
    if (request.path.empty() || request.path.front() != '/')
        return say_plainly(response, 400, "A path begins with a slash.");
    const std::string path = request.path.substr(1);
    const std::string viewer = std::string(kViewerPath).substr(1);
    if (path.starts_with(viewer)) return answer_viewer(request, response, path.substr(viewer.size()));
    errno = 0;
    auto file = folder_.find(path);
    if (!file && (errno == EMFILE || errno == ENFILE))
        return say_plainly(response, 503, "Too many files are open. Try again.");
    if (!file) return say_plainly(response, 404, "There is no such file here.");
    if (!file->folder) return answer_file(request, response, std::move(*file), path);
    if (!path.empty() && path.back() != '/')
        return response.set_redirect("/" + encoded_path(path) + "/", 301);
    if (auto index = folder_.find(path + "index.html"); index && !index->folder)
        return answer_file(request, response, std::move(*index), path + "index.html");
    response.set_header("Cache-Control", "no-cache");
    response.set_header(
        "Content-Security-Policy",
        "default-src 'self'; connect-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; "
        "script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob:; img-src 'self' data: blob:");
    response.status = 200;
    response.set_content(listing_page(folder_, path), "text/html; charset=utf-8");
}

void FileServer::answer_file(const httplib::Request& request, httplib::Response& response, OpenFile file,
                             const std::string& path) const {
    const std::string tag = fmt::format("\"{:x}-{:x}-{:x}-{:x}\"", file.size, file.modified.tv_sec,
                                        file.modified.tv_nsec, file.inode);
    const std::string date = http_date(file.modified.tv_sec);
    response.set_header("ETag", tag);
    response.set_header("Last-Modified", date);
    response.set_header("Accept-Ranges", "bytes");
    // A stream that a proxy compresses has no ranges any more.
    response.set_header("Cache-Control", "no-cache, no-transform");
    if (request.has_header("If-None-Match") ? names_tag(request.get_header_value("If-None-Match"), tag)
                                            : request.get_header_value("If-Modified-Since") == date) {
        response.status = 304;
        return;
    }
    const std::string type = mime_type(path);
    auto body = std::make_shared<Body>();
    std::optional<std::vector<ByteRange>> asked;
    const bool still_the_same = !request.has_header("If-Range") ||
                                request.get_header_value("If-Range") == tag ||
                                request.get_header_value("If-Range") == date;
    if (request.has_header("Range") && still_the_same)
        asked = parse_ranges(request.get_header_value("Range"), file.size);
    if (asked && asked->empty()) {
        response.set_header("Content-Range", fmt::format("bytes */{}", file.size));
        return say_plainly(response, 416, "The file is shorter than that.");
    }
    body->file = std::move(file.descriptor);
    const auto place = [&](const ByteRange& r) {
        return fmt::format("bytes {}-{}/{}", r.first, r.last, file.size);
    };
    if (!asked) {
        response.status = 200;
        if (file.size > 0) body->pieces.push_back({"", {0, file.size - 1}, true});
        return send_body(response, body, type);
    }
    response.status = 206;
    if (asked->size() == 1) {
        response.set_header("Content-Range", place(asked->front()));
        body->pieces.push_back({"", asked->front(), true});
        return send_body(response, body, type);
    }
    // Not in any file but by intent: those who ask for several ranges read lengths anyway.
    const std::string boundary = fmt::format("vsplit-{:x}-{:x}", file.inode, file.modified.tv_nsec);
    for (const ByteRange& range : *asked) {
        body->pieces.push_back({fmt::format("\r\n--{}\r\nContent-Type: {}\r\nContent-Range: {}\r\n\r\n",
                                            boundary, type, place(range)),
                                {},
                                false});
        body->pieces.push_back({"", range, true});
    }
    body->pieces.push_back({fmt::format("\r\n--{}--\r\n", boundary), {}, false});
    send_body(response, body, "multipart/byteranges; boundary=" + boundary);
}

void FileServer::answer_viewer(const httplib::Request& request, httplib::Response& response,
                               const std::string& name) const {
    const Asset* asset = find_asset(name.empty() ? "index.html" : name);
    if (!asset)
        return say_plainly(response, 404,
                           viewer_assets().empty()
                               ? "This build of vsplit comes without the viewer: ./run web builds it."
                               : "The viewer has no such file.");
    const std::string tag =
        fmt::format("\"{}-{:x}\"", vsplit::version(), std::hash<std::string_view>{}(asset->bytes));
    response.set_header("ETag", tag);
    response.set_header("Cache-Control", "no-cache");
    if (names_tag(request.get_header_value("If-None-Match"), tag)) {
        response.status = 304;
        return;
    }
    response.status = 200;
    const std::string_view bytes = asset->bytes;
    response.set_content_provider(bytes.size(), mime_type(std::string(asset->name)),
                                  [bytes](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                      return sink.write(bytes.data() + offset, length);
                                  });
}

}  // namespace vsplit::app
