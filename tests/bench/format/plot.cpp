// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace vsplit::bench {
namespace {

using Out = std::back_insert_iterator<std::string>;

constexpr double kPanel = 400, kHeight = 340;  // Of one model, pixels.
constexpr double kLeft = 52, kRight = 12, kTop = 48, kBottom = 44;

/// Decades along an axis.
struct Axis {
    double least = 1e300, most = 0;  ///< Of what is shown.
    double from = 0, to = 1;         ///< Pixels.
    void see(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
    double at(double value) const {
        return from +
               (to - from) * (std::log10(value) - std::log10(least)) / (std::log10(most) - std::log10(least));
    }
};

struct Series {
    const char *name, *color;
    bool dashed = false, line = true;
    std::vector<Point> points;
};

/// Errors below what the lattice resolves, half a step, count as that.
std::vector<Series> series_of(const ModelSizes& model) {
    std::vector<Series> all;
    const char* colors[] = {"#1668b8", "#c2570c"};
    for (std::size_t i = 0; i < model.profiles.size(); ++i)
        all.push_back(
            {i ? "quality profile" : "stream profile", colors[i], false, true, model.profiles[i].curve});
    Series own{"Draco, each level alone", "#555555", false, false, {}},
        sum{"Draco, as a chain", "#555555", true, true, {}};
    std::uint64_t so_far = 0;
    const Profile& best = model.profiles.back();
    for (auto lod = best.lods.rbegin(); lod != best.lods.rend(); ++lod) {
        so_far += lod->draco;
        own.points.push_back({lod->draco, lod->error});
        sum.points.push_back({so_far, lod->error});
    }
    all.push_back(std::move(own));
    all.push_back(std::move(sum));
    for (Series& s : all)
        for (Point& p : s.points) p.error = std::max(p.error, 0.5 * best.step) / best.diagonal;
    return all;
}

void text(Out out, double x, double y, const char* anchor, const std::string& words) {
    fmt::format_to(out, "<text x='{:.1f}' y='{:.1f}' text-anchor='{}'>{}</text>\n", x, y, anchor, words);
}

void line(Out out, double x1, double y1, double x2, double y2, const char* color) {
    fmt::format_to(out, "<path d='M{:.1f} {:.1f}L{:.1f} {:.1f}' stroke='{}'/>\n", x1, y1, x2, y2, color);
}

/// Ticks at 1, 2 and 5 of each decade that the axis shows.
std::vector<double> ticks(const Axis& axis, bool only_decades) {
    std::vector<double> values;
    for (double decade = std::pow(10, std::floor(std::log10(axis.least))); decade <= axis.most; decade *= 10)
        for (const double m : {1.0, 2.0, 5.0})
            if ((m == 1 || !only_decades) && m * decade >= axis.least * 0.999 &&
                m * decade <= axis.most * 1.001)
                values.push_back(m * decade);
    return values;
}

std::string bytes_label(double bytes) {
    return bytes >= 1e6   ? fmt::format("{:g} MB", bytes / 1e6)
           : bytes >= 1e3 ? fmt::format("{:g} kB", bytes / 1e3)
                          : fmt::format("{:g} B", bytes);
}

void panel(Out out, const ModelSizes& model, double left) {
    Axis x, y;
    const std::vector<Series> all = series_of(model);
    for (const Series& s : all)
        for (const Point& p : s.points) {
            x.see(double(p.bytes));
            y.see(p.error);
        }
    x.least /= 1.25, x.most *= 1.25, y.least /= 1.4, y.most *= 1.4;
    x.from = left + kLeft, x.to = left + kPanel - kRight;
    y.from = kHeight - kBottom, y.to = kTop;
    for (const double value : ticks(x, x.most / x.least > 200)) {
        line(out, x.at(value), y.from, x.at(value), y.to, "#dddddd");
        text(out, x.at(value), y.from + 15, "middle", bytes_label(value));
    }
    for (const double value : ticks(y, true)) {
        line(out, x.from, y.at(value), x.to, y.at(value), "#dddddd");
        text(out, x.from - 5, y.at(value) + 4, "end",
             value >= 0.001 ? fmt::format("{:g} %", 100 * value) : fmt::format("{:.4g} %", 100 * value));
    }
    fmt::format_to(out, "<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' stroke='#888888'/>\n",
                   x.from, y.to, x.to - x.from, y.from - y.to);
    text(out, (x.from + x.to) / 2, kHeight - 10, "middle",
         fmt::format("{}: bytes received, against error (of the diagonal)", model.model));
    for (const Series& s : all) {
        if (s.line) {
            std::string path;
            // Steps: an error holds until the next block, or level, is whole.
            for (const Point& p : s.points)
                path += fmt::format("{}{:.1f}{}{:.1f}", path.empty() ? "M" : "H", x.at(double(p.bytes)),
                                    path.empty() ? " " : "V", y.at(p.error));
            fmt::format_to(out, "<path d='{}' stroke='{}' stroke-width='1.5'{}/>\n", path, s.color,
                           s.dashed ? " stroke-dasharray='4 3'" : "");
        }
        if (s.dashed) continue;
        for (const Point& p : s.points)
            fmt::format_to(out, "<circle cx='{:.1f}' cy='{:.1f}' r='2.5' fill='{}'/>\n",
                           x.at(double(p.bytes)), y.at(p.error), s.color);
    }
}

void legend(Out out, const std::vector<Series>& all) {
    double at = kLeft;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Series& s = all[i];
        // Two rows for one narrow panel, too.
        const double x = at + (i % 2 ? 175.0 : 0.0), y = i < 2 ? 14.0 : 32.0;
        if (s.line)
            fmt::format_to(out, "<path d='M{:.1f} {:.1f}h22' stroke='{}' stroke-width='1.5'{}/>\n", x, y,
                           s.color, s.dashed ? " stroke-dasharray='4 3'" : "");
        if (!s.dashed)
            fmt::format_to(out, "<circle cx='{:.1f}' cy='{:.1f}' r='2.5' fill='{}'/>\n", x + 11, y, s.color);
        text(out, x + 28, y + 4, "start", s.name);
    }
}

}  // namespace

std::string plot_rate_distortion(std::span<const ModelSizes> models) {
    std::string svg;
    const Out out = std::back_inserter(svg);
    fmt::format_to(out,
                   "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:g} {1:g}' width='{0:g}' "
                   "height='{1:g}' fill='none' font-family='sans-serif' font-size='11'>\n"
                   "<!-- SPDX-FileCopyrightText: 2026 The vsplit authors; SPDX-License-Identifier: MIT. "
                   "Written by ./run bench format -->\n"
                   "<style>text {{ fill: #222222 }}</style>\n"
                   "<rect width='{0:g}' height='{1:g}' fill='#ffffff'/>\n",
                   kPanel * double(models.size()), kHeight);
    if (!models.empty()) legend(out, series_of(models.front()));
    for (std::size_t i = 0; i < models.size(); ++i) panel(out, models[i], kPanel * double(i));
    return svg + "</svg>\n";
}

}  // namespace vsplit::bench
