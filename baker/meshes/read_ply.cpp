// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// PLY bodies: text and both binaries, any order of elements and properties, triangle strips.
#include <bit>
#include <cstring>
#include <optional>

#include "ply_header.hpp"
#include "readers.hpp"
#include "text_scan.hpp"

namespace vsplit::bake {
namespace {

template <class T>
T load(const std::byte* at, bool swapped) {
    std::byte raw[sizeof(T)];
    std::memcpy(raw, at, sizeof(T));
    if (swapped)
        for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(raw[i], raw[sizeof(T) - 1 - i]);
    return std::bit_cast<T>(raw);
}

/// Every PLY type fits a double exactly.
double load_as_double(PlyType type, const std::byte* at, bool swapped) {
    switch (type) {
        case PlyType::kInt8:
            return load<std::int8_t>(at, swapped);
        case PlyType::kUint8:
            return load<std::uint8_t>(at, swapped);
        case PlyType::kInt16:
            return load<std::int16_t>(at, swapped);
        case PlyType::kUint16:
            return load<std::uint16_t>(at, swapped);
        case PlyType::kInt32:
            return load<std::int32_t>(at, swapped);
        case PlyType::kUint32:
            return load<std::uint32_t>(at, swapped);
        case PlyType::kFloat:
            return load<float>(at, swapped);
        case PlyType::kDouble:
            return load<double>(at, swapped);
    }
    return 0;
}

/// Rows of a text body.
class TextRows {
  public:
    TextRows(std::span<const std::byte> bytes, const PlyHeader& header)
        : scan_(bytes.subspan(header.body), header.body_line) {}

    bool number(PlyType, float& value, double origin = 0) {
        scan_.skip_space();
        return scan_.coordinate(value, origin);
    }
    bool list_count(PlyType, std::uint64_t& count) {
        scan_.skip_space();
        std::int64_t value = 0;
        if (!scan_.integer(value) || value < 0) return false;
        count = static_cast<std::uint64_t>(value);
        return true;
    }
    bool index(PlyType, std::int64_t& value) {
        scan_.skip_space();
        return scan_.integer(value);
    }
    bool skip(PlyType, std::uint64_t count) {
        for (; count > 0; --count) {
            scan_.skip_space();
            if (scan_.word().empty()) return false;
        }
        return true;
    }
    Error error(ErrorCode code, std::string message) const { return scan_.error(code, std::move(message)); }
    Error expected(const std::string& what, PlyType) const { return scan_.expected(what); }
    std::uint64_t room(PlyType) const { return scan_.bytes_left() / 2 + 1; }
    bool only_blanks_left() {
        scan_.skip_space();
        return scan_.at_end();
    }

  private:
    TextScan scan_;
};

/// Rows of a binary body.
class BinaryRows {
  public:
    BinaryRows(std::span<const std::byte> bytes, const PlyHeader& header)
        : begin_(bytes.data()),
          p_(begin_ + header.body),
          end_(begin_ + bytes.size()),
          swapped_((header.encoding == PlyEncoding::kBigEndian) ==
                   (std::endian::native == std::endian::little)) {}

    bool number(PlyType type, float& value, double origin = 0) {
        if (left() < size_of(type)) return false;
        if (type == PlyType::kFloat && origin == 0)
            value = load<float>(p_, swapped_);  // Keeps the bits, of a NaN too.
        else
            value = static_cast<float>(load_as_double(type, p_, swapped_) - origin);
        p_ += size_of(type);
        return true;
    }
    bool list_count(PlyType type, std::uint64_t& count) {
        if (left() < size_of(type)) return false;
        const double value = load_as_double(type, p_, swapped_);
        if (value < 0) return false;
        p_ += size_of(type);
        count = static_cast<std::uint64_t>(value);
        return true;
    }
    /// At most so many values of a list are left.
    std::uint64_t room(PlyType type) const { return left() / size_of(type); }
    bool index(PlyType type, std::int64_t& value) {
        if (left() < size_of(type)) return false;
        if (type == PlyType::kInt32)
            value = load<std::int32_t>(p_, swapped_);
        else {
            const double wide = load_as_double(type, p_, swapped_);
            // A float list of indices is odd but found; its fractions and NaN are no indices.
            if (!(wide >= -1) || !(wide < 4294967296.0) || wide != std::floor(wide)) return false;
            value = static_cast<std::int64_t>(wide);
        }
        p_ += size_of(type);
        return true;
    }
    bool skip(PlyType type, std::uint64_t count) {
        if (count > room(type)) return false;
        p_ += count * size_of(type);
        return true;
    }
    Error error(ErrorCode code, std::string message) const {
        return {code, std::move(message), static_cast<std::uint64_t>(p_ - begin_), 0};
    }
    Error expected(const std::string& what, PlyType type) const {
        return left() < size_of(type)
                   ? error(ErrorCode::kTruncated, "the file ends where " + what + " should be")
                   : error(ErrorCode::kMalformed, "expected " + what);
    }
    /// Some writers end a binary file with a line's end, too.
    bool only_blanks_left() const {
        for (const std::byte* q = p_; q != end_; ++q)
            if (*q != std::byte{'\n'} && *q != std::byte{'\r'} && *q != std::byte{' '} && *q != std::byte{0})
                return false;
        return true;
    }

  private:
    std::uint64_t left() const { return static_cast<std::uint64_t>(end_ - p_); }

    const std::byte* begin_;
    const std::byte* p_;
    const std::byte* end_;
    bool swapped_;
};

constexpr std::uint32_t kSeparator = ~std::uint32_t{0};
constexpr std::size_t kNoProperty = ~std::size_t{0};

template <class Rows>
struct PlyBody {
    Rows rows;
    std::uint64_t vertices;  ///< Faces may come first, so the header's count is the limit for indices.
    std::size_t weight = kNoProperty;
    Origin origin{};
    PolygonSoup soup{};

    static std::string name(const PlyElement& element, std::uint64_t row) {
        return element.name + " " + std::to_string(row);
    }
    Error too_long(std::uint64_t count, const PlyElement& element, std::uint64_t row) const {
        return rows.error(ErrorCode::kTruncated, name(element, row) + " announces a list of " +
                                                     std::to_string(count) +
                                                     " values, more than the file can hold");
    }

    Status skip_value(const PlyProperty& p, const PlyElement& element, std::uint64_t row) {
        std::uint64_t count = 1;
        if (p.is_list && !rows.list_count(p.count_type, count))
            return rows.expected("the length of '" + p.name + "' of " + name(element, row), p.count_type);
        if (p.is_list && count > rows.room(p.type)) return too_long(count, element, row);
        if (!rows.skip(p.type, count))
            return rows.expected("'" + p.name + "' of " + name(element, row), p.type);
        return Ok{};
    }

    Status read_vertices(const PlyElement& element) {
        std::size_t axis_of[3] = {element.find("x"), element.find("y"), element.find("z")};
        const std::size_t n = element.properties.size();
        std::vector<int> role(n, -1);
        for (int a = 0; a < 3; ++a) role[axis_of[a]] = a;
        float row_values[4] = {0, 0, 0, 0};
        soup.positions.reserve(element.count);
        if (weight != kNoProperty) soup.weights.reserve(element.count);
        for (std::uint64_t v = 0; v < element.count; ++v) {
            for (std::size_t k = 0; k < n; ++k) {
                const PlyProperty& p = element.properties[k];
                if (role[k] < 0 && k != weight) {
                    if (Status s = skip_value(p, element, v); !s) return s;
                    continue;
                }
                float value = 0;
                if (!rows.number(p.type, value, role[k] < 0 ? 0 : origin[std::size_t(role[k])]))
                    return rows.expected("'" + p.name + "' of " + name(element, v), p.type);
                if (role[k] >= 0) row_values[role[k]] = value;
                if (k == weight) row_values[3] = value;
            }
            soup.positions.push_back({row_values[0], row_values[1], row_values[2]});
            if (weight != kNoProperty) soup.weights.push_back(row_values[3]);
        }
        return Ok{};
    }

    /// Appends a list of indices to soup.corners; a strip's -1 as kSeparator.
    Status read_indices(const PlyProperty& p, const PlyElement& element, std::uint64_t row, bool strip) {
        std::uint64_t count = 0;
        if (!rows.list_count(p.count_type, count))
            return rows.expected("the number of corners of " + name(element, row), p.count_type);
        if (count > rows.room(p.type)) return too_long(count, element, row);
        for (; count > 0; --count) {
            std::int64_t vertex = 0;
            if (!rows.index(p.type, vertex))
                return rows.expected("a corner of " + name(element, row), p.type);
            if (vertex < 0 ? !(strip && vertex == -1) : static_cast<std::uint64_t>(vertex) >= vertices)
                return rows.error(ErrorCode::kMalformed, name(element, row) + " names vertex " +
                                                             std::to_string(vertex) + " of " +
                                                             std::to_string(vertices));
            soup.corners.push_back(static_cast<std::uint32_t>(vertex));
        }
        return Ok{};
    }

    /// corners[first..] is a strip, or several with separators: triangles with alternating order take its
    /// place.
    void unroll_strip(std::size_t first) {
        const std::vector<std::uint32_t> strip(soup.corners.begin() + static_cast<std::ptrdiff_t>(first),
                                               soup.corners.end());
        soup.corners.resize(first);
        std::size_t start = 0;
        for (std::size_t i = 0; i < strip.size(); ++i) {
            if (strip[i] == kSeparator) start = i + 1;
            if (i < start + 2 || strip[i] == kSeparator) continue;
            const bool odd = (i - start) % 2 != 0;
            soup.corners.insert(soup.corners.end(),
                                {strip[i - (odd ? 1 : 2)], strip[i - (odd ? 2 : 1)], strip[i]});
            soup.face_starts.push_back(soup.corners.size());
        }
    }

    Status read_faces(const PlyElement& element, std::size_t list, bool strips) {
        if (element.count == 0) return Ok{};
        if (!strips) {
            soup.face_starts.reserve(soup.face_starts.size() + element.count);
            soup.corners.reserve(soup.corners.size() +
                                 std::min(3 * element.count, rows.room(element.properties[list].type)));
        }
        for (std::uint64_t f = 0; f < element.count; ++f) {
            for (std::size_t k = 0; k < element.properties.size(); ++k) {
                const PlyProperty& p = element.properties[k];
                const std::size_t first = soup.corners.size();
                Status s = k == list ? read_indices(p, element, f, strips) : skip_value(p, element, f);
                if (!s) return s;
                if (k != list) continue;
                if (strips)
                    unroll_strip(first);
                else
                    soup.face_starts.push_back(soup.corners.size());
            }
        }
        return Ok{};
    }

    Status read(const PlyHeader& header) {
        for (const PlyElement& element : header.elements) {
            Status status = Ok{};
            const bool strips = element.name == "tristrips";
            if (element.name == "vertex")
                status = read_vertices(element);
            else if (element.name == "face" || strips) {
                std::size_t list = element.find("vertex_indices");
                if (list == element.properties.size()) list = element.find("vertex_index");
                status = read_faces(element, list, strips);
            } else if (!element.properties.empty()) {
                for (std::uint64_t row = 0; row < element.count && status.ok(); ++row)
                    for (const PlyProperty& p : element.properties)
                        if (status = skip_value(p, element, row); !status) break;
            }
            if (!status) return status;
        }
        if (!rows.only_blanks_left())
            return rows.error(ErrorCode::kMalformed, "more data than the header announces");
        return Ok{};
    }
};

Error header_error(std::string message, ErrorCode code = ErrorCode::kMalformed) {
    return {code, "PLY header: " + std::move(message), Error::kNowhere, 0};
}

/// Whether what a mesh needs is there.
Status check_mesh_header(const PlyHeader& header) {
    const PlyElement* vertex = header.find("vertex");
    if (vertex == nullptr) return header_error("no element 'vertex'");
    if (vertex->count >= std::numeric_limits<std::uint32_t>::max())
        return header_error("more than 4,294,967,294 vertices", ErrorCode::kLimit);
    for (const char* axis : {"x", "y", "z"}) {
        const std::size_t k = vertex->find(axis);
        if (k == vertex->properties.size() || vertex->properties[k].is_list)
            return header_error(std::string("the vertices have no property '") + axis + "'");
    }
    bool has_faces = false;
    for (const char* name : {"face", "tristrips"}) {
        const PlyElement* faces = header.find(name);
        if (faces == nullptr) continue;
        has_faces = has_faces || faces->count > 0;
        std::size_t k = faces->find("vertex_indices");
        if (k == faces->properties.size()) k = faces->find("vertex_index");
        if (faces->count > 0 && (k == faces->properties.size() || !faces->properties[k].is_list))
            return header_error(std::string("element '") + name + "' has no list 'vertex_indices'");
    }
    if (!has_faces) return header_error("no faces: a point cloud, not a mesh");
    return Ok{};
}

template <class Rows>
Result<PolygonSoup> read_body(std::span<const std::byte> bytes, const PlyHeader& header, std::size_t weight,
                              const Origin& origin) {
    PlyBody<Rows> body{Rows(bytes, header), header.find("vertex")->count, weight, origin};
    if (Status status = body.read(header); !status) return status.error();
    return std::move(body.soup);
}

}  // namespace

Result<SoupFile> read_ply(std::span<const std::byte> bytes, const std::string& weight_property,
                          const Origin& origin) {
    const Result<PlyHeader> header = parse_ply_header(bytes);
    if (!header) return header.error();
    if (Status status = check_mesh_header(*header); !status) return status.error();

    const PlyElement& vertex = *header->find("vertex");
    std::size_t weight = kNoProperty;
    const auto is_scalar = [&](std::size_t k) {
        return k < vertex.properties.size() && !vertex.properties[k].is_list;
    };
    if (!weight_property.empty()) {
        weight = vertex.find(weight_property);
        if (!is_scalar(weight))
            return Error{ErrorCode::kArgument,
                         "the vertices have no property '" + weight_property + "' to take as weights",
                         Error::kNowhere, 0};
    } else {
        for (const char* name : {"quality", "weight"})
            if (weight == kNoProperty && is_scalar(vertex.find(name))) weight = vertex.find(name);
    }

    SoupFile file;
    const bool text = header->encoding == PlyEncoding::kText;
    Result<PolygonSoup> soup = text ? read_body<TextRows>(bytes, *header, weight, origin)
                                    : read_body<BinaryRows>(bytes, *header, weight, origin);
    if (!soup) return soup.error();
    file.soup = std::move(*soup);
    for (const char* axis : {"x", "y", "z"}) {
        const PlyType type = vertex.properties[vertex.find(axis)].type;
        file.wide |= text || type == PlyType::kDouble || type == PlyType::kInt32 || type == PlyType::kUint32;
    }
    file.report.format = text                                             ? "PLY (ascii)"
                         : header->encoding == PlyEncoding::kLittleEndian ? "PLY (binary little endian)"
                                                                          : "PLY (binary big endian)";
    return file;
}

}  // namespace vsplit::bake
