// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "model.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "vsplit/bake/files.hpp"

namespace vsplit::app {
namespace {

double half_diagonal(const std::vector<Float3>& positions) {
    if (positions.empty()) return 0;
    Float3 least = positions[0], most = least;
    for (const Float3& p : positions) {
        least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
        most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    }
    const double x = double(most.x) - least.x, y = double(most.y) - least.y, z = double(most.z) - least.z;
    return 0.5 * std::sqrt(x * x + y * y + z * z);
}

}  // namespace

bool is_gltf(std::span<const std::byte> bytes, const std::string& extension) {
    if (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0) return true;
    return extension == ".gltf" || extension == ".glb";
}

Result<StreamFile> read_stream_file(const std::string& path, int& exit) {
    StreamFile file;
    auto bytes = bake::read_file(path);
    if (!bytes) {
        exit = fail_input(path, bytes.error());
        return bytes.error();
    }
    file.bytes = std::move(*bytes);
    file.size = file.bytes.size();
    const auto carried = bake::find_progressive(file.bytes);
    Status fits = Ok{};
    if (!carried)
        fits = carried.error();
    else if (*carried && (*carried)->offset + (*carried)->bytes > file.bytes.size())
        fits = Error{ErrorCode::kTruncated, "the GLB ends before the stream that it carries",
                     file.bytes.size(), 0};
    if (!fits) {
        exit = fail_input(path, fits.error());
        return fits.error();
    }
    if (*carried) {
        file.offset = (*carried)->offset;
        file.size = (*carried)->bytes;
        file.carried = true;
    }
    return file;
}

Result<std::vector<std::byte>> Model::encode(std::span<const bake::GltfLevel> levels,
                                             const bake::SceneFormat& format) const {
    return scene ? bake::encode_scene(*scene, levels, format) : bake::encode_levels(levels, format);
}

Result<bake::Scene> load_scene(const InputOptions& input, std::span<const std::byte> bytes, int& exit) {
    bake::GltfOptions options;
    options.weight_channel = input.weights;
    options.poses = input.poses;
    const std::filesystem::path folder = std::filesystem::path(input.path).parent_path();
    auto scene = bake::parse_scene(bytes, folder.empty() ? "." : folder.string(), options);
    if (!scene) exit = fail_input(input.path, scene.error());
    return scene;
}

Result<std::optional<bake::ManyfoldFile>> load_manyfold(const std::string& path,
                                                        std::span<const std::byte> bytes, int& exit) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    auto file = bake::parse_manyfold(bytes, folder.empty() ? "." : folder.string());
    if (!file) exit = fail_input(path, file.error());
    return file;
}

std::optional<std::string> manyfold_note(const bake::ManyfoldFile& file) {
    if (file.fault.empty()) return {};
    return fmt::format("record {} of {} {}: only those before it are taken", file.read, file.records,
                       file.fault);
}

Result<Model> load_model(const InputOptions& input, const CollapseFlags& flags, const Common& common,
                         int& exit) {
    bake::CollapseOptions options;
    if (const auto reason = flags.set(options)) {
        exit = fail_usage(*reason);
        return Error{ErrorCode::kArgument, *reason, Error::kNowhere, 0};
    }
    std::optional<tbb::global_control> limit;
    if (common.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(common.threads));
    auto file = read_stream_file(input.path, exit);
    if (!file) return file.error();
    const auto failed = [&](const Error& error) {
        exit = fail_input(input.path, error);
        return error;
    };
    const std::string extension = extension_of(input.path);
    Model model;
    const bool scene = !file->carried && is_gltf(file->bytes, extension);
    const bool stream = file->carried || extension == ".pmesh" ||
                        (file->size >= 6 && std::memcmp(file->stream().data(), "\x8Fpmesh", 6) == 0);
    if (stream) {
        Limits limits;
        limits.max_bytes = std::uint64_t{1} << 36;
        auto mesh = read_progressive_mesh(file->stream(), limits);
        if (!mesh) return failed(mesh.error());
        model.mesh = std::move(*mesh);
        if (file->carried) {
            auto around = bake::parse_progressive_scene(file->bytes);
            if (!around) return failed(around.error());
            model.scene = std::move(*around);
        }
    } else {
        if (scene) {
            auto manyfold = load_manyfold(input.path, file->bytes, exit);
            if (!manyfold) return manyfold.error();
            if (*manyfold) {
                model.mesh = std::move((*manyfold)->mesh);
                if (const auto note = manyfold_note(**manyfold)) model.notes.push_back(*note);
                model.radius = half_diagonal(model.mesh.positions);
                return model;
            }
        }
        ProgressBar bar(common);
        Mesh full;
        if (scene) {
            auto read = load_scene(input, file->bytes, exit);
            if (!read) return read.error();
            model.scene = std::move(*read);
            full = std::move(model.scene->mesh);
            options.part_of = std::move(model.scene->part_of);
            options.poses = std::move(model.scene->poses);
            model.posed = poses_note(options.poses);
            model.scene->poses = {};
            model.scene->mesh = {};
            for (const Attribute& attribute : full.attributes)
                model.scene->mesh.attributes.push_back(
                    {attribute.name, attribute.semantic, attribute.components, {}});
        } else {
            auto read = load_mesh(input, exit);
            if (!read) return read.error();
            full = std::move(read->mesh);
        }
        *file = {};
        auto baked = bake::collapse(full, options, bar.callback());
        if (!baked) return failed(baked.error());
        model.mesh = std::move(baked->mesh);
    }
    model.radius = model.scene ? model.scene->radius : half_diagonal(model.mesh.positions);
    return model;
}

}  // namespace vsplit::app
