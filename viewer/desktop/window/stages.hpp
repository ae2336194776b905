// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A reconstruction as it goes: points, then poles, then the crust.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "vsplit/mesh.hpp"

namespace vsplit::studio {

/// A window that shows each stage when it is there. Needs a display.
class Stages {
  public:
    Stages(int width, int height, const std::string& title);
    ~Stages();

    void points(std::span<const std::array<double, 3>> positions);
    /// The dump "poles.vtp" of reconstruct(), coloured by their label: inner ones warm, outer ones cold.
    void poles(std::span<const std::byte> vtp);
    void crust(const Mesh& mesh);
    /// A stage's name and how much of it is done. False once Escape was pressed.
    bool progress(std::string_view stage, double done);
    /// The picture now, as PNG, for tests.
    void save(const std::string& path);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace vsplit::studio
