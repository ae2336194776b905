// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The studio without its window: cameras and picking, painting and undo, levels and inheritance, heat.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <thread>

#include "bindings.hpp"
#include "document.hpp"
#include "family.hpp"
#include "heat.hpp"
#include "mesh_checks.hpp"
#include "rebake.hpp"
#include "vsplit/bake/samples.hpp"

using namespace vsplit;
using namespace vsplit::studio;
using namespace vsplit::test;

namespace {

std::unique_ptr<Document> whale(std::size_t triangles = 2000) {
    Source source;
    source.path = "whale.ply";
    source.mesh = bake::make_sample_mesh(bake::Sample::kWhale, triangles);
    auto document = Document::open(std::move(source), {});
    REQUIRE(document.ok());
    return std::move(*document);
}

std::size_t marked(const Document& d) {
    const auto& region = d.painting().marks().region;
    return std::size_t(std::count_if(region.begin(), region.end(), [](std::uint8_t r) { return r != 0; }));
}

}  // namespace

TEST_CASE("Camera: every view sees the whole box, and a pixel's ray meets what is there") {
    const Mesh sphere = make_sphere(24, 16);
    const Box box = box_of(sphere.positions);
    for (const char* name : {"front", "back", "left", "right", "top", "bottom", "iso", "123,-45", "0,90"}) {
        CAPTURE(name);
        const auto camera = camera_for(box, name, 400, 300);
        REQUIRE(camera);
        const auto hit = pick(sphere.positions, sphere.triangles, ray_through(*camera, 199.5, 149.5));
        REQUIRE(hit);
        // The middle of the picture is the sphere's near side.
        REQUIRE(hit->distance == Approx(bake::length(camera->eye - camera->target) - 1).margin(0.05));
        for (const auto& [x, y] : {std::pair{0.0, 0.0}, {399.0, 0.0}, {0.0, 299.0}, {399.0, 299.0}})
            REQUIRE(!pick(sphere.positions, sphere.triangles, ray_through(*camera, x, y)));
        const double across = pixel_size(*camera, bake::length(camera->eye - camera->target)) * 300;
        REQUIRE(across > 2);
    }
    for (const char* name : {"", "inside", "1", "1,", "1,2,3", "nan,0", "0,91"})
        CHECK(!camera_for(box, name, 10, 10));
    // Right is where x grows, up where y does.
    const auto camera = camera_for(box, "front", 400, 400);
    REQUIRE(ray_through(*camera, 300, 200).direction.x > 0);
    REQUIRE(ray_through(*camera, 200, 100).direction.y > 0);
}

TEST_CASE("Painting: strokes, undo, redo") {
    Painting paint(5);
    REQUIRE(paint.add_region("a", 1) == 1);
    REQUIRE(paint.add_region("a", 1) == 2);
    REQUIRE(paint.region(2).name == "a-2");
    REQUIRE(!paint.unsaved());
    paint.begin();
    REQUIRE(!paint.end());
    paint.begin();
    paint.mark(1, 1, 0.5f);
    paint.mark(1, 1, 0.25f);  // weaker: the stroke's strongest counts
    paint.mark(1, 1, 0.75f);
    paint.mark(2, 1, 1);
    REQUIRE(paint.end());
    REQUIRE(paint.unsaved());
    REQUIRE(paint.marks().strength[1] == 0.75f);
    const bake::Marks first = paint.marks();
    paint.begin();
    paint.mark(1, 2, 0.1f);
    paint.mark(2, 0, 1);
    REQUIRE(paint.end());
    const bake::Marks second = paint.marks();
    REQUIRE(second.region == std::vector<std::uint8_t>{0, 2, 0, 0, 0});
    REQUIRE(paint.undo());
    REQUIRE(paint.marks() == first);
    REQUIRE(paint.undo());
    REQUIRE(!paint.undo());
    REQUIRE(std::count(paint.marks().region.begin(), paint.marks().region.end(), 0) == 5);
    REQUIRE(paint.redo());
    REQUIRE(paint.redo());
    REQUIRE(!paint.redo());
    REQUIRE(paint.marks() == second);
    REQUIRE(paint.undo());
    paint.begin();
    paint.mark(4, 1, 1);
    paint.end();
    REQUIRE(!paint.can_redo());
    const auto changed = paint.take_changed();
    REQUIRE(std::find(changed.begin(), changed.end(), 4u) != changed.end());
    REQUIRE(paint.take_changed().empty());
}

TEST_CASE("Surface: a brush stays on its side, and goes across seams") {
    // Two sheets, close together.
    const Mesh grid = make_grid(10);
    const Mesh sheets = join(grid, grid, {0, 0, 0.01f});
    Surface surface(sheets.positions, sheets.triangles, false);
    const auto reached = surface.within({0.5, 0.5, 0}, 100, 0.3);
    REQUIRE(reached.size() > 10);
    for (const std::uint32_t v : reached) REQUIRE(v < grid.positions.size());
    REQUIRE(surface.component(0).size() == grid.positions.size());
    const Mesh seam = join(grid, grid, {1, 0, 0});  // side by side: x = 1 is there twice
    REQUIRE(Surface(seam.positions, seam.triangles, false).component(0).size() == grid.positions.size());
    REQUIRE(Surface(seam.positions, seam.triangles, true).component(0).size() == seam.positions.size());
    REQUIRE(surface.sharper_than(10).empty());
    REQUIRE(Surface(make_sphere(8, 6).positions, make_sphere(8, 6).triangles, false).sharper_than(10).size() >
            20);
}

TEST_CASE("Document: paint on a coarse level lands on all that is split off from there") {
    auto d = whale();
    d->go_to(d->level_for_ratio(0.1));
    d->painting().add_region("a", 0);
    const auto hit = d->nearest({1.9, 0, 0}, 1);
    REQUIRE(hit);
    d->painting().begin();
    d->dab(*hit, {0.5, 1, 1, 0});
    REQUIRE(d->painting().end());
    const std::uint32_t alive = std::uint32_t(d->live().positions().size());
    const ProgressiveMesh& record = d->live().state();
    std::size_t here = 0, later = 0;
    for (std::uint32_t v = 0; v < record.positions.size(); ++v) {
        std::uint32_t ancestor = v;
        while (ancestor >= alive) ancestor = record.parents[ancestor];
        const bool is = d->painting().marks().region[d->origin(v)] != 0;
        REQUIRE(is == (d->painting().marks().region[d->origin(ancestor)] != 0));
        (v < alive ? here : later) += is;
    }
    REQUIRE(here > 0);
    REQUIRE(later > here);
    // In place: all that is marked is there, and the rest is as it was.
    const Result<Mesh> made = d->refined_in_place();
    REQUIRE(made.ok());
    const Mesh& refined = *made;
    std::set<std::uint32_t> used;
    for (const Triangle& t : refined.triangles) used.insert(t.begin(), t.end());
    std::size_t shown = 0;
    for (const std::uint32_t v : used) shown += d->painting().marks().region[d->origin(v)] != 0;
    REQUIRE(shown == marked(*d));
    REQUIRE(refined.triangles.size() > d->live().triangles().size() + later);
    REQUIRE(mesh_fault(refined) == nullptr);
    // Baked again, more of them are left at the same ratio.
    auto baked = bake::collapse(d->painted(), d->options());
    REQUIRE(baked.ok());
    d->adopt(std::move(baked->mesh));
    d->go_to(d->level_for_ratio(0.25));
    std::size_t kept = 0;
    for (std::uint32_t v = 0; v < d->live().positions().size(); ++v)
        kept += d->painting().marks().region[d->origin(v)] != 0;
    REQUIRE(double(kept) > 0.8 * double(marked(*d)));
}

TEST_CASE("Document: mirrored dabs, erasing, saving and loading") {
    auto d = whale();
    d->painting().add_region("a", 0);
    const auto hit = d->nearest({0.5, 0, 0.5}, 1);
    REQUIRE(hit);
    Brush brush{0.3, 1, 1, 4};
    d->painting().begin();
    d->dab(*hit, brush);
    d->painting().end();
    std::size_t left = 0, right = 0;
    for (std::size_t v = 0; v < d->painting().vertices(); ++v)
        if (d->painting().marks().region[v]) (d->source().mesh.positions[v].z > 0 ? left : right)++;
    REQUIRE(left > 5);
    REQUIRE(right > 5);
    const auto marks = d->encode_marks(), weights = d->encode_weights();
    auto other = whale();
    REQUIRE(other->load_marks(marks).ok());
    REQUIRE(other->painting().marks() == d->painting().marks());
    auto third = whale();
    REQUIRE(third->load_marks(weights).ok());
    REQUIRE(third->weights() == d->weights());
    REQUIRE(!third->load_marks({marks.data(), marks.size() / 2}).ok());
    REQUIRE(third->weights() == d->weights());
    brush.region = 0;
    d->painting().begin();
    d->dab(*hit, brush);
    d->painting().end();
    REQUIRE(marked(*d) == 0);
}

TEST_CASE("Heat: in range at every level, error 0 at the full one") {
    auto d = whale(1000);
    for (const double ratio : {1.0, 0.3}) {
        d->go_to(d->level_for_ratio(ratio));
        for (const Heat heat : {Heat::kError, Heat::kWeight, Heat::kCurvature, Heat::kQuality}) {
            CAPTURE(ratio, heat_name(heat));
            const HeatMap map = heat_map(*d, d->live(), heat);
            REQUIRE(map.values.size() == d->live().positions().size());
            REQUIRE(map.high > map.low);
            REQUIRE(
                std::all_of(map.values.begin(), map.values.end(), [](float x) { return std::isfinite(x); }));
            const float largest = *std::max_element(map.values.begin(), map.values.end());
            if (heat == Heat::kError) REQUIRE((ratio == 1) == (largest < 1e-6f));
            if (heat == Heat::kQuality) REQUIRE(largest <= 1.0001f);
            REQUIRE(level_colours(*d, d->live(), heat).size() == map.values.size());
        }
    }
    REQUIRE(ramp(0) == Rgb{0x44, 0x01, 0x54});
    REQUIRE(ramp(1) == Rgb{0xFD, 0xE7, 0x25});
    REQUIRE(ramp(NAN) == ramp(0));
}

TEST_CASE("Rebake: estimated errors first, then measured ones; and it stops") {
    auto d = whale();
    Rebake rebake;
    REQUIRE(!rebake.take());
    start_rebake(rebake, d->painted(), d->options());
    std::optional<Rebaked> last;
    for (int i = 0; i < 6000 && !(last && last->last); ++i) {
        if (auto result = rebake.take()) last = std::move(result);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    REQUIRE(last);
    REQUIRE(last->last);
    REQUIRE(last->result.ok());
    const auto straight = bake::collapse(d->painted(), d->options());
    REQUIRE(error_at(last->result->mesh, 0) == error_at(straight->mesh, 0));
    start_rebake(rebake, d->painted(), d->options());
    rebake.cancel();
    REQUIRE(!rebake.running());
    REQUIRE(!rebake.take());
}

TEST_CASE("A weight is searched in the background, and found as find_weights() does") {
    auto d = whale();
    bake::Marks marks = bake::no_marks(d->painting().vertices());
    marks.regions.push_back({"head", {}, 1});
    for (std::size_t v = 0; v < marks.region.size(); ++v)
        marks.region[v] = d->source().mesh.positions[v].x > 0.8f;
    const bake::Keep wish{"head", 0.9, 0.4};
    WeightSearch search;
    start_search(search, d->source().mesh, marks, wish, d->options());
    std::optional<Search> found;
    double most = 0;
    for (int i = 0; i < 60000 && !found; ++i) {
        found = search.take();
        REQUIRE(search.progress() >= 0);
        most = std::max(most, search.progress());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    REQUIRE(found);
    REQUIRE(found->found.ok());
    REQUIRE(most > 0);
    REQUIRE(most <= 1);
    const auto straight = bake::find_weights(d->source().mesh, marks, {&wish, 1}, d->options());
    REQUIRE(straight->front().weight == found->found->front().weight);
    start_search(search, d->source().mesh, marks, wish, d->options());
    search.cancel();
    REQUIRE(!search.take());
}

TEST_CASE("Rays and the search tree agree with looking at every triangle; closed surfaces are told apart") {
    auto d = whale();
    const Mesh& mesh = d->source().mesh;
    const auto camera = camera_for(d->box(), "iso", 300, 200);
    int hits = 0;
    for (int y = 0; y < 200; y += 7)
        for (int x = 0; x < 300; x += 5) {
            const Ray ray = ray_through(*camera, x, y);
            const auto one = d->pick(ray);
            const auto all = pick(d->live().positions(), d->live().triangles(), ray);
            REQUIRE(one.has_value() == all.has_value());
            if (!one) continue;
            ++hits;
            REQUIRE(one->triangle == all->triangle);
            REQUIRE(one->distance == all->distance);
        }
    REQUIRE(hits > 200);
    REQUIRE(d->closed());
    Mesh open = mesh;
    open.triangles.pop_back();
    REQUIRE(!closed(open.positions, open.triangles));
    Mesh inside_out = mesh;
    for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
    REQUIRE(!closed(inside_out.positions, inside_out.triangles));
}

TEST_CASE("What a dab changes is what is drawn again") {
    auto d = whale();
    d->take_repainted();
    REQUIRE(d->take_repainted().empty());
    d->painting().add_region("a", 1);
    const auto hit = d->nearest({1.9, 0, 0}, 1);
    REQUIRE(hit);
    d->painting().begin();
    d->dab(*hit, {0.2, 1, 1, 0});
    d->painting().end();
    const std::vector<Triangle> again = d->take_repainted();
    std::set<Triangle> expected;
    for (const Triangle& t : d->live().triangles())
        for (const std::uint32_t v : t)
            if (d->painting().marks().region[d->origin(v)] == 1) expected.insert(t);
    REQUIRE(std::set<Triangle>(again.begin(), again.end()) == expected);
    REQUIRE(again.size() == expected.size());
    REQUIRE(!again.empty());
}

TEST_CASE("The help tells every key and all that the mouse does, and no key does two things") {
    const std::string help = help_text();
    std::set<std::string_view> keys;
    for (const Binding& binding : bindings()) {
        CAPTURE(binding.key);
        REQUIRE(keys.insert(binding.key).second);
        REQUIRE(binding.action != kNothing);
        REQUIRE(action_of(binding.key) == binding.action);
        REQUIRE(help.find(std::string(binding.shown)) != help.npos);
        REQUIRE(help.find(std::string(binding.what)) != help.npos);
        // A letter is shown as it is printed on the key.
        if (binding.key.size() == 1 && std::isalpha(static_cast<unsigned char>(binding.key[0])))
            REQUIRE(binding.shown.find(char(std::toupper(binding.key[0]))) != binding.shown.npos);
    }
    for (const Gesture& gesture : gestures()) {
        REQUIRE(help.find(std::string(gesture.how)) != help.npos);
        REQUIRE(help.find(std::string(gesture.what)) != help.npos);
    }
    // All that the panel does but its sliders has a key.
    const std::set<int> sliders{kRatio,     kError, kRightRatio, kKeepShare,
                                kKeepRatio, kSize,  kStrength,   kSharpDegrees};
    std::set<int> actions;
    for (const Binding& binding : bindings()) actions.insert(binding.action);
    for (int action = kNothing + 1; action <= kClose; ++action) {
        CAPTURE(action);
        REQUIRE((actions.contains(action) || sliders.contains(action)));
    }
    REQUIRE(!action_of("F12"));
}
