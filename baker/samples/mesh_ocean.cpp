// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A sea after some wind: Gerstner waves (Tessendorf, Simulating Ocean Water, 2001, section 3) spread about
// the wind's direction, from swell to ripples. Their steepnesses add to less than one, so that no crest folds
// over.
#include <algorithm>
#include <array>

#include "surfaces.hpp"

namespace vsplit::bake {
namespace {

struct Train {
    double kx, kz;          ///< Turns per unit of length.
    double phase;           ///< Turns.
    double height;          ///< Amplitude.
    double push_x, push_z;  ///< Amplitude sideways.
};

constexpr std::size_t kTrains = 56;

std::array<Train, kTrains> make_trains() {
    std::array<Train, kTrains> trains{};
    double wavelength = 4.2, steepness = 0;
    for (std::size_t i = 0; i < kTrains; ++i) {
        // Short waves run in more directions than the swell does.
        const double spread = 0.06 + 0.16 * std::min(1.0, static_cast<double>(i) / 30);
        const double angle = 0.07 + spread * (2 * hash_unit(3 * i) - 1);  // Turns.
        const double c = sine_of_turns(angle + 0.25), s = sine_of_turns(angle);
        // Longest waves carry the height; the spectrum falls a little slower than the wavelength.
        const double height = (0.020 + 0.006 * hash_unit(3 * i + 1)) * wavelength * (i < 3 ? 0.9 : 0.55);
        trains[i] = {c / wavelength, s / wavelength, hash_unit(3 * i + 2), height, c, s};
        steepness += 6.283185307179586 * height / wavelength;
        wavelength *= 0.938;
    }
    // In each other's company all crests meet hardly anywhere: 2.2 of "steepness" do not fold in practice,
    // but 0.9 cannot.
    const double choppy = 0.9 / steepness;
    for (Train& t : trains) {
        t.push_x *= t.height * choppy;
        t.push_z *= t.height * choppy;
    }
    return trains;
}

}  // namespace

Double3 ocean_point(double u, double v) {
    static const std::array<Train, kTrains> trains = make_trains();
    const double x = u * kOceanWidth, z = v * kOceanDepth;
    Double3 p{x, 0, z};
    for (const Train& t : trains) {
        const double turns = t.kx * x + t.kz * z + t.phase;
        const double s = sine_of_turns(turns), c = sine_of_turns(turns + 0.25);
        p = {p.x - t.push_x * s, p.y + t.height * c, p.z - t.push_z * s};
    }
    return p;
}

OceanGrid ocean_grid(std::size_t triangles) {
    // Cells nearly square, and their number the nearest to what is asked.
    const double cells = static_cast<double>(triangles) / 2;
    const double columns = std::max(1.0, std::floor(std::sqrt(cells * kOceanWidth / kOceanDepth) + 0.5));
    const double rows = std::max(1.0, std::floor(cells / columns + 0.5));
    return {static_cast<std::size_t>(columns), static_cast<std::size_t>(rows)};
}

Mesh mesh_ocean(const OceanGrid& grid) {
    const auto [columns, rows] = grid;
    Mesh mesh;
    mesh.positions.reserve((columns + 1) * (rows + 1));
    mesh.triangles.reserve(2 * columns * rows);
    for (std::size_t j = 0; j <= rows; ++j)
        for (std::size_t i = 0; i <= columns; ++i) {
            const Double3 p = ocean_point(static_cast<double>(i) / static_cast<double>(columns),
                                          static_cast<double>(j) / static_cast<double>(rows));
            mesh.positions.push_back({float(p.x), float(p.y), float(p.z)});
        }
    for (std::size_t j = 0; j < rows; ++j)
        for (std::size_t i = 0; i < columns; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (columns + 1) + i), b = a + 1;
            const auto c = static_cast<std::uint32_t>(a + columns + 1), d = c + 1;
            // Seen from above; diagonals alternate, so that no direction is favoured.
            if ((i + j) % 2 == 0) {
                mesh.triangles.push_back({a, c, d});
                mesh.triangles.push_back({a, d, b});
            } else {
                mesh.triangles.push_back({a, c, b});
                mesh.triangles.push_back({b, c, d});
            }
        }
    return mesh;
}

}  // namespace vsplit::bake
