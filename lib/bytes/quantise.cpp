// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "quantise.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace vsplit {
namespace {

constexpr double kGridReach = 1 << 30;

float to_float(double value) {
    constexpr double most = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(value, -most, most));
}

/// The nearest whole number, halves away from zero.
double nearest_whole(double value) {
    return value < 0 ? -std::floor(0.5 - value) : std::floor(value + 0.5);
}

void to_octahedron(const float* v, std::uint32_t bits, std::int32_t* numbers) {
    const double most = double((1 << (bits - 1)) - 1);
    const double sum = std::abs(double(v[0])) + std::abs(double(v[1])) + std::abs(double(v[2]));
    double x = sum > 0 ? v[0] / sum : 0, y = sum > 0 ? v[1] / sum : 0;
    if (v[2] < 0) {
        const double folded = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
        y = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
        x = folded;
    }
    numbers[0] = static_cast<std::int32_t>(nearest_whole(x * most));
    numbers[1] = static_cast<std::int32_t>(nearest_whole(y * most));
}

void from_octahedron(const std::int32_t* numbers, std::uint32_t bits, float* v) {
    const std::int32_t most = (1 << (bits - 1)) - 1;
    double x = double(std::clamp(numbers[0], -most, most)) / double(most),
           y = double(std::clamp(numbers[1], -most, most)) / double(most);
    const double z = 1 - std::abs(x) - std::abs(y);
    if (z < 0) {
        const double folded = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
        y = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
        x = folded;
    }
    const double length = std::sqrt(x * x + y * y + z * z);
    v[0] = static_cast<float>(x / length);
    v[1] = static_cast<float>(y / length);
    v[2] = static_cast<float>(z / length);
}

bool all_of(const Attribute& attribute, std::span<const float> moved, bool (*holds)(float)) {
    return std::all_of(attribute.values.begin(), attribute.values.end(), holds) &&
           std::all_of(moved.begin(), moved.end(), holds);
}

}  // namespace

std::int32_t ordered_number(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return static_cast<std::int32_t>(bits & 0x80000000u ? ~(bits & 0x7FFFFFFFu) : bits);
}

float ordered_float(std::int32_t number) {
    const auto bits = static_cast<std::uint32_t>(number);
    return std::bit_cast<float>(number < 0 ? ~bits | 0x80000000u : bits);
}

Lattice Lattice::of(const Float3& low, const Float3& high, std::uint32_t bits) {
    Lattice lattice;
    lattice.origin = {low.x, low.y, low.z};
    const double side = std::max({double(high.x) - low.x, double(high.y) - low.y, double(high.z) - low.z});
    lattice.step = side / double((std::uint32_t{1} << bits) - 1);
    return lattice;
}

Lattice3 Lattice::nearest(const Float3& p) const {
    const std::array<double, 3> v = {p.x, p.y, p.z};
    Lattice3 out{};
    if (!(step > 0)) return out;
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = static_cast<std::int32_t>(std::clamp(nearest_whole((v[i] - origin[i]) / step),
                                                      -double(kLatticeReach), double(kLatticeReach)));
    return out;
}

Float3 Lattice::point(const Lattice3& at) const {
    return {to_float(origin[0] + step * at[0]), to_float(origin[1] + step * at[1]),
            to_float(origin[2] + step * at[2])};
}

std::array<std::uint32_t, 3> Lattice::finer(const Lattice3& at, const Float3& p) const {
    const Float3 from = point(at);
    const std::array<float, 3> a = {from.x, from.y, from.z}, b = {p.x, p.y, p.z};
    std::array<std::uint32_t, 3> out;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t d = static_cast<std::uint32_t>(ordered_number(b[i])) -
                                static_cast<std::uint32_t>(ordered_number(a[i]));
        out[i] = (d << 1) ^ (0u - (d >> 31));
    }
    return out;
}

Float3 Lattice::exact(const Lattice3& at, const std::array<std::uint32_t, 3>& finer) const {
    const Float3 from = point(at);
    std::array<float, 3> v = {from.x, from.y, from.z};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t d = (finer[i] >> 1) ^ (0u - (finer[i] & 1));
        v[i] = ordered_float(static_cast<std::int32_t>(static_cast<std::uint32_t>(ordered_number(v[i])) + d));
    }
    return {v[0], v[1], v[2]};
}

std::uint32_t ValueRule::numbers() const {
    if (coding == ValueCoding::kOctahedral) return 2;
    if (coding == ValueCoding::kTangent) return 3;
    return components;
}

bool ValueRule::mixes(std::uint32_t i) const {
    if (coding == ValueCoding::kTangent) return i < 2;
    return coding != ValueCoding::kWhole;
}

void ValueRule::quantise(const float* v, std::int32_t* n) const {
    switch (coding) {
        case ValueCoding::kFloat:
            for (std::uint32_t i = 0; i < components; ++i) n[i] = ordered_number(v[i]);
            return;
        case ValueCoding::kGrid:
            for (std::uint32_t i = 0; i < components; ++i)
                n[i] = step[i] > 0
                           ? static_cast<std::int32_t>(std::clamp(nearest_whole((v[i] - origin[i]) / step[i]),
                                                                  -kGridReach, kGridReach))
                           : 0;
            return;
        case ValueCoding::kWhole:
            for (std::uint32_t i = 0; i < components; ++i) n[i] = static_cast<std::int32_t>(v[i]);
            return;
        case ValueCoding::kShares: {
            // Rounded down, then up where most was lost, until the sum is right.
            double total = 0;
            for (std::uint32_t i = 0; i < components; ++i) total += 255.0 * v[i];
            auto left = static_cast<std::int32_t>(nearest_whole(total));
            std::array<double, 16> lost{};
            for (std::uint32_t i = 0; i < components; ++i) {
                n[i] = static_cast<std::int32_t>(std::floor(255.0 * v[i]));
                lost[i] = 255.0 * v[i] - n[i];
                left -= n[i];
            }
            for (; left > 0; --left) {
                const auto most = std::max_element(lost.begin(), lost.begin() + components) - lost.begin();
                ++n[most];
                lost[static_cast<std::size_t>(most)] -= 1;
            }
            return;
        }
        case ValueCoding::kOctahedral:
            to_octahedron(v, bits, n);
            return;
        case ValueCoding::kTangent:
            to_octahedron(v, bits, n);
            n[2] = v[3] < 0;
            return;
    }
}

void ValueRule::restore(const std::int32_t* n, float* v) const {
    switch (coding) {
        case ValueCoding::kFloat:
            for (std::uint32_t i = 0; i < components; ++i) v[i] = ordered_float(n[i]);
            return;
        case ValueCoding::kGrid:
            for (std::uint32_t i = 0; i < components; ++i) v[i] = to_float(origin[i] + step[i] * n[i]);
            return;
        case ValueCoding::kWhole:
            for (std::uint32_t i = 0; i < components; ++i) v[i] = static_cast<float>(n[i]);
            return;
        case ValueCoding::kShares:
            for (std::uint32_t i = 0; i < components; ++i) v[i] = static_cast<float>(n[i] / 255.0);
            return;
        case ValueCoding::kOctahedral:
            from_octahedron(n, bits, v);
            return;
        case ValueCoding::kTangent:
            from_octahedron(n, bits, v);
            v[3] = n[2] != 0 ? -1.0f : 1.0f;
            return;
    }
}

ValueRule rule_for(const Attribute& attribute, std::span<const float> moved, const WriteOptions& options,
                   double lattice_step) {
    ValueRule rule;
    rule.name = attribute.name;
    rule.semantic = attribute.semantic;
    rule.components = attribute.components;
    if (options.position_bits == 0) return rule;
    const auto grid_over_values = [&](std::uint32_t bits) {
        rule.coding = ValueCoding::kGrid;
        for (std::uint32_t c = 0; c < rule.components; ++c) {
            double low = std::numeric_limits<double>::infinity(), high = -low;
            for (const std::span<const float> all : {std::span<const float>(attribute.values), moved})
                for (std::size_t i = c; i < all.size(); i += rule.components) {
                    low = std::min<double>(low, all[i]);
                    high = std::max<double>(high, all[i]);
                }
            rule.origin.push_back(low <= high ? low : 0);
            rule.step.push_back(low <= high ? (high - low) / double((std::uint32_t{1} << bits) - 1) : 0);
        }
    };
    const auto fixed_grid = [&](double step) {
        rule.coding = ValueCoding::kGrid;
        rule.origin.assign(rule.components, 0);
        rule.step.assign(rule.components, step);
    };
    switch (attribute.semantic) {
        case Semantic::kNormal:
            rule.coding = ValueCoding::kOctahedral;
            rule.bits = options.normal_bits;
            break;
        case Semantic::kTangent:
            rule.coding = ValueCoding::kTangent;
            rule.bits = options.normal_bits;
            break;
        case Semantic::kTexcoord:
            grid_over_values(options.texcoord_bits);
            break;
        case Semantic::kColor:
            if (all_of(attribute, moved, [](float v) { return v >= 0 && v <= 1; }))
                fixed_grid(1.0 / double((std::uint32_t{1} << options.color_bits) - 1));
            break;
        case Semantic::kJoints:
            if (all_of(attribute, moved,
                       [](float v) { return v >= 0 && v < float(1 << 24) && v == std::floor(v); }))
                rule.coding = ValueCoding::kWhole;
            break;
        case Semantic::kJointWeights:
            if (all_of(attribute, moved, [](float v) { return v >= 0 && v <= 1; }))
                rule.coding = ValueCoding::kShares;
            break;
        case Semantic::kMorphOffset:
            if (lattice_step > 0) fixed_grid(lattice_step);
            break;
        case Semantic::kMorphNormal:
        case Semantic::kMorphTangent:
            fixed_grid(1.0 / double((std::uint32_t{1} << options.normal_bits) - 1));
            break;
        case Semantic::kOther:
            break;
    }
    return rule;
}

}  // namespace vsplit
