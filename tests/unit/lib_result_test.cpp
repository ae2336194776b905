// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <set>
#include <string>

#include "../../lib/bytes/checksum.hpp"
#include "family.hpp"
#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"
#include "vsplit/version.hpp"

using namespace vsplit;

TEST_CASE("A result holds its value or its error") {
    Result<int> seven = 7;
    REQUIRE(seven.ok());
    REQUIRE(static_cast<bool>(seven));
    REQUIRE(*seven == 7);
    const Result<int> failed = Error{ErrorCode::kTruncated, "ends", 12, 0};
    REQUIRE_FALSE(failed.ok());
    REQUIRE(failed.error().code == ErrorCode::kTruncated);
    REQUIRE(failed.error().offset == 12);
    REQUIRE(Status(Ok{}).ok());

    Result<std::unique_ptr<int>> moved = std::make_unique<int>(3);
    const std::unique_ptr<int> out = std::move(moved).value();
    REQUIRE(*out == 3);

    // An Error that is itself the value's type is no ambiguity.
    Result<std::string> text = std::string("yes");
    REQUIRE(text->size() == 3);
}

TEST_CASE("An error says where") {
    REQUIRE(Error{ErrorCode::kMalformed, "bad", 1234, 0}.describe() == "bad (offset 1234)");
    REQUIRE(Error{ErrorCode::kMalformed, "bad", Error::kNowhere, 12}.describe() == "bad (line 12)");
    REQUIRE(Error{ErrorCode::kMalformed, "bad", Error::kNowhere, 0}.describe() == "bad");
    REQUIRE(Error{ErrorCode::kMalformed, "bad", 0, 0}.describe() == "bad (offset 0)");
}

TEST_CASE("Error codes have stable names, each its own") {
    std::set<std::string> names;
    for (int code = 0; code <= int(ErrorCode::kCancelled); ++code)
        names.insert(error_code_name(static_cast<ErrorCode>(code)));
    REQUIRE(names == std::set<std::string>{"io", "unsupported", "truncated", "malformed", "checksum", "limit",
                                           "argument", "exists", "cancelled"});
}

TEST_CASE("The version is three numbers") {
    int a = -1, b = -1, c = -1;
    char rest = 0;
    REQUIRE(std::sscanf(version(), "%d.%d.%d%c", &a, &b, &c, &rest) == 3);
}

TEST_CASE("Checksums are XXH64 with seed 0") {
    const auto sum = [](const std::string& text) {
        return checksum64(std::as_bytes(std::span(text.data(), text.size())));
    };
    // Published by the reference implementation (xxhsum -H1) and its bindings' tests.
    REQUIRE(sum("") == 0xEF46DB3751D8E999u);
    REQUIRE(sum("a") == 0xD24EC4F1A98C6E5Bu);
    REQUIRE(sum("abc") == 0x44BC2CF5AD770999u);
    REQUIRE(sum("Nobody inspects the spammish repetition") == 0xFBCEA83C8A378BF1u);
    // Lengths around the borders of its loops: any change of a byte, and the length itself, changes the sum.
    for (const std::size_t length : {1u, 3u, 4u, 7u, 8u, 31u, 32u, 33u, 63u, 64u, 65u, 100u}) {
        CAPTURE(length);
        std::string text(length, 'x');
        const auto before = sum(text);
        REQUIRE(before != sum(text + 'x'));
        for (std::size_t i = 0; i < length; ++i) {
            text[i] ^= 1;
            REQUIRE(sum(text) != before);
            text[i] ^= 1;
        }
    }
}

TEST_CASE("mesh_fault names what is wrong") {
    for (const auto& [name, mesh] : test::mesh_family()) {
        CAPTURE(name);
        REQUIRE(mesh_fault(mesh) == nullptr);
    }
    const Mesh good{
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {1, 0, std::numeric_limits<float>::infinity()}};
    REQUIRE(mesh_fault(good) == nullptr);
    const auto fault = [&](auto change) {
        Mesh bad = good;
        change(bad);
        const char* text = mesh_fault(bad);
        return std::string(text ? text : "sound");
    };
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    REQUIRE(fault([&](Mesh& m) { m.positions[1].x = nan; }) == "a position is not finite");
    REQUIRE(fault([&](Mesh& m) { m.positions[1].y = inf; }) == "a position is not finite");
    REQUIRE(fault([&](Mesh& m) { m.positions[2].z = -inf; }) == "a position is not finite");
    REQUIRE(fault([&](Mesh& m) { m.triangles[0][2] = 3; }) ==
            "a triangle names a vertex that does not exist");
    REQUIRE(fault([&](Mesh& m) { m.triangles[0][0] = 0xFFFFFFFFu; }) ==
            "a triangle names a vertex that does not exist");
    for (const Triangle& t : {Triangle{0, 0, 1}, Triangle{0, 1, 1}, Triangle{1, 0, 1}})
        REQUIRE(fault([&](Mesh& m) { m.triangles[0] = t; }) == "a triangle names a vertex twice");
    REQUIRE(fault([&](Mesh& m) { m.weights.pop_back(); }) == "there are not as many weights as vertices");
    REQUIRE(fault([&](Mesh& m) { m.weights[0] = -1; }) == "a weight is negative or not a number");
    REQUIRE(fault([&](Mesh& m) { m.weights[0] = nan; }) == "a weight is negative or not a number");
}
