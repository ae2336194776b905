// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "vsplit/bake/files.hpp"

using namespace vsplit;
using namespace vsplit::bake;
namespace fs = std::filesystem;

namespace {

/// A folder that goes with the test.
struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "vsplit-files-XXXXXX").string();
        path = ::mkdtemp(name.data());
    }
    ~Folder() {
        fs::permissions(path, fs::perms::owner_all);
        fs::remove_all(path);
    }
    std::string operator/(const char* name) const { return (path / name).string(); }
    std::size_t count() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(path), fs::directory_iterator()));
    }
};

std::vector<std::byte> bytes_of(std::size_t n, unsigned seed) {
    std::vector<std::byte> bytes(n);
    for (std::size_t i = 0; i < n; ++i) bytes[i] = std::byte(static_cast<unsigned char>(i * 131 + seed));
    return bytes;
}

}  // namespace

TEST_CASE("A file comes back as it was written, and nothing stays beside it") {
    const Folder folder;
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{65536}, std::size_t{3'000'001}}) {
        const auto bytes = bytes_of(n, 7);
        REQUIRE(write_file(folder / "a.bin", bytes, true).ok());
        const auto back = read_file(folder / "a.bin");
        REQUIRE(back.ok());
        CHECK(*back == bytes);
    }
    CHECK(folder.count() == 1);
}

TEST_CASE("Without permission to overwrite, an existing file keeps its bytes") {
    const Folder folder;
    const auto first = bytes_of(100, 1), second = bytes_of(50, 2);
    REQUIRE(write_file(folder / "a.bin", first, false).ok());
    const Status refused = write_file(folder / "a.bin", second, false);
    REQUIRE(!refused.ok());
    CHECK(refused.error().code == ErrorCode::kExists);
    CHECK(*read_file(folder / "a.bin") == first);
    REQUIRE(write_file(folder / "a.bin", second, true).ok());
    CHECK(*read_file(folder / "a.bin") == second);
    CHECK(folder.count() == 1);
}

TEST_CASE("A file that another one is reading is replaced, not rewritten") {
    const Folder folder;
    const auto first = bytes_of(1000, 1), second = bytes_of(1000, 2);
    REQUIRE(write_file(folder / "a.bin", first, false).ok());
    std::ifstream reader(folder / "a.bin", std::ios::binary);
    REQUIRE(write_file(folder / "a.bin", second, true).ok());
    std::string seen(1000, '\0');
    reader.read(seen.data(), 1000);
    CHECK(std::equal(seen.begin(), seen.end(), reinterpret_cast<const char*>(first.data())));
}

TEST_CASE("New files have the permissions that the user's mask grants") {
    const Folder folder;
    const mode_t before = ::umask(027);
    const bool written = write_file(folder / "a.bin", bytes_of(3, 0), false).ok();
    ::umask(before);
    REQUIRE(written);
    CHECK((fs::status(folder / "a.bin").permissions() & fs::perms::all) == fs::perms(0640));
}

TEST_CASE("What cannot be read or written says why") {
    const Folder folder;
    const auto missing = read_file(folder / "missing.obj");
    REQUIRE(!missing.ok());
    CHECK(missing.error().code == ErrorCode::kIo);
    CHECK(missing.error().message.find("No such file") != std::string::npos);
    CHECK(read_file(folder.path.string()).error().code == ErrorCode::kIo);
    CHECK(write_file(folder.path.string(), {}, true).error().code == ErrorCode::kIo);
    CHECK(write_file(folder / "no/such/folder.bin", {}, true).error().code == ErrorCode::kIo);
    CHECK(folder.count() == 0);
}

TEST_CASE("An unwritable folder yields an error and no file") {
    if (::geteuid() == 0) {
        // Root may write anywhere but here.
        const Status status = write_file("/proc/vsplit-cannot-write", bytes_of(4, 0), true);
        REQUIRE(!status.ok());
        CHECK(status.error().code == ErrorCode::kIo);
        return;
    }
    const Folder folder;
    fs::permissions(folder.path, fs::perms::owner_read | fs::perms::owner_exec);
    const Status status = write_file(folder / "a.bin", bytes_of(4, 0), true);
    REQUIRE(!status.ok());
    CHECK(status.error().code == ErrorCode::kIo);
    CHECK(folder.count() == 0);
}

TEST_CASE("A limit is kept, for files and for endless devices") {
    const Folder folder;
    REQUIRE(write_file(folder / "a.bin", bytes_of(1000, 0), false).ok());
    CHECK(read_file(folder / "a.bin", 1000).ok());
    CHECK(read_file(folder / "a.bin", 999).error().code == ErrorCode::kLimit);
    CHECK(read_file("/dev/zero", 1'000'000).error().code == ErrorCode::kLimit);
}

TEST_CASE("Devices are written straight") {
    CHECK(write_file("/dev/null", bytes_of(100, 0), false).ok());
    CHECK(read_file("/dev/null")->empty());
    // A full device takes nothing, and that is an error.
    if (fs::exists("/dev/full"))
        CHECK(write_file("/dev/full", bytes_of(100, 0), false).error().code == ErrorCode::kIo);
}
