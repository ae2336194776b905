// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "checksum.hpp"

#include <bit>

#include "layout.hpp"

namespace vsplit {
namespace {

constexpr std::uint64_t kPrime1 = 0x9E3779B185EBCA87u, kPrime2 = 0xC2B2AE3D27D4EB4Fu,
                        kPrime3 = 0x165667B19E3779F9u, kPrime4 = 0x85EBCA77C2B2AE63u,
                        kPrime5 = 0x27D4EB2F165667C5u;

std::uint64_t round(std::uint64_t sum, std::uint64_t lane) {
    return std::rotl(sum + lane * kPrime2, 31) * kPrime1;
}

}  // namespace

std::uint64_t checksum64(std::span<const std::byte> bytes) {
    const std::size_t size = bytes.size();
    std::size_t at = 0;
    std::uint64_t sum = kPrime5;
    if (size >= 32) {
        std::uint64_t lanes[4] = {kPrime1 + kPrime2, kPrime2, 0, 0 - kPrime1};
        for (; at + 32 <= size; at += 32)
            for (std::size_t i = 0; i < 4; ++i)
                lanes[i] = round(lanes[i], get<std::uint64_t>(bytes, at + 8 * i));
        sum = std::rotl(lanes[0], 1) + std::rotl(lanes[1], 7) + std::rotl(lanes[2], 12) +
              std::rotl(lanes[3], 18);
        for (const std::uint64_t lane : lanes) sum = (sum ^ round(0, lane)) * kPrime1 + kPrime4;
    }
    sum += size;
    for (; at + 8 <= size; at += 8)
        sum = std::rotl(sum ^ round(0, get<std::uint64_t>(bytes, at)), 27) * kPrime1 + kPrime4;
    if (at + 4 <= size) {
        sum = std::rotl(sum ^ (get<std::uint32_t>(bytes, at) * kPrime1), 23) * kPrime2 + kPrime3;
        at += 4;
    }
    for (; at < size; ++at)
        sum = std::rotl(sum ^ (static_cast<std::uint64_t>(bytes[at]) * kPrime5), 11) * kPrime1;
    sum = (sum ^ (sum >> 33)) * kPrime2;
    sum = (sum ^ (sum >> 29)) * kPrime3;
    return sum ^ (sum >> 32);
}

}  // namespace vsplit
