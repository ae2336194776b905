// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// In place of base_mesh_draco.cpp where VSPLIT_WITH_DRACO is off.
#include "base_mesh.hpp"

namespace vsplit {

Result<std::vector<std::byte>> encode_base(const BaseMesh& base) {
    if (base.triangles.empty()) return std::vector<std::byte>{};
    return Error{ErrorCode::kUnsupported,
                 "this library was built without Draco: it reads, and does not write", Error::kNowhere, 0};
}

Status decode_draco(std::span<const std::byte>, std::span<std::int32_t>, std::span<std::uint32_t>) {
    return Error{ErrorCode::kUnsupported,
                 "this library was built without Draco, and was given no decoder of base meshes",
                 Error::kNowhere, 0};
}

}  // namespace vsplit
