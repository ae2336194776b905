// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// In place of base_mesh_draco.cpp and of all that writes, where VSPLIT_WITH_DRACO is off.
#include "base_mesh.hpp"
#include "vsplit/write.hpp"

namespace vsplit {
namespace {

Error unsupported(const char* message) {
    return {ErrorCode::kUnsupported, message, Error::kNowhere, 0};
}

constexpr char kReadsOnly[] = "this library was built without Draco: it reads, and does not write";

}  // namespace

Status decode_draco(std::span<const std::byte>, std::span<std::int32_t>, std::span<std::uint32_t>) {
    return unsupported("this library was built without Draco, and was given no decoder of base meshes");
}

Result<std::vector<std::byte>> write_progressive_mesh(const ProgressiveMesh&, const WriteOptions&) {
    return unsupported(kReadsOnly);
}

Result<ProgressiveMesh> canonical_progressive_mesh(const ProgressiveMesh&, const WriteOptions&) {
    return unsupported(kReadsOnly);
}

}  // namespace vsplit
