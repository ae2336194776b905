// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "folder.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace vsplit::app {
namespace {

bool may_be_named(std::string_view name) {
    return !name.empty() && name.front() != '.' && name.find('\0') == name.npos;
}

}  // namespace

Descriptor::~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
}

std::optional<Folder> Folder::open(const std::string& path) {
    Descriptor root(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!root) return std::nullopt;
    return Folder(std::move(root));
}

std::optional<OpenFile> Folder::find(const std::string& path) const {
    Descriptor at(::openat(root_.get(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    std::size_t begin = 0;
    while (at && begin < path.size()) {
        const std::size_t slash = path.find('/', begin);
        const std::string name = path.substr(begin, slash - begin);
        if (!may_be_named(name)) return std::nullopt;
        const bool last = slash == path.npos;
        // Without O_NONBLOCK a pipe among the files would hold the server.
        at = Descriptor(::openat(at.get(), name.c_str(),
                                 O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK | (last ? 0 : O_DIRECTORY)));
        begin = last ? path.size() : slash + 1;
    }
    struct stat status {};
    if (!at || ::fstat(at.get(), &status) != 0) return std::nullopt;
    if (!S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) return std::nullopt;
    OpenFile file;
    file.descriptor = std::move(at);
    file.folder = S_ISDIR(status.st_mode);
    file.size = static_cast<std::uint64_t>(status.st_size);
    file.modified = status.st_mtim;
    file.inode = status.st_ino;
    return file;
}

std::vector<Entry> Folder::list(const std::string& path, std::size_t most) const {
    std::vector<Entry> entries;
    auto file = find(path);
    if (!file || !file->folder) return entries;
    const int copy = ::fcntl(file->descriptor.get(), F_DUPFD_CLOEXEC, 0);
    DIR* stream = copy < 0 ? nullptr : ::fdopendir(copy);
    if (!stream) {
        if (copy >= 0) ::close(copy);
        return entries;
    }
    while (const dirent* found = ::readdir(stream)) {
        struct stat status {};
        if (entries.size() == most || !may_be_named(found->d_name)) continue;
        if (::fstatat(file->descriptor.get(), found->d_name, &status, AT_SYMLINK_NOFOLLOW) != 0) continue;
        if (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode))
            entries.push_back(
                {found->d_name, S_ISDIR(status.st_mode), static_cast<std::uint64_t>(status.st_size)});
    }
    ::closedir(stream);
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return a.folder != b.folder ? a.folder : a.name < b.name;
    });
    return entries;
}

std::string read_at(int descriptor, std::uint64_t offset, std::size_t size) {
    std::string bytes(size, '\0');
    std::size_t have = 0;
    while (have < size) {
        const ssize_t got =
            ::pread(descriptor, bytes.data() + have, size - have, static_cast<off_t>(offset + have));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        have += static_cast<std::size_t>(got);
    }
    bytes.resize(have);
    return bytes;
}

}  // namespace vsplit::app
