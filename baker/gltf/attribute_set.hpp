// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The attributes of a whole scene: the union of its primitives'.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "primitive.hpp"
#include "vsplit/bake/scene.hpp"
#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

/// What the name of a glTF attribute, "k/" before it for a morph target's, says of its values.
Semantic semantic_of(std::string_view name);

/// Collects names and kinds, then gives an order: joints next to their weights, morph targets last.
class AttributeSet {
  public:
    /// `place` names the primitive for errors: kMalformed if a name does not have the type that glTF
    /// gives it.
    Status add(const std::string& name, int type, const std::string& place);

    /// All of them with no values, in order; add() no more.
    const std::vector<Attribute>& order();
    std::uint32_t number_of(const std::string& name) const { return numbers_.at(name); }
    /// Of all attributes together.
    std::uint64_t components() const;

  private:
    std::map<std::string, std::uint32_t> components_;  // by name
    std::map<std::string, std::uint32_t> numbers_;
    std::vector<Attribute> ordered_;
};

/// glTF's name of tinygltf's type.
const char* type_name(int type);

}  // namespace vsplit::bake
