// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "open.hpp"

#include <cstring>

#include "cloud.hpp"
#include "model.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/read.hpp"

#ifdef VSPLIT_VIEWER
#include "../window/texture.hpp"
#endif

namespace vsplit::app {
namespace {

#ifdef VSPLIT_VIEWER
constexpr studio::DecodeImage kDecode = studio::decode_image;
#else
constexpr studio::DecodeImage kDecode = nullptr;  // without VTK: the materials' own colours
#endif

}  // namespace

Result<studio::Source> open_source(const InputOptions& input, const Common& common, int& exit) {
    const auto failed = [&](const Error& error) {
        exit = fail_input(input.path, error);
        return error;
    };
    auto file = read_stream_file(input.path, exit);
    if (!file) return file.error();
    const std::string extension = extension_of(input.path);
    studio::Source source;
    source.path = input.path;
    const bool stream = file->carried || extension == ".pmesh" ||
                        (file->size >= 6 && std::memcmp(file->stream().data(), "\x8Fpmesh", 6) == 0);
    if (stream) {
        Limits limits;
        limits.max_bytes = std::uint64_t{1} << 36;
        auto record = read_progressive_mesh(file->stream(), limits);
        if (!record) return failed(record.error());
        source.mesh = cut(*record, record->splits.size());
        if (file->carried) {
            auto around = bake::parse_progressive_scene(file->bytes);
            if (!around) return failed(around.error());
            source.scene = std::move(*around);
            source.colours = studio::base_colours(*source.scene, source.mesh, kDecode);
        }
        source.record = std::move(*record);
        return source;
    }
    if (is_point_cloud(file->bytes, extension)) {
        ProgressBar bar(common);
        auto surface =
            reconstruct_cloud(input.path, file->bytes, CloudOptions{}, common, false, bar.callback(), exit);
        if (!surface) return surface.error();
        source.mesh = std::move(surface->mesh);
        return source;
    }
    if (is_gltf(file->bytes, extension)) {
        auto scene = load_scene(input, file->bytes, exit);
        if (!scene) return scene.error();
        source.mesh = std::move(scene->mesh);
        source.part_of = scene->part_of;
        scene->mesh = {};
        for (const Attribute& attribute : source.mesh.attributes)
            scene->mesh.attributes.push_back({attribute.name, attribute.semantic, attribute.components, {}});
        source.scene = std::move(*scene);
        source.colours = studio::base_colours(*source.scene, source.mesh, kDecode);
        return source;
    }
    *file = {};
    auto mesh = load_mesh(input, exit);
    if (!mesh) return mesh.error();
    source.mesh = std::move(mesh->mesh);
    source.vertex_of = std::move(mesh->vertex_of);
    source.file_vertices = mesh->report.vertices_in;
    return source;
}

Result<std::unique_ptr<studio::Document>> open_document(const InputOptions& input, const CollapseFlags& flags,
                                                        const std::string& marks, const Common& common,
                                                        int& exit) {
    auto source = open_source(input, common, exit);
    if (!source) return source.error();
    return document_of(std::move(*source), flags, marks, common, exit);
}

Result<std::unique_ptr<studio::Document>> document_of(studio::Source source, const CollapseFlags& flags,
                                                      const std::string& marks, const Common& common,
                                                      int& exit) {
    const std::string path = source.path;
    bake::CollapseOptions options;
    if (const auto reason = flags.set(options)) {
        exit = fail_usage(*reason);
        return Error{ErrorCode::kArgument, *reason, Error::kNowhere, 0};
    }
    ProgressBar bar(common);
    auto document = studio::Document::open(std::move(source), options, bar.callback());
    if (!document) {
        exit = fail_input(path, document.error());
        return document;
    }
    if (marks.empty()) return document;
    auto bytes = bake::read_file(marks);
    const Status loaded = bytes ? (*document)->load_marks(*bytes) : Status(bytes.error());
    if (!loaded) {
        exit = fail_input(marks, loaded.error());
        return loaded.error();
    }
    (*document)->painting().mark_saved();
    return document;
}

}  // namespace vsplit::app
