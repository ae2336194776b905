// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What is measured of the format, kept as JSON so that sizes and speeds can be measured at different times.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "machine.hpp"
#include "vsplit/bake/collapse.hpp"

namespace vsplit::bench {

inline constexpr std::array<int, 5> kBits{11, 12, 14, 16, 0};  ///< 0 is lossless.
inline constexpr int kChain = 8;                               ///< Levels of a chain, each of half as many.

/// Bytes of the full mesh at one setting.
struct Size {
    int bits = 0;
    std::uint64_t file = 0, draco_seven = 0, draco_ten = 0, chain = 0;
    std::uint64_t gltfpack = 0;  ///< 0 if it did not run.
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Size, bits, file, draco_seven, draco_ten, chain, gltfpack)

/// A level of the chain at 14 bits.
struct Lod {
    std::uint64_t triangles = 0;
    double error = 0;           ///< Of the record, the object's units.
    std::uint64_t draco = 0;    ///< Its own file.
    std::uint64_t reached = 0;  ///< Bytes from the start of the .pmesh until its table promises that error.
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Lod, triangles, error, draco, reached)

struct Point {
    std::uint64_t bytes = 0;
    double error = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Point, bytes, error)

/// One model in one profile.
struct Profile {
    std::string profile;
    std::uint64_t vertices = 0, triangles = 0;
    double diagonal = 0, step = 0;  ///< Of the box; of the lattice at 14 bits.
    std::vector<Size> sizes;
    std::vector<Lod> lods;     ///< Finest first.
    std::vector<Point> curve;  ///< The 14-bit file at the ends of base and blocks.
    /// Stream profile: bytes that normals of 8 and 10 bits add.
    std::uint64_t normals_8 = 0, normals_10 = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Profile, profile, vertices, triangles, diagonal, step, sizes, lods, curve,
                                   normals_8, normals_10)

struct ModelSizes {
    std::string model;
    std::vector<Profile> profiles;  ///< Stream, quality.
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ModelSizes, model, profiles)

/// Medians of three runs, processor time of one thread, at 14 bits.
struct Speeds {
    std::string model, profile;
    std::uint64_t vertices = 0, triangles = 0;
    double encode = 0, decode = 0;              ///< Seconds.
    double draco_encode = 0, draco_decode = 0;  ///< Seconds, cl 10.
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Speeds, model, profile, vertices, triangles, encode, decode, draco_encode,
                                   draco_decode)

struct Figures {
    Machine sizes_on, speeds_on;
    std::vector<ModelSizes> sizes;
    std::vector<Speeds> speeds;
    std::string gltfpack;  ///< Its version, or why it did not run.
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Figures, sizes_on, speeds_on, sizes, speeds, gltfpack)

inline constexpr std::array kPlacements{bake::Placement::kEndpoint, bake::Placement::kOptimal};
inline const char* profile_name(bake::Placement placement) {
    return placement == bake::Placement::kEndpoint ? "stream" : "quality";
}

Result<Mesh> load_model(const std::string& path);
Result<ModelSizes> measure_sizes(const std::string& path, const std::string& gltfpack);
Result<std::vector<Speeds>> measure_speeds(const std::string& path);

/// Of the command `gltfpack`; empty if it does not run.
std::string gltfpack_version(const std::string& gltfpack);

}  // namespace vsplit::bench
