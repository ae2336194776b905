// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the bench runs on.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bench {

/// A model that is loaded when its turn comes.
struct Model {
    std::string name;
    std::function<Result<Mesh>()> load;
};

/// What to measure what on.
struct ModelSet {
    std::vector<Model> quality;  ///< Distances and calibration.
    Model speed;                 ///< About a million triangles (a quarter of one when quick).
    std::string said;            ///< Where they are from, for people.
};

/// `files` if there are any (the last is the speed's as well), else the corpus in `folder`, else the built-in
/// samples.
ModelSet choose_models(const std::vector<std::string>& files, const std::string& folder, bool quick);

Result<Mesh> load_mesh(const std::string& path);

/// Every triangle cut in four at the middles of its edges, each middle moved along the normal by a
/// pseudo-random part, up to `amplitude`, of its edge's length: a model four times as large that is not flat
/// at its finest scale. Same bytes everywhere.
Mesh subdivide(const Mesh& mesh, float amplitude);

}  // namespace vsplit::bench
