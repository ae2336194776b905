// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/vtk.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace vsplit::bake {

static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");

template <class T>
VtkFile::Array VtkFile::array(std::string attributes, std::span<const T> values) {
    Array result{std::move(attributes), std::vector<std::byte>(values.size_bytes())};
    if (!values.empty()) std::memcpy(result.bytes.data(), values.data(), values.size_bytes());
    return result;
}

void VtkFile::points(std::span<const Vec3> points) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    point_count_ = points.size();
    points_ = array("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", points);
}

void VtkFile::point_data(const char* name, std::span<const double> values) {
    point_data_.push_back(array("type=\"Float64\" Name=\"" + std::string(name) + "\"", values));
}

void VtkFile::point_data(const char* name, std::span<const std::int32_t> values) {
    point_data_.push_back(array("type=\"Int32\" Name=\"" + std::string(name) + "\"", values));
}

void VtkFile::cell_data(const char* name, std::span<const std::int32_t> values) {
    cell_data_.push_back(array("type=\"Int32\" Name=\"" + std::string(name) + "\"", values));
}

void VtkFile::cells(int corners, std::span<const std::int64_t> connectivity) {
    cells_.push_back({corners, {connectivity.begin(), connectivity.end()}});
}

std::vector<std::byte> VtkFile::poly_data() const {
    return assemble(false);
}
std::vector<std::byte> VtkFile::unstructured_grid() const {
    return assemble(true);
}

std::vector<std::byte> VtkFile::assemble(bool grid) const {
    std::string xml, data;
    const auto append = [&](const Array& a) {
        xml += "<DataArray " + a.attributes + " format=\"appended\" offset=\"" + std::to_string(data.size()) +
               "\"/>\n";
        const std::uint64_t size = a.bytes.size();
        data.append(reinterpret_cast<const char*>(&size), sizeof size);
        data.append(reinterpret_cast<const char*>(a.bytes.data()), a.bytes.size());
    };
    const auto append_cells = [&](auto&& chosen, bool types) {
        std::vector<std::int64_t> connectivity, offsets;
        std::vector<std::uint8_t> kinds;
        for (const Cells& c : cells_) {
            if (!chosen(c)) continue;
            connectivity.insert(connectivity.end(), c.connectivity.begin(), c.connectivity.end());
            const std::int64_t before = offsets.empty() ? 0 : offsets.back();
            const auto count = static_cast<std::int64_t>(c.connectivity.size()) / c.corners;
            constexpr std::uint8_t kKinds[] = {0, 1, 3, 5,
                                               10};  // VTK's numbers for vertex, line, triangle, tetrahedron
            for (std::int64_t i = 1; i <= count; ++i) {
                offsets.push_back(before + i * c.corners);
                kinds.push_back(kKinds[c.corners]);
            }
        }
        append(array("type=\"Int64\" Name=\"connectivity\"", std::span<const std::int64_t>(connectivity)));
        append(array("type=\"Int64\" Name=\"offsets\"", std::span<const std::int64_t>(offsets)));
        if (types) append(array("type=\"UInt8\" Name=\"types\"", std::span<const std::uint8_t>(kinds)));
    };
    const auto count_of = [&](auto&& chosen) {
        std::size_t count = 0;
        for (const Cells& c : cells_)
            if (chosen(c)) count += c.connectivity.size() / static_cast<std::size_t>(c.corners);
        return std::to_string(count);
    };
    const auto of = [](int corners) { return [corners](const Cells& c) { return c.corners == corners; }; };
    const auto any = [](const Cells&) { return true; };

    const char* kind = grid ? "UnstructuredGrid" : "PolyData";
    xml = "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + std::string(kind) +
          "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<" + kind +
          ">\n<Piece NumberOfPoints=\"" + std::to_string(point_count_) + "\"";
    if (grid)
        xml += " NumberOfCells=\"" + count_of(any) + "\">\n";
    else
        xml += " NumberOfVerts=\"" + count_of(of(1)) + "\" NumberOfLines=\"" + count_of(of(2)) +
               "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + count_of(of(3)) + "\">\n";
    xml += "<PointData>\n";
    for (const Array& a : point_data_) append(a);
    xml += "</PointData>\n<CellData>\n";
    for (const Array& a : cell_data_) append(a);
    xml += "</CellData>\n<Points>\n";
    append(points_);
    xml += "</Points>\n";
    if (grid) {
        xml += "<Cells>\n";
        append_cells(any, true);
        xml += "</Cells>\n";
    } else {
        for (const auto& [name, corners] : {std::pair{"Verts", 1}, {"Lines", 2}, {"Polys", 3}}) {
            xml += "<" + std::string(name) + ">\n";
            append_cells(of(corners), false);
            xml += "</" + std::string(name) + ">\n";
        }
    }
    xml += "</Piece>\n</" + std::string(kind) + ">\n<AppendedData encoding=\"raw\">\n_";
    xml += data + "\n</AppendedData>\n</VTKFile>\n";
    std::vector<std::byte> bytes(xml.size());
    std::memcpy(bytes.data(), xml.data(), xml.size());
    return bytes;
}

}  // namespace vsplit::bake
