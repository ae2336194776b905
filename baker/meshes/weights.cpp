// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "text_scan.hpp"
#include "vsplit/bake/meshes.hpp"

namespace vsplit::bake {

Result<std::vector<float>> parse_weights(std::span<const std::byte> bytes, std::size_t count) {
    TextScan scan(bytes);
    std::vector<float> weights;
    weights.reserve(std::min(count, bytes.size() / 2 + 1));
    for (scan.skip_space_and_comments(); !scan.at_end(); scan.skip_space_and_comments()) {
        float weight = 0;
        const TextScan before = scan;
        if (!scan.number(weight)) return before.expected("a weight");
        if (!(weight >= 0))
            return before.error(ErrorCode::kMalformed, "a weight is at least 0, not " + before.quote());
        if (weights.size() == count)
            return before.error(ErrorCode::kMalformed,
                                "more weights than the mesh's " + std::to_string(count) + " vertices");
        weights.push_back(weight);
        scan.skip_blanks();
        if (!scan.at_line_end_or_comment()) return scan.expected("one weight a line");
    }
    if (weights.size() < count)
        return scan.error(ErrorCode::kTruncated, std::to_string(weights.size()) + " weights for a mesh of " +
                                                     std::to_string(count) + " vertices");
    return weights;
}

Status apply_weights(MeshFile& file, std::span<const float> weights) {
    if (weights.size() != file.report.vertices_in)
        return Error{ErrorCode::kArgument,
                     std::to_string(weights.size()) + " weights for " +
                         std::to_string(file.report.vertices_in) + " vertices",
                     Error::kNowhere, 0};
    file.mesh.weights.assign(file.mesh.positions.size(), 0.0f);
    for (std::size_t v = 0; v < weights.size(); ++v) {
        const std::uint32_t kept = file.vertex_of.empty() ? static_cast<std::uint32_t>(v) : file.vertex_of[v];
        if (kept == MeshFile::kDropped) continue;
        if (weights[v] >= 0)
            file.mesh.weights[kept] = std::max(file.mesh.weights[kept], weights[v]);
        else
            ++file.report.weights_clamped;
    }
    return Ok{};
}

}  // namespace vsplit::bake
