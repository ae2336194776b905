// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What takes the studio longer than a frame: bakes, files, and measuring itself.
#include <fmt/format.h>
#include <vtkCamera.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "studio_window.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/weights.hpp"

namespace vsplit::studio {

void StudioWindow::after_change(const std::string& what) {
    autosave();
    say(what);
    draw();
}

std::string StudioWindow::beside(const std::string& suffix) const {
    std::filesystem::path path(document_->source().path);
    return path.replace_extension().string() + suffix;
}

bool StudioWindow::write(const std::string& path, std::span<const std::byte> bytes, bool overwrite) {
    const Status written = bake::write_file(path, bytes, overwrite);
    if (!written) say(path + ": " + written.error().describe());
    return written.ok();
}

void StudioWindow::autosave() {
    if (document_->painting().unsaved()) write(beside(".autosave.marks"), document_->encode_marks(), true);
}

void StudioWindow::recover() {
    const std::string path = beside(".autosave.marks");
    const auto bytes = bake::read_file(path);
    if (!bytes) return;
    if (const Status loaded = document_->load_marks(*bytes); !loaded)
        return say(path + ": " + loaded.error().describe());
    region_ = 1;
    say("recovered the paint of a session that was not saved");
}

bool StudioWindow::save() {
    const std::string marks = options_.marks.empty() ? beside(".marks") : options_.marks;
    if (!write(marks, document_->encode_marks(), true)) return false;
    if (!write(beside(".weights.txt"), document_->encode_weights(), true)) return false;
    document_->painting().mark_saved();
    std::error_code ignored;
    std::filesystem::remove(beside(".autosave.marks"), ignored);
    say("saved " + marks + " and " + beside(".weights.txt"));
    return true;
}

void StudioWindow::load() {
    const std::string path = options_.marks.empty() ? beside(".marks") : options_.marks;
    const auto bytes = bake::read_file(path);
    if (!bytes) return say(path + ": " + bytes.error().describe());
    if (const Status loaded = document_->load_marks(*bytes); !loaded)
        return say(path + ": " + loaded.error().describe());
    if (document_->painting().marks().regions.empty()) add_region();
    region_ = 1;
    after_change("loaded " + path);
}

void StudioWindow::export_all() {
    // A scene goes out with its nodes and materials.
    const std::string extension = document_->source().scene ? ".glb" : ".pmesh";
    const std::string path = beside(".studio" + extension);
    auto bytes = document_->encode(extension, 1);
    if (!bytes) return say(bytes.error().describe());
    if (write(path, *bytes, true))
        say(document_->painting().version() == baked_version_
                ? "exported " + path
                : "exported " + path + ", without the paint since the last Apply");
    draw();
}

void StudioWindow::apply() {
    cancel();
    first_pending_ = true;
    start_rebake(rebake_, document_->painted(), document_->options());
    baked_version_ = document_->painting().version();
    say("baking");
    draw();
}

void StudioWindow::take_bake() {
    auto taken = rebake_.take();
    if (!taken) return;
    if (!taken->result) {
        first_pending_ = false;
        baked_version_ = ~std::uint64_t{0};
        say(taken->result.error().describe());
        return draw();
    }
    first_pending_ = false;
    const double ratio = document_->ratio();
    document_->adopt(std::move(taken->result->mesh));
    left_.live = std::make_unique<LiveMesh>(document_->live());
    if (split_) right_.live = std::make_unique<LiveMesh>(document_->live());
    level_ = document_->level_for_ratio(ratio);
    document_->go_to(level_);
    say(taken->last ? "baked: what you see is the new sequence" : "baked; measuring errors");
    draw();
}

void StudioWindow::cancel() {
    if (search_.running()) {
        search_.cancel();
        say("the search was cancelled");
    }
    if (!rebake_.running()) return;
    rebake_.cancel();
    // The sequence as recorded may be there already: it stays, its errors are estimates.
    if (first_pending_) baked_version_ = ~std::uint64_t{0};
    say(first_pending_ ? "the bake was cancelled" : "measuring was cancelled: errors are estimates");
    first_pending_ = false;
}

void StudioWindow::keep() {
    cancel();
    const std::string name = document_->painting().marks().regions[region_ - 1].name;
    start_search(search_, document_->source().mesh, document_->painting().marks(),
                 {name, keep_share_, keep_ratio_}, document_->options());
    say(fmt::format("searching the weight that keeps {:.0f} % of {} at {:.0f} %", 100 * keep_share_, name,
                    100 * keep_ratio_));
    draw();
}

void StudioWindow::take_search() {
    const auto done = search_.take();
    if (!done) return;
    if (!done->found) {
        say(done->found.error().describe());
        return draw();
    }
    const bake::KeepResult& found = done->found->front();
    // Regions are never removed, but their marks may have been loaded anew meanwhile.
    const auto& regions = document_->painting().marks().regions;
    for (std::size_t r = 0; r < regions.size(); ++r)
        if (regions[r].name == done->wish.region) document_->painting().region(r + 1).weight = found.weight;
    baked_version_ = ~std::uint64_t{0};
    after_change(fmt::format("{}: weight {:.4g} keeps {:.1f} % at {:.0f} %; Return bakes with it",
                             done->wish.region, found.weight, 100 * found.share, 100 * done->wish.ratio));
}

void StudioWindow::asked_to_close() {
    if (!document_->painting().unsaved()) {
        interactor_->TerminateApp();
        return;
    }
    question_ = true;
    sheet_->show(
        "There is paint that is not saved.         \n\n  S    save marks and weights, and close  \n"
        "  D    discard them, and close            \n  Esc  go on painting                     ",
        window_->GetSize()[0] - Panel::kWidth, window_->GetSize()[1]);
    draw();
}

void StudioWindow::bench() {
    draw();
    const auto report = [](const char* what, std::vector<double> seconds) {
        std::sort(seconds.begin(), seconds.end());
        fmt::print("{:<34} median {:7.1f} ms   95 % {:7.1f} ms   ({} times)\n", what,
                   1e3 * seconds[seconds.size() / 2],
                   1e3 * seconds[std::min(seconds.size() - 1, seconds.size() * 95 / 100)], seconds.size());
    };
    const auto times = [&](int count, auto&& step) {
        std::vector<double> seconds;
        for (int i = 0; i < count; ++i) {
            const double start = seconds_now();
            step(i);
            window_->WaitForCompletion();
            seconds.push_back(seconds_now() - start);
        }
        return seconds;
    };
    fmt::print("{}: {} triangles, {} x {} pixels\n", document_->source().path,
               document_->live().state().triangles.size(), window_->GetSize()[0], window_->GetSize()[1]);
    report("full picture", times(5, [&](int) {
               moving_ = false;
               draw();
           }));
    for (int i = 0; i < 12; ++i) {
        move();
        draw();
    }  // the budget settles
    report("slider moved, frame",
           times(60, [&](int i) { set_level(document_->level_for_ratio(1 - (i % 30) / 30.0)); }));
    set_level(document_->live().max_level());
    report("turned, frame", times(40, [&](int) {
               camera_moves();
               left_.renderer->GetActiveCamera()->Azimuth(3);
               draw();
           }));
    const int cx = Panel::kWidth + left_width() / 2, cy = window_->GetSize()[1] / 2;
    press(cx - 60, cy, true, false);
    report("stroke, frame", times(30, [&](int i) { drag(cx - 60 + 4 * i, cy + (i % 7)); }));
    const double before = seconds_now();
    release();
    fmt::print("{:<34} {:7.1f} ms, autosave and full picture\n", "stroke ends",
               1e3 * (seconds_now() - before));
    const double start = seconds_now();
    apply();
    const auto wait = [&](const char* what, auto&& pending) {
        while (pending()) {
            take_bake();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        take_bake();
        window_->WaitForCompletion();
        fmt::print("{:<34} {:7.1f} ms\n", what, 1e3 * (seconds_now() - start));
    };
    wait("bake again, new sequence shown", [&] { return first_pending_; });
    wait("the same, errors measured", [&] { return rebake_.running(); });
    fmt::print("a moving picture has at most {:.0f} triangles here\n", budget_);
    std::error_code ignored;
    std::filesystem::remove(beside(".autosave.marks"), ignored);
}

}  // namespace vsplit::studio
