// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "script.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "vsplit/bake/weights.hpp"

namespace vsplit::studio {
namespace {

using Json = nlohmann::ordered_json;

/// What stops a step: its reason.
struct Fault {
    Error error;
};

[[noreturn]] void fault(std::string message) {
    throw Fault{{ErrorCode::kArgument, std::move(message), Error::kNowhere, 0}};
}

std::string text(const Json& step, const char* key, const char* otherwise = nullptr) {
    const auto it = step.find(key);
    if (it == step.end() && otherwise) return otherwise;
    if (it == step.end() || !it->is_string()) fault(std::string("wants the text '") + key + "'");
    return it->get<std::string>();
}

double number(const Json& step, const char* key, std::optional<double> otherwise, double least, double most) {
    const auto it = step.find(key);
    if (it == step.end() && otherwise) return *otherwise;
    if (it == step.end() || !it->is_number()) fault(std::string("wants the number '") + key + "'");
    const double value = it->get<double>();
    if (!(value >= least && value <= most)) fault(std::string("'") + key + "' is out of range");
    return value;
}

bool flag(const Json& step, const char* key) {
    const auto it = step.find(key);
    if (it == step.end()) return false;
    if (!it->is_boolean()) fault(std::string("'") + key + "' is true or false");
    return it->get<bool>();
}

Double3 point(const Json& value, const char* what) {
    if (!value.is_array() || value.size() != 3) fault(std::string(what) + " is three numbers");
    double p[3];
    for (std::size_t i = 0; i < 3; ++i) {
        if (!value[i].is_number()) fault(std::string(what) + " is three numbers");
        p[i] = value[i].get<double>();
        if (!std::isfinite(p[i])) fault(std::string(what) + " is not finite");
    }
    return {p[0], p[1], p[2]};
}

class Runner {
  public:
    Runner(Document& document, const ScriptHost& host) : document_(document), host_(host) {
        camera_ = *camera_for(document.box(), "iso", 1280, 800);
    }

    Json run(const Json& step);

  private:
    void view(const Json& step);
    std::uint8_t region(const Json& step);
    Json stroke(const Json& step);
    Json select(const Json& step);
    Json apply(const Json& step);
    Json keep(const Json& step);
    Json weight(const Json& step);
    Json counts(const Json& step);
    void level(const Json& step);
    void write(const Json& step, Result<std::vector<std::byte>> bytes);

    Document& document_;
    const ScriptHost& host_;
    Camera camera_;
};

void Runner::view(const Json& step) {
    const int width = int(number(step, "width", camera_.width, 16, 8192));
    const int height = int(number(step, "height", camera_.height, 16, 8192));
    if (step.contains("eye")) {
        camera_.eye = point(step["eye"], "'eye'");
        camera_.target =
            step.contains("target") ? point(step["target"], "'target'") : document_.box().centre();
        camera_.up = step.contains("up") ? point(step["up"], "'up'") : Double3{0, 1, 0};
        camera_.fov_degrees = number(step, "fov", 30.0, 1, 170);
        camera_.width = width;
        camera_.height = height;
        return;
    }
    const std::string name = text(step, "from", "iso");
    const auto camera = camera_for(document_.box(), name, width, height);
    if (!camera) fault("there is no view " + name);
    camera_ = *camera;
}

std::uint8_t Runner::region(const Json& step) {
    const std::string name = text(step, "region", "painted");
    const auto& regions = document_.painting().marks().regions;
    for (std::size_t r = 0; r < regions.size(); ++r)
        if (regions[r].name == name) return std::uint8_t(r + 1);
    if (name.empty() || name.find_first_of(" \t\r\n=") != std::string::npos)
        fault("a region's name has neither blanks nor '='");
    constexpr std::uint32_t kColours[] = {0xE6550D, 0x3182BD, 0x31A354, 0x756BB1, 0xE7298A, 0xE6AB02};
    const std::size_t number =
        document_.painting().add_region(name, kColours[regions.size() % std::size(kColours)]);
    if (number == 0) fault("more than 255 regions");
    return std::uint8_t(number);
}

Json Runner::stroke(const Json& step) {
    Brush brush;
    const bool screen = text(step, "space", "screen") == "screen";
    if (!screen && text(step, "space") != "object") fault("'space' is screen or object");
    brush.region = flag(step, "erase") ? std::uint8_t{0} : region(step);
    brush.strength = float(number(step, "strength", 1.0, 0, 1));
    const double radius = number(step, "radius", screen ? 20 : 0.02 * document_.box().diagonal(), 0, 1e30);
    for (const char axis : text(step, "mirror", "")) {
        if (axis < 'x' || axis > 'z') fault("'mirror' is made of x, y and z");
        brush.mirror |= 1u << (axis - 'x');
    }
    const auto points = step.find("points");
    if (points == step.end() || !points->is_array() || points->empty()) fault("wants 'points'");
    std::size_t missed = 0;
    document_.painting().begin();
    const std::uint64_t before = document_.painting().version();
    try {
        for (const Json& p : *points) {
            std::optional<Hit> hit;
            if (screen) {
                if (!p.is_array() || p.size() != 2 || !p[0].is_number() || !p[1].is_number())
                    fault("a point on the screen is two numbers");
                hit = document_.pick(ray_through(camera_, p[0].get<double>(), p[1].get<double>()));
                if (hit) brush.radius = radius * pixel_size(camera_, hit->distance);
            } else {
                brush.radius = radius;
                hit = document_.nearest(point(p, "a point"),
                                        std::max(radius, 1e-3 * document_.box().diagonal()));
            }
            if (hit)
                document_.dab(*hit, brush);
            else
                ++missed;
        }
    } catch (const Fault&) {
        if (document_.painting().end()) document_.painting().undo();
        throw;
    }
    document_.painting().end();
    return {{"changed", document_.painting().version() != before}, {"missed", missed}};
}

Json Runner::select(const Json& step) {
    const std::string by = text(step, "by");
    const std::uint8_t number_of = flag(step, "erase") ? std::uint8_t{0} : region(step);
    bool changed = false;
    if (by == "curvature") {
        changed = document_.select_sharper_than(number(step, "degrees", 40.0, 0, 180), number_of);
    } else if (by == "component" || by == "material") {
        if (!step.contains("at")) fault("wants 'at', a point in the object");
        const auto hit = document_.nearest(point(step["at"], "'at'"), 0.05 * document_.box().diagonal());
        if (!hit) fault("nothing is at 'at'");
        changed = by == "component" ? document_.select_component(hit->vertex, number_of)
                                    : document_.select_material(hit->triangle, number_of);
    } else {
        fault("'by' is component, curvature or material");
    }
    return {{"changed", changed}};
}

Json Runner::apply(const Json&) {
    auto result = bake::collapse(document_.painted(), document_.options(), host_.progress);
    if (!result) throw Fault{result.error()};
    document_.adopt(std::move(result->mesh));
    return {{"splits", document_.live().max_level()}};
}

Json Runner::keep(const Json& step) {
    bake::Keep wish;
    wish.region = text(step, "region");
    wish.share = number(step, "share", std::nullopt, 0, 1);
    wish.ratio = number(step, "ratio", std::nullopt, 0, 1);
    bake::Marks marks = document_.painting().marks();
    auto found =
        bake::find_weights(document_.source().mesh, marks, {&wish, 1}, document_.options(), host_.progress);
    if (!found) throw Fault{found.error()};
    document_.painting().region(region(step)).weight = found->front().weight;
    // JSON has no infinity.
    const double weight = found->front().weight;
    return {{"weight", std::isinf(weight) ? Json("inf") : Json(weight)}, {"kept", found->front().share}};
}

Json Runner::weight(const Json& step) {
    bake::Region& changed = document_.painting().region(region(step));
    const auto value = step.find("weight");
    if (value == step.end()) fault("wants 'weight', a number, inf or auto");
    if (*value == "auto")
        changed.weight.reset();
    else if (*value == "inf")
        changed.weight = double(INFINITY);
    else
        changed.weight = number(step, "weight", std::nullopt, 0, 1e30);
    return Json::object();
}

Json Runner::counts(const Json&) {
    const Document& d = document_;
    Json regions = Json::object();
    for (std::size_t r = 0; r < d.painting().marks().regions.size(); ++r) {
        std::size_t here = 0, all = 0;
        for (std::uint32_t v = 0; v < d.live().state().positions.size(); ++v) {
            if (d.origin(v) == kNoVertex || d.painting().marks().region[d.origin(v)] != r + 1) continue;
            ++all;
            here += v < d.live().positions().size();
        }
        regions[d.painting().marks().regions[r].name] = {
            {"vertices", here}, {"of", all}, {"weight", d.weight_of(r + 1)}};
    }
    return {{"vertices", d.live().positions().size()},
            {"triangles", d.live().triangles().size()},
            {"ratio", d.ratio()},
            {"error", d.live().error()},
            {"regions", regions}};
}

void Runner::level(const Json& step) {
    const ProgressiveMesh& record = document_.live().state();
    if (step.contains("error"))
        document_.go_to(level_for_error(record, number(step, "error", std::nullopt, 0, 1e30)));
    else if (step.contains("vertices"))
        document_.go_to(
            level_for_vertices(record, std::uint64_t(number(step, "vertices", std::nullopt, 0, 4e9))));
    else
        document_.go_to(document_.level_for_ratio(number(step, "ratio", std::nullopt, 0, 1)));
}

void Runner::write(const Json& step, Result<std::vector<std::byte>> bytes) {
    const std::string path = text(step, "file");
    if (!bytes) throw Fault{bytes.error()};
    if (const Status written = host_.write(path, *bytes); !written) throw Fault{written.error()};
}

Json Runner::run(const Json& step) {
    const std::string what = text(step, "do");
    Json done = {{"do", what}};
    const auto add = [&](const Json& more) { done.update(more); };
    if (what == "view") {
        view(step);
    } else if (what == "level") {
        level(step);
        add(counts(step));
    } else if (what == "stroke") {
        add(stroke(step));
    } else if (what == "select") {
        add(select(step));
    } else if (what == "undo") {
        add({{"changed", document_.painting().undo()}});
    } else if (what == "redo") {
        add({{"changed", document_.painting().redo()}});
    } else if (what == "weight") {
        add(weight(step));
    } else if (what == "keep") {
        add(keep(step));
    } else if (what == "apply") {
        add(apply(step));
    } else if (what == "counts") {
        add(counts(step));
    } else if (what == "load") {
        auto bytes = host_.read(text(step, "file"));
        if (!bytes) throw Fault{bytes.error()};
        if (const Status loaded = document_.load_marks(*bytes); !loaded) throw Fault{loaded.error()};
    } else if (what == "save-marks") {
        write(step, document_.encode_marks());
        document_.painting().mark_saved();
    } else if (what == "save-weights") {
        write(step, document_.encode_weights());
    } else if (what == "refine") {
        // What is shown: the marked regions in full, the rest as it is.
        auto made = document_.refined_in_place();
        if (!made) throw Fault{made.error()};
        Mesh mesh = std::move(*made);
        if (document_.placed()) {
            Shown shown = document_.show(mesh.positions, mesh.triangles, mesh.groups);
            mesh = {};
            mesh.positions = std::move(shown.positions);
            mesh.triangles = std::move(shown.triangles);
        }
        write(step, bake::encode_ply(mesh));
        add({{"vertices", mesh.positions.size()}, {"triangles", mesh.triangles.size()}});
    } else if (what == "export") {
        const std::string path = text(step, "file");
        const double ratio =
            step.contains("ratio") ? number(step, "ratio", std::nullopt, 0, 1) : document_.ratio();
        write(step, document_.encode(std::filesystem::path(path).extension().string(), ratio));
    } else if (what == "picture") {
        if (!host_.picture) fault("this vsplit was built without a renderer and draws no pictures");
        write(step, host_.picture(document_, camera_, step));
    } else {
        fault("there is no step '" + what + "'");
    }
    return done;
}

}  // namespace

Status run_script(Document& document, std::string_view json, const ScriptHost& host, Json& report) {
    const Json script = Json::parse(json, nullptr, false, true);
    const auto refuse = [](std::string message) {
        return Error{ErrorCode::kMalformed, std::move(message), Error::kNowhere, 0};
    };
    if (script.is_discarded()) return refuse("a script is JSON, and this is not");
    const Json* steps = script.is_array() ? &script : nullptr;
    if (script.is_object() && script.contains("steps")) steps = &script["steps"];
    if (!steps || !steps->is_array()) return refuse("a script is a list of steps");
    Runner runner(document, host);
    report = Json::array();
    for (std::size_t i = 0; i < steps->size(); ++i) {
        Error error;
        try {
            if (!(*steps)[i].is_object()) fault("is not an object");
            report.push_back(runner.run((*steps)[i]));
            continue;
        } catch (const Fault& caught) {
            error = caught.error;
        } catch (const nlohmann::json::exception& caught) {
            error = {ErrorCode::kArgument, caught.what(), Error::kNowhere, 0};
        }
        error.message = "step " + std::to_string(i + 1) + ": " + error.message;
        return error;
    }
    return Ok{};
}

}  // namespace vsplit::studio
