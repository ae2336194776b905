// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/bake/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace vsplit::bake {
namespace {

Error io_error(const char* doing) {
    return {ErrorCode::kIo, std::string("cannot ") + doing + ": " + std::strerror(errno), Error::kNowhere, 0};
}

/// Closes on every way out.
struct FileDescriptor {
    int fd = -1;
    ~FileDescriptor() {
        if (fd >= 0) ::close(fd);
    }
};

bool write_all(int fd, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t n =
            ::write(fd, bytes.data(), std::min<std::size_t>(bytes.size(), std::size_t{1} << 30));
        if (n < 0) {
            if (errno == EINTR) continue;
            return false;
        }
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return true;
}

}  // namespace

Result<std::vector<std::byte>> read_file(const std::string& path, std::uint64_t max_bytes) {
    FileDescriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    if (file.fd < 0) return io_error("open");
    struct stat info {};
    if (::fstat(file.fd, &info) != 0) return io_error("read");
    if (S_ISDIR(info.st_mode))
        return Error{ErrorCode::kIo, "cannot read: it is a folder", Error::kNowhere, 0};
    std::vector<std::byte> bytes;
    const auto announced = S_ISREG(info.st_mode) ? static_cast<std::uint64_t>(info.st_size) : 0;
    const auto too_long = [&] {
        return Error{ErrorCode::kLimit, "longer than the limit of " + std::to_string(max_bytes) + " bytes",
                     Error::kNowhere, 0};
    };
    if (announced > max_bytes) return too_long();
    // One byte more than announced, so that a whole regular file ends in a single short read.
    bytes.resize(announced + 1);
    std::size_t size = 0;
    for (;;) {
        if (size == bytes.size()) bytes.resize(bytes.size() + std::max<std::size_t>(bytes.size() / 2, 65536));
        const ssize_t n = ::read(file.fd, bytes.data() + size,
                                 std::min<std::size_t>(bytes.size() - size, std::size_t{1} << 30));
        if (n < 0) {
            if (errno == EINTR) continue;
            return io_error("read");
        }
        if (n == 0) break;
        size += static_cast<std::size_t>(n);
        if (size > max_bytes) return too_long();
    }
    bytes.resize(size);
    return bytes;
}

Status write_file(const std::string& path, std::span<const std::byte> bytes, bool overwrite) {
    struct stat info {};
    if (::stat(path.c_str(), &info) == 0) {
        if (S_ISDIR(info.st_mode))
            return Error{ErrorCode::kIo, "cannot write: it is a folder", Error::kNowhere, 0};
        if (!S_ISREG(info.st_mode)) {
            FileDescriptor file{::open(path.c_str(), O_WRONLY | O_CLOEXEC)};
            if (file.fd < 0 || !write_all(file.fd, bytes)) return io_error("write");
            return Ok{};
        }
        if (!overwrite)
            return Error{ErrorCode::kExists, "exists already; pass --force to overwrite it", Error::kNowhere,
                         0};
    }
    std::string temporary = path + ".XXXXXX.tmp";
    FileDescriptor file{::mkstemps(temporary.data(), 4)};
    if (file.fd < 0) return io_error("create a file beside it");
    const auto fail = [&](const char* doing) {
        Error error = io_error(doing);
        ::unlink(temporary.c_str());
        return error;
    };
    const mode_t mask = ::umask(0);
    ::umask(mask);
    if (!write_all(file.fd, bytes)) return fail("write");
    if (::fchmod(file.fd, 0666 & ~mask) != 0 || ::fsync(file.fd) != 0) return fail("write");
    // Without --force a file that appeared meanwhile is kept: link() fails where rename() would replace.
    if (overwrite) {
        if (::rename(temporary.c_str(), path.c_str()) != 0) return fail("rename into place");
    } else {
        if (::link(temporary.c_str(), path.c_str()) != 0) {
            const bool exists = errno == EEXIST;
            // Some file systems have no hard links; there the check above is all there is.
            if (exists || ::rename(temporary.c_str(), path.c_str()) != 0) {
                Error error = fail("rename into place");
                if (exists) error.code = ErrorCode::kExists;
                return error;
            }
            return Ok{};
        }
        ::unlink(temporary.c_str());
    }
    return Ok{};
}

}  // namespace vsplit::bake
