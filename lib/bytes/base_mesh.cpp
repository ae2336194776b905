// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "base_mesh.hpp"

#include <cstring>

namespace vsplit {

Result<BaseMesh> decode_base(std::span<const std::byte> bytes, std::uint32_t vertices,
                             std::uint32_t triangles, const BaseMeshDecoder& decoder) {
    const auto malformed = [](std::string message) {
        return Error{ErrorCode::kMalformed, std::move(message), Error::kNowhere, 0};
    };
    BaseMesh base;
    if (bytes.empty()) {
        base.places.resize(vertices);
        return base;
    }
    if (triangles == 0) return malformed("a base mesh without triangles has Draco bytes");
    if (vertices == 0) return malformed("the base mesh has triangles but no vertices");
    base.places.resize(vertices);
    base.triangles.resize(triangles);
    const std::span places(base.places.data()->data(), std::size_t{3} * vertices);
    const std::span corners(base.triangles.data()->data(), std::size_t{3} * triangles);
    if (decoder) {
        if (!decoder(bytes, places, corners)) return malformed("the host cannot decode the base mesh");
    } else if (Status decoded = decode_draco(bytes, places, corners); !decoded) {
        return decoded.error();
    }
    for (const std::int32_t n : places)
        if (n < -kLatticeReach || n > kLatticeReach)
            return malformed("a place of the base mesh is too far away");
    for (const Triangle& t : base.triangles) {
        for (const std::uint32_t v : t)
            if (v >= vertices)
                return malformed("a triangle of the base mesh names a vertex that does not exist");
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
            return malformed("a triangle of the base mesh names a vertex twice");
    }
    return base;
}

}  // namespace vsplit
