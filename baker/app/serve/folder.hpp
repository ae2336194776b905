// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The folder that is served, and nothing outside of it.
#pragma once

#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vsplit::app {

/// A file descriptor; closes it.
class Descriptor {
  public:
    explicit Descriptor(int fd = -1) : fd_(fd) {}
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }
    ~Descriptor();
    int get() const { return fd_; }
    explicit operator bool() const { return fd_ >= 0; }

  private:
    int fd_;
};

struct OpenFile {
    Descriptor descriptor;
    bool folder = false;
    std::uint64_t size = 0;
    std::timespec modified{};
    std::uint64_t inode = 0;
};

struct Entry {
    std::string name;
    bool folder = false;
    std::uint64_t size = 0;
};

/// Opens by walking down name by name. A name that is empty, "." or "..", begins with a dot, or is a symbolic
/// link is not there: neither a clever path nor a link leads out, and no race between look and use does.
class Folder {
  public:
    static std::optional<Folder> open(const std::string& path);

    /// `path` is decoded, with slashes, without one in front. Nothing unless it is a regular file or a folder
    /// that may be read.
    std::optional<OpenFile> find(const std::string& path) const;
    /// What find() would find in there, sorted, folders first; at most `most` of them.
    std::vector<Entry> list(const std::string& path, std::size_t most) const;

  private:
    explicit Folder(Descriptor root) : root_(std::move(root)) {}
    Descriptor root_;
};

/// Up to `size` bytes from `offset`; fewer at the end or on an error.
std::string read_at(int descriptor, std::uint64_t offset, std::size_t size);

}  // namespace vsplit::app
