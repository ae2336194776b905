// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "pack.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace vsplit::bake {
namespace {

/// Unit within rounding of what holds it; these keep their bits.
bool unit(const float* v, std::uint32_t component_type) {
    const double tolerance = component_type == kByte ? 0.02 : 1e-4;
    const double square = double(v[0]) * v[0] + double(v[1]) * v[1] + double(v[2]) * v[2];
    return std::fabs(square - 1) <= 2 * tolerance;
}

bool normalise(float* v) {
    const double length = std::sqrt(double(v[0]) * v[0] + double(v[1]) * v[1] + double(v[2]) * v[2]);
    if (!(length > 1e-12) || !std::isfinite(length)) return false;
    for (int c = 0; c < 3; ++c) v[c] = float(v[c] / length);
    return true;
}

/// Some unit vector across the normal.
void across(const float* n, float* out) {
    const bool flat = std::fabs(n[0]) > 0.9f;
    const float axis[3] = {flat ? 0.0f : 1.0f, flat ? 1.0f : 0.0f, 0.0f};
    out[0] = axis[1] * n[2] - axis[2] * n[1];
    out[1] = axis[2] * n[0] - axis[0] * n[2];
    out[2] = axis[0] * n[1] - axis[1] * n[0];
    if (!normalise(out)) out[0] = 1, out[1] = out[2] = 0;
}

/// The joints of one vertex over all sets.
class Influences {
  public:
    Influences(std::vector<VertexValues>& attributes) {
        for (std::size_t i = 0; i < attributes.size(); ++i)
            if (attributes[i].semantic == Semantic::kJoints && i + 1 < attributes.size() &&
                attributes[i + 1].semantic == Semantic::kJointWeights)
                sets_.emplace_back(&attributes[i], &attributes[i + 1]);
    }
    bool any() const { return !sets_.empty(); }
    std::size_t vertices() const { return sets_[0].first->values.size() / 4; }
    std::size_t slots() const { return sets_.size() * 4; }
    float& joint(std::size_t v, std::size_t slot) const {
        return sets_[slot / 4].first->values[v * 4 + slot % 4];
    }
    float& weight(std::size_t v, std::size_t slot) const {
        return sets_[slot / 4].second->values[v * 4 + slot % 4];
    }

    bool lawful(std::size_t v) const {
        double sum = 0;
        int held = 0;
        for (std::size_t s = 0; s < slots(); ++s) {
            const float w = weight(v, s), j = joint(v, s);
            if (!(w >= 0) || !(j >= 0) || j != std::floor(j) || (w == 0 && j != 0)) return false;
            if (w == 0) continue;
            for (std::size_t t = 0; t < s; ++t)
                if (weight(v, t) != 0 && joint(v, t) == j) return false;
            sum += double(w);
            ++held;
        }
        return held > 0 && std::fabs(sum - 1) <= 2e-7 * held;
    }

    void repair(std::size_t v) const {
        for (std::size_t s = 0; s < slots(); ++s) {
            float& w = weight(v, s);
            float& j = joint(v, s);
            if (!(w > 0)) w = 0;
            j = std::round(std::max(j, 0.0f));
            for (std::size_t t = 0; t < s && w > 0; ++t)
                if (weight(v, t) > 0 && joint(v, t) == j) weight(v, t) += w, w = 0;
        }
        double sum = 0;
        for (std::size_t s = 0; s < slots(); ++s) sum += double(weight(v, s));
        if (sum > 0)
            for (std::size_t s = 0; s < slots(); ++s) weight(v, s) = float(double(weight(v, s)) / sum);
        else
            weight(v, 0) = 1;
        for (std::size_t s = 0; s < slots(); ++s)
            if (weight(v, s) == 0) joint(v, s) = 0;
    }

    std::uint32_t weight_type() const { return sets_[0].second->stored.component_type; }

  private:
    std::vector<std::pair<VertexValues*, VertexValues*>> sets_;
};

double largest(std::uint32_t type) {
    switch (type) {
        case kByte:
            return 127;
        case kUnsignedByte:
            return 255;
        case kShort:
            return 32767;
        case kUnsignedShort:
            return 65535;
        default:
            return 4294967295.0;
    }
}

double smallest(std::uint32_t type, bool normalised) {
    if (type == kByte) return normalised ? -127 : -128;
    if (type == kShort) return normalised ? -32767 : -32768;
    return 0;
}

template <class T>
void store(std::byte* at, double value) {
    const T number = static_cast<T>(value);
    std::memcpy(at, &number, sizeof number);
}

}  // namespace

std::uint32_t components_of_name(const std::string& type) {
    constexpr std::pair<const char*, std::uint32_t> kTypes[] = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    for (const auto& [name, count] : kTypes)
        if (type == name) return count;
    return 0;
}

std::uint32_t component_bytes(std::uint32_t type) {
    return type == kByte || type == kUnsignedByte ? 1 : type == kShort || type == kUnsignedShort ? 2 : 4;
}

void make_lawful(std::vector<VertexValues>& attributes, std::span<const Float3> fallback) {
    const VertexValues* normals = nullptr;
    for (VertexValues& attribute : attributes) {
        auto& values = attribute.values;
        switch (attribute.semantic) {
            case Semantic::kNormal:
                for (std::size_t v = 0; 3 * v < values.size(); ++v) {
                    float* n = values.data() + 3 * v;
                    if (unit(n, attribute.stored.component_type) || normalise(n)) continue;
                    n[0] = fallback[v].x, n[1] = fallback[v].y, n[2] = fallback[v].z;
                }
                normals = &attribute;
                break;
            case Semantic::kTangent:
                for (std::size_t v = 0; 4 * v < values.size(); ++v) {
                    float* t = values.data() + 4 * v;
                    if (!unit(t, attribute.stored.component_type) && !normalise(t)) {
                        const float* n = normals != nullptr ? normals->values.data() + 3 * v : &fallback[v].x;
                        across(n, t);
                    }
                    t[3] = t[3] < 0 ? -1.0f : 1.0f;
                }
                break;
            case Semantic::kColor:
                for (float& value : values) value = std::clamp(value, 0.0f, 1.0f);
                break;
            default:
                break;
        }
    }
    const Influences influences(attributes);
    if (!influences.any()) return;
    for (std::size_t v = 0; v < influences.vertices(); ++v)
        if (!influences.lawful(v)) influences.repair(v);
}

void round_joint_weights(std::vector<VertexValues>& attributes) {
    const Influences influences(attributes);
    if (!influences.any() || influences.weight_type() == kFloat) return;
    const double whole = largest(influences.weight_type());
    for (std::size_t v = 0; v < influences.vertices(); ++v) {
        double sum = 0;
        std::size_t strongest = 0;
        for (std::size_t s = 0; s < influences.slots(); ++s) {
            float& w = influences.weight(v, s);
            if (w > influences.weight(v, strongest)) strongest = s;
            sum += std::round(double(w) * whole);
        }
        // What rounding lost or won goes to the strongest, which it changes least.
        for (std::size_t s = 0; s < influences.slots(); ++s) {
            float& w = influences.weight(v, s);
            double units = std::round(double(w) * whole);
            if (s == strongest) units += whole - sum;
            w = float(units / whole);
            if (units == 0) influences.joint(v, s) = 0;
        }
    }
}

PackedValues pack(const VertexValues& values) {
    PackedValues out;
    out.stored = values.stored;
    const std::uint32_t type = values.stored.component_type, width = component_bytes(type);
    const std::uint32_t components = values.components;
    const bool matrix = values.stored.type.starts_with("MAT");
    const std::uint32_t rows = !matrix ? components : components == 4 ? 2 : components == 9 ? 3 : 4;
    // Columns of matrices, and elements, begin at multiples of four (glTF 2.0, section 3.6.2.4).
    const std::uint32_t column = matrix ? (rows * width + 3) / 4 * 4 : rows * width;
    out.stride = (column * (components / rows) + 3) / 4 * 4;
    out.count = values.values.size() / components;
    out.bytes.assign(out.count * out.stride, std::byte{0});
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    out.min.assign(components, kInfinity);
    out.max.assign(components, -kInfinity);
    const double most = largest(type), least = smallest(type, values.stored.normalised);
    for (std::size_t v = 0; v < out.count; ++v)
        for (std::uint32_t c = 0; c < components; ++c) {
            const float value = values.values[v * components + c];
            double number = double(value);
            std::byte* at = out.bytes.data() + v * out.stride + c / rows * column + c % rows * width;
            if (type == kFloat) {
                std::memcpy(at, &value, sizeof value);
            } else {
                number =
                    std::clamp(std::round(values.stored.normalised ? number * most : number), least, most);
                if (type == kByte) store<std::int8_t>(at, number);
                if (type == kUnsignedByte) store<std::uint8_t>(at, number);
                if (type == kShort) store<std::int16_t>(at, number);
                if (type == kUnsignedShort) store<std::uint16_t>(at, number);
                if (type == kUnsignedInt) store<std::uint32_t>(at, number);
            }
            out.min[c] = std::min(out.min[c], number);
            out.max[c] = std::max(out.max[c], number);
        }
    return out;
}

}  // namespace vsplit::bake
