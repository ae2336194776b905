// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What to expect of an answer before any is heard: the odds that a vertex splits are the product of what each
// part of the answer's context says, measured over twelve meshes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "range_coder.hpp"

namespace vsplit {

/// Odds in 1/1024, by the parts of a context.
inline constexpr std::array<std::uint16_t, 8> kRoundStarOdds = {187, 75, 150, 384, 994, 1543, 1775, 1439};
inline constexpr std::array<std::uint16_t, 18> kRoundAgeOdds = {
    377, 362, 404, 634, 493, 736, 1024, 1024, 634, 1024, 917, 1024, 1024, 1024, 1024, 1024, 451, 1024};
inline constexpr std::array<std::uint16_t, 10> kRoundBumpOdds = {178, 299, 369,  425,  540,
                                                                 700, 864, 1004, 1120, 1098};
inline constexpr std::array<std::uint16_t, 10> kBatchStarOdds = {105,  48,   91,   334,  1066,
                                                                 2701, 4153, 5072, 2784, 1942};
inline constexpr std::array<std::uint16_t, 7> kBatchLockedOdds = {1512, 1369, 714, 994, 260, 1024, 118};
inline constexpr std::array<std::uint16_t, 3> kBatchActedOdds = {187, 603, 373};
inline constexpr std::array<std::uint16_t, 10> kBatchBumpOdds = {199, 348,  429,  503,  714,
                                                                 994, 1315, 1671, 1757, 1226};

/// Of an answer with odds in 1/1024, as if eight had been heard.
inline BitModel expected_answer(std::uint64_t odds) {
    return {static_cast<std::uint32_t>(std::clamp<std::uint64_t>(odds * 65536 / (odds + 1024), 64, 65472)),
            8};
}

/// Models of answers in rounds: [star][age][bump].
inline std::array<BitModel, 8 * 18 * 10> round_answers() {
    std::array<BitModel, 8 * 18 * 10> models;
    std::size_t at = 0;
    for (const std::uint64_t star : kRoundStarOdds)
        for (const std::uint64_t age : kRoundAgeOdds)
            for (const std::uint64_t bump : kRoundBumpOdds)
                models[at++] = expected_answer((star * age * bump) >> 20);
    return models;
}

/// In batches: [star][locked][acted][bump].
inline std::array<BitModel, 10 * 7 * 3 * 10> batch_answers() {
    std::array<BitModel, 10 * 7 * 3 * 10> models;
    std::size_t at = 0;
    for (const std::uint64_t star : kBatchStarOdds)
        for (const std::uint64_t locked : kBatchLockedOdds)
            for (const std::uint64_t acted : kBatchActedOdds)
                for (const std::uint64_t bump : kBatchBumpOdds)
                    models[at++] = expected_answer((star * locked * acted * bump) >> 30);
    return models;
}

}  // namespace vsplit
