// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "listing.hpp"

#include <fmt/format.h>

#include <optional>
#include <span>

#include "../command.hpp"
#include "assets.hpp"
#include "vsplit/bake/scene.hpp"
#include "vsplit/read.hpp"

namespace vsplit::app {
namespace {

constexpr std::size_t kMostEntries = 2000;
// Opening a file to read its header costs more than naming it.
constexpr std::size_t kMostModels = 200;
// A table has 44 bytes for each 48 KiB of stream; a GLB's JSON may be longer than that.
constexpr std::size_t kFrontBytes = std::size_t{1} << 20;

struct ModelFacts {
    bool scene = false;
    std::uint64_t triangles = 0, vertices = 0;
};

std::optional<FileInfo> info_at(int file, std::uint64_t offset) {
    for (const std::size_t bytes : {std::size_t{64} << 10, kFrontBytes}) {
        const std::string front = read_at(file, offset, bytes);
        auto info = read_info(std::as_bytes(std::span(front)));
        if (info) return *std::move(info);
        if (info.error().code != ErrorCode::kTruncated) break;
    }
    return std::nullopt;
}

/// Nothing for files that cannot be refined.
std::optional<ModelFacts> facts_of(const Folder& folder, const std::string& path) {
    const std::string extension = extension_of(path);
    if (extension != ".pmesh" && extension != ".glb") return std::nullopt;
    const auto file = folder.find(path);
    if (!file || file->folder) return std::nullopt;
    ModelFacts facts;
    std::uint64_t offset = 0;
    if (extension == ".glb") {
        const std::string front = read_at(file->descriptor.get(), 0, kFrontBytes);
        const auto carried = bake::find_progressive(std::as_bytes(std::span(front)));
        if (!carried || !*carried) return std::nullopt;
        offset = (*carried)->offset;
        facts.scene = true;
    }
    const auto info = info_at(file->descriptor.get(), offset);
    if (!info) return std::nullopt;
    facts.triangles = info->triangles;
    facts.vertices = info->vertices;
    return facts;
}

std::string escaped(std::string_view text) {
    std::string html;
    for (const char c : text) {
        switch (c) {
            case '&':
                html += "&amp;";
                break;
            case '<':
                html += "&lt;";
                break;
            case '>':
                html += "&gt;";
                break;
            case '"':
                html += "&quot;";
                break;
            case '\'':
                html += "&#39;";
                break;
            default:
                html += c;
        }
    }
    return html;
}

std::string size_text(std::uint64_t bytes) {
    if (bytes < 1000) return fmt::format("{} bytes", bytes);
    if (bytes < 1000 * 1000) return fmt::format("{:.1f} kB", double(bytes) / 1e3);
    return fmt::format("{:.1f} MB", double(bytes) / 1e6);
}

constexpr char kHead[] = R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>{0}</title><link rel="icon" href="data:,"><style>
:root {{ color-scheme: light dark; --page: #f5f4f1; --card: #fff; --ink: #1d2226; --soft: #667078; --line: #dedbd4; --link: #0b6b6b; --stage: #e9e7e1; }}
@media (prefers-color-scheme: dark) {{ :root {{ --page: #14171a; --card: #1c2024; --ink: #e8eaec; --soft: #97a1a9; --line: #2b3136; --link: #5cc9c0; --stage: #22272c; }} }}
* {{ box-sizing: border-box; }}
body {{ margin: 0 auto; padding: 28px 20px 60px; max-width: 1120px; background: var(--page); color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }}
h1 {{ font-size: 20px; font-weight: 600; margin: 0 0 4px; overflow-wrap: anywhere; }} h2 {{ font-size: 14px; font-weight: 600; color: var(--soft); margin: 28px 0 10px; }}
p {{ margin: 0 0 20px; color: var(--soft); }} a {{ color: var(--link); text-decoration: none; }} a:hover {{ text-decoration: underline; }}
ul {{ list-style: none; margin: 0; padding: 0; }}
.models {{ display: grid; grid-template-columns: repeat(auto-fill, minmax(min(240px, 100%), 1fr)); gap: 16px; }}
.models li {{ background: var(--card); border: 1px solid var(--line); border-radius: 10px; overflow: hidden; }}
.models a {{ display: block; color: inherit; }} .models a:focus-visible {{ outline: 2px solid var(--link); outline-offset: -2px; }}
.stage {{ aspect-ratio: 4 / 3; background: var(--stage); display: grid; place-items: center; color: var(--soft); font-size: 13px; }}
.stage canvas {{ width: 100%; height: 100%; display: block; }}
.text {{ padding: 10px 14px 12px; }} .name {{ font-weight: 600; overflow-wrap: anywhere; }} .facts {{ color: var(--soft); font-size: 13px; }}
.files li {{ padding: 6px 0; border-bottom: 1px solid var(--line); display: flex; gap: 12px; justify-content: space-between; overflow-wrap: anywhere; }}
.files span {{ color: var(--soft); white-space: nowrap; }}
</style></head><body>
<h1>{0}</h1>
)html";

}  // namespace

std::string encoded_path(const std::string& path) {
    std::string url;
    for (const char c : path) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           c == '-' || c == '_' || c == '.' || c == '~' || c == '/';
        url += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return url;
}

std::string listing_page(const Folder& folder, const std::string& path) {
    const bool viewer = find_asset("index.html") != nullptr;
    std::string folders, models, files;
    std::size_t looked = 0, shown = 0;
    const auto entries = folder.list(path, kMostEntries);
    for (const Entry& entry : entries) {
        const std::string full = path + entry.name;
        const std::string url = "/" + encoded_path(full);
        if (entry.folder) {
            folders += fmt::format("<li><a href=\"{}/\">{}/</a></li>\n", escaped(url), escaped(entry.name));
            continue;
        }
        const auto facts = looked < kMostModels ? facts_of(folder, full) : std::nullopt;
        looked += facts.has_value();
        if (!facts) {
            files += fmt::format("<li><a href=\"{}\">{}</a><span>{}</span></li>\n", escaped(url),
                                 escaped(entry.name), size_text(entry.size));
            continue;
        }
        ++shown;
        const std::string link =
            viewer ? fmt::format("{}index.html?src={}", kViewerPath, encoded_path(url)) : url;
        models += fmt::format(
            "<li><a href=\"{}\"><div class=\"stage\"{}>{}</div><div class=\"text\"><div "
            "class=\"name\">{}</div>"
            "<div class=\"facts\">{} triangles, {}{}</div></div></a></li>\n",
            escaped(link), viewer ? fmt::format(" data-preview=\"{}\"", escaped(url)) : "",
            viewer ? "" : "no preview", escaped(entry.name), with_commas(facts->triangles),
            size_text(entry.size), facts->scene ? ", scene" : "");
    }
    const std::string title = path.empty() ? "Models" : path;
    std::string page = fmt::format(kHead, escaped(title));
    page += fmt::format(
        "<p>{}</p>\n",
        shown == 0 ? "No progressive models here: vsplit bake makes .pmesh and progressive .glb files."
        : viewer   ? "Choose a model to see it refine."
                   : "This build of vsplit comes without the viewer (./run web builds it); files can "
                     "be downloaded and streamed.");
    if (!models.empty()) page += "<ul class=\"models\">\n" + models + "</ul>\n";
    if (!path.empty() || !folders.empty())
        page += "<h2>Folders</h2>\n<ul class=\"files\">\n" +
                std::string(path.empty() ? "" : "<li><a href=\"../\">..</a></li>\n") + folders + "</ul>\n";
    if (!files.empty()) page += "<h2>Other files</h2>\n<ul class=\"files\">\n" + files + "</ul>\n";
    if (entries.size() == kMostEntries) page += "<p>There are more; only some are listed.</p>\n";
    if (viewer && shown > 0)
        page += fmt::format("<script type=\"module\" src=\"{}previews.js\"></script>\n", kViewerPath);
    return page + "</body></html>\n";
}

}  // namespace vsplit::app
