// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Sample models made by code, for the demo, the tests and the benchmarks: nothing needs to be downloaded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vsplit/mesh.hpp"

namespace vsplit::bake {

/// Whale: a closed implicit surface of genus 0. Ocean: a bounded height field of waves, one boundary loop.
enum class Sample : std::uint8_t { kWhale, kOcean };

/// About `triangles` triangles (within 10 %), the same bytes on every machine and for any number of threads.
/// The whale is closed and manifold, the ocean one sheet with one boundary. 100 <= triangles <= 20'000'000.
Mesh make_sample_mesh(Sample sample, std::size_t triangles);

/// Exactly `count` points, spread evenly by area over the same surface, in a deterministic order.
std::vector<Float3> make_sample_points(Sample sample, std::size_t count);

}  // namespace vsplit::bake
