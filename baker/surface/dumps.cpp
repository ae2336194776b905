// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/dumps.hpp"

#include <algorithm>
#include <cmath>

#include "surface/vtk.hpp"

namespace vsplit::bake {
namespace {

std::vector<Vec3> placed(const Frame& frame, std::span<const Vec3> points) {
    std::vector<Vec3> result;
    result.reserve(points.size());
    for (const Vec3& p : points) result.push_back(frame.out_of(p));
    return result;
}

std::vector<double> radii(const Frame& frame, std::span<const double> squared) {
    std::vector<double> result;
    result.reserve(squared.size());
    for (const double s : squared) result.push_back(std::sqrt(s) / frame.scale);
    return result;
}

std::vector<std::int64_t> counting(std::size_t count) {
    std::vector<std::int64_t> result(count);
    for (std::size_t i = 0; i < count; ++i) result[i] = static_cast<std::int64_t>(i);
    return result;
}

}  // namespace

std::vector<std::byte> dump_voronoi(const Frame& frame, const Tetrahedra& tetrahedra, const Balls& balls,
                                    const std::vector<std::uint8_t>* inside) {
    VtkFile file;
    file.points(placed(frame, balls.centres));
    file.point_data("radius", radii(frame, balls.squared_radii));
    if (inside) {
        const std::vector<std::int32_t> labels(inside->begin(), inside->end());
        file.point_data("inside", std::span<const std::int32_t>(labels));
    }
    std::vector<std::int64_t> edges;
    for (std::size_t c = 0; c < tetrahedra.cells.size(); ++c)
        for (const std::uint32_t n : tetrahedra.neighbours[c])
            if (n != kNoCell && n > c)
                edges.insert(edges.end(), {static_cast<std::int64_t>(c), static_cast<std::int64_t>(n)});
    file.cells(2, edges);
    return file.poly_data();
}

std::vector<std::byte> dump_labels(const Frame& frame, const Tetrahedra& tetrahedra,
                                   const std::vector<std::uint8_t>& inside) {
    VtkFile file;
    file.points(placed(frame, tetrahedra.points));
    std::vector<std::int64_t> corners;
    for (const Corners& c : tetrahedra.cells) corners.insert(corners.end(), c.begin(), c.end());
    file.cells(4, corners);
    const std::vector<std::int32_t> labels(inside.begin(), inside.end());
    file.cell_data("inside", labels);
    return file.unstructured_grid();
}

std::vector<std::byte> dump_poles(const Frame& frame, const PoleBalls& poles,
                                  const std::vector<std::uint8_t>& inner, const UniquePoints& samples) {
    VtkFile file;
    file.points(placed(frame, poles.centres));
    file.point_data("radius", radii(frame, poles.weights));
    const std::vector<std::int32_t> labels(inner.begin(), inner.end());
    file.point_data("inside", std::span<const std::int32_t>(labels));
    // One of the samples that the pole belongs to, as the caller numbers them.
    std::vector<std::int32_t> sample(poles.cell.size(), -1);
    for (const auto* list : {&poles.second, &poles.first})
        for (std::size_t s = 0; s < list->size(); ++s)
            if ((*list)[s] != kNoCell) sample[(*list)[s]] = static_cast<std::int32_t>(samples.first[s]);
    file.point_data("sample", std::span<const std::int32_t>(sample));
    file.cells(1, counting(poles.cell.size()));
    return file.poly_data();
}

std::vector<std::byte> dump_power(const Frame& frame, const PoleBalls& poles, const PowerDiagram& diagram,
                                  const std::vector<std::uint8_t>& inner) {
    VtkFile file;
    file.points(placed(frame, poles.centres));
    file.point_data("radius", radii(frame, poles.weights));
    const std::vector<std::int32_t> labels(inner.begin(), inner.end());
    file.point_data("inside", std::span<const std::int32_t>(labels));
    std::vector<std::int64_t> corners;
    for (const Corners& c : diagram.cells) corners.insert(corners.end(), c.begin(), c.end());
    file.cells(4, corners);
    return file.unstructured_grid();
}

MedialAxis power_shape(const Frame& frame, const PoleBalls& poles, const PowerDiagram& diagram,
                       const std::vector<std::uint8_t>& inner) {
    MedialAxis axis;
    std::vector<std::uint32_t> place(poles.cell.size(), kNoCell);
    for (const Corners& c : diagram.cells)
        for (const std::uint32_t p : c)
            if (inner[p]) place[p] = 0;
    for (std::size_t p = 0; p < place.size(); ++p) {
        if (place[p] == kNoCell) continue;
        place[p] = static_cast<std::uint32_t>(axis.centres.size());
        const Vec3 centre = frame.out_of(poles.centres[p]);
        axis.centres.push_back({centre.x, centre.y, centre.z});
        axis.radii.push_back(std::sqrt(poles.weights[p]) / frame.scale);
    }
    for (const Corners& c : diagram.cells) {
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = i + 1; j < 4; ++j) {
                if (!inner[c[i]] || !inner[c[j]]) continue;
                axis.edges.push_back(
                    {std::min(place[c[i]], place[c[j]]), std::max(place[c[i]], place[c[j]])});
                for (std::size_t k = j + 1; k < 4; ++k) {
                    if (!inner[c[k]]) continue;
                    std::array<std::uint32_t, 3> t{place[c[i]], place[c[j]], place[c[k]]};
                    std::sort(t.begin(), t.end());
                    axis.triangles.push_back(t);
                }
            }
    }
    const auto make_unique = [](auto& list) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    make_unique(axis.edges);
    make_unique(axis.triangles);
    return axis;
}

std::vector<std::byte> encode_medial_axis(const MedialAxis& axis) {
    VtkFile file;
    std::vector<Vec3> centres;
    for (const auto& c : axis.centres) centres.push_back({c[0], c[1], c[2]});
    file.points(centres);
    file.point_data("radius", std::span<const double>(axis.radii));
    std::vector<std::int64_t> lines, triangles;
    for (const auto& e : axis.edges) lines.insert(lines.end(), e.begin(), e.end());
    for (const auto& t : axis.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
    file.cells(1, counting(centres.size()));
    file.cells(2, lines);
    file.cells(3, triangles);
    return file.poly_data();
}

}  // namespace vsplit::bake
